"""Jobs on Dask's workers: the same bytes as here, whatever happens to a worker; the process that does them."""

import subprocess
import sys

import pytest

from notebook_reports.executors.cluster import Cluster
from notebook_reports.executors.executor import surroundings
from notebook_reports.executors.served import Ended, Served
from notebook_reports.executors.sources import fingerprint
from notebook_reports.project.project import EnvironmentProblem, UsageError

pytestmark = [pytest.mark.builds, pytest.mark.long]


@pytest.fixture(scope="module")
def served():
    made = Served()
    yield made
    made.end()


def test_a_process_does_jobs_in_the_surroundings_of_a_kernel(served):
    words = "[__import__('os').environ[name] for name in ('MPLBACKEND', 'PYTHONHASHSEED', 'TZ')]"
    assert served.do(eval, words, 60) == ["agg", "0", "UTC"]
    assert served.do(eval, "print('heard by nobody') or 5", 60) == 5
    with pytest.raises(ZeroDivisionError):
        served.do(eval, "1 / 0", 60)


@pytest.mark.whole
def test_a_job_that_takes_too_long_or_ends_its_process_is_told_and_the_next_is_done(served):
    before = served.do(eval, "__import__('os').getpid()", 60)
    with pytest.raises(TimeoutError, match=r"not done within 0\.2 s"):
        served.do(eval, "__import__('time').sleep(60)", 0.2)
    with pytest.raises(Ended):
        served.do(eval, "__import__('os')._exit(1)", 60)
    assert served.do(eval, "__import__('os').getpid()", 60) != before


@pytest.mark.parametrize("where", ["two", "0", "http://host:1", ""])
def test_what_is_no_cluster_is_told(where):
    with pytest.raises(UsageError, match="--cluster"):
        Cluster(where)


def test_results_are_of_the_same_sources():
    found = fingerprint(("notebook_reports",))
    assert len(found["sources of notebook_reports"]) == 12 and found["Python"] == sys.version.split()[0]


@pytest.fixture(scope="module")
def scheduler(tmp_path_factory):
    """The address of a scheduler with two workers, and the workers' processes."""
    pytest.importorskip("distributed")
    from distributed import LocalCluster

    with surroundings():
        local = LocalCluster(n_workers=2, threads_per_worker=1, host="127.0.0.1", dashboard_address="127.0.0.1:0")
    with local:
        yield local.scheduler_address


@pytest.mark.whole
def test_a_time_out_costs_its_job_another_try_and_then_is_told(scheduler, tmp_path):
    once = f"__import__('time').sleep(0 if __import__('os').path.exists({str(tmp_path / 'x')!r}) else "
    once += f"(open({str(tmp_path / 'x')!r}, 'w').close() or 60)) or 7"
    assert sorted(Cluster(scheduler, seconds=5).run(eval, ["1 + 1", once])) == [(0, 2), (1, 7)]
    found = dict(Cluster(scheduler, seconds=0.5).run(eval, ["1 / 0", "__import__('time').sleep(60)", "3"]))
    assert isinstance(found[0], ZeroDivisionError) and isinstance(found[1], TimeoutError) and found[2] == 3


@pytest.mark.whole
def test_no_scheduler_is_told():
    pytest.importorskip("distributed")
    with pytest.raises(EnvironmentProblem, match=r"no scheduler answers at tcp://127\.0\.0\.1:9"):
        list(Cluster("tcp://127.0.0.1:9").run(eval, ["1"]))


def test_without_dask_it_is_said_what_to_install():
    program = "import sys; sys.modules['distributed'] = None\nfrom notebook_reports.executors.cluster import Cluster\n"
    done = subprocess.run(
        [sys.executable, "-c", program + "list(Cluster('2').run(eval, ['1']))"], capture_output=True, text=True
    )
    assert "--cluster needs Dask: pip install 'loopbook[cluster]'" in done.stderr


@pytest.mark.whole
def test_workers_of_its_own_listen_on_this_machine_alone():
    distributed = pytest.importorskip("distributed")
    with Cluster("1")._client(distributed) as client:
        assert client.scheduler.address.startswith("tcp://127.0.0.1:")
        assert all(worker.startswith("tcp://127.0.0.1:") for worker in client.scheduler_info()["workers"])


@pytest.mark.whole
def test_a_killed_worker_costs_what_it_was_doing_and_nothing_that_it_had_done(scheduler, tmp_path):
    """Results that are held on a worker until the end would be lost with it."""
    ran = str(tmp_path / "ran")
    jobs = [f"open({ran!r}, 'a').write('{n} ') and {n}" for n in range(12)]
    kill = f"open({ran!r}, 'a').write('k ') and open({ran!r}).read().count('k ') > 1 or o.kill(o.getppid(), 9)"
    jobs[9] = f"[o := __import__('os'), {kill} or __import__('time').sleep(9), 9][-1]"
    assert sorted(Cluster(scheduler).run(eval, jobs)) == [(n, n) for n in range(12)]
    assert len((tmp_path / "ran").read_text().split()) <= 12 + 2  # the killing job again, and one that waited there
