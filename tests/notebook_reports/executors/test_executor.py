"""Every executor gives the same: results by place, an error of a job as its result."""

import threading

import pytest

from notebook_reports.executors.executor import Serial, Threads, cores
from notebook_reports.executors.processes import Processes
from notebook_reports.executors.sources import fingerprint

pytestmark = pytest.mark.builds


@pytest.mark.parametrize("executor", [Serial(), Threads(2), Processes(2)], ids=lambda e: type(e).__name__)
def test_results_come_by_place_and_an_error_is_a_result(executor):
    found = dict(executor.run(eval, ["1 + 1", "1 / 0", "[3]"]))
    assert found[0] == 2 and isinstance(found[1], ZeroDivisionError) and found[2] == [3] and len(found) == 3
    assert list(executor.run(eval, [])) == []


def test_a_run_in_threads_that_is_broken_off_starts_nothing_more_and_ends_what_runs():
    ended, ran = threading.Event(), []

    def job(number):
        ran.append(number)
        assert number == 0 or ended.wait(30)

    run = Threads(2, interrupted=ended.set).run(job, range(9))
    assert next(run) == (0, None)
    run.close()
    assert ended.is_set() and len(ran) <= 3


def test_processes_that_are_broken_off_end_at_once():
    run = Processes(2).run(eval, ["1", *["__import__('time').sleep(60)"] * 8])
    assert next(run) == (0, 1)
    run.close()


def test_sources_that_are_not_there_are_told():
    with pytest.raises(ModuleNotFoundError, match="no_such_package"):
        fingerprint(("no_such_package",))
    assert cores() >= 1
