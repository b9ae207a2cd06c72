"""Jobs in processes: all are done whatever happens to a process, and one that ends its own again and again is told."""

from concurrent.futures.process import BrokenProcessPool

import pytest

from notebook_reports.executors.executor import TRIES
from notebook_reports.executors.processes import Processes

pytestmark = pytest.mark.builds


def test_a_killed_process_costs_its_jobs_another_try(tmp_path):
    mark = str(tmp_path / "killed once")
    once = f"9 if __import__('os').path.exists({mark!r}) else open({mark!r}, 'w').close() or __import__('os')._exit(1)"
    assert sorted(Processes(2).run(eval, ["1 + 1", once, "2 + 2"])) == [(0, 2), (1, 9), (2, 4)]


def test_a_job_that_ends_its_process_or_fails_is_told_and_the_others_are_done(tmp_path):
    count = str(tmp_path / "tries")
    deadly = f"open({count!r}, 'a').write('x') and __import__('os')._exit(1)"
    found = dict(Processes(1).run(eval, ["1 + 1", deadly, "1 / 0", "3"]))
    assert found[0] == 2 and found[3] == 3
    assert isinstance(found[1], BrokenProcessPool) and isinstance(found[2], ZeroDivisionError)
    assert len((tmp_path / "tries").read_text()) <= TRIES


def test_jobs_run_in_the_surroundings_of_a_kernel():
    words = "[__import__('os').environ[name] for name in ('MPLBACKEND', 'PYTHONHASHSEED', 'TZ')]"
    assert list(Processes(1).run(eval, [words])) == [(0, ["agg", "0", "UTC"])]
