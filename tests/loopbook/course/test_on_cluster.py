"""A release on Dask's workers: the same bytes as here, whatever happens to a worker."""

import pytest

from loopbook.course.release.one import ReleaseJob, release_one
from loopbook.jobs import PACKAGES
from notebook_reports.executors.cluster import Cluster
from notebook_reports.executors.executor import surroundings
from notebook_reports.executors.processes import Processes

pytestmark = [pytest.mark.builds, pytest.mark.long]


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
def test_the_bytes_are_those_of_the_serial_run_also_with_a_killed_worker_and_a_time_out(
    scheduler, sheet_file, tmp_path
):
    content = sheet_file().read_bytes()
    numbers = [{"K": k, "T": t} for k in (1.7, 2.3) for t in (11.0, 17.0)]
    jobs = [
        ReleaseJob("lag", content, f"s{n}", own, b"a secret of sixteen", pdf=n == 0) for n, own in enumerate(numbers)
    ]
    serial = dict(Processes(1).run(release_one, jobs))
    assert all(not isinstance(one, Exception) for one in serial.values())
    for where in ("2", scheduler):
        assert dict(Cluster(where, PACKAGES).run(release_one, jobs)) == serial
    faults = {
        "killed": "o.kill(o.getppid(), 9) or __import__('time').sleep(9)",
        "ended": "o._exit(1)",
    }
    words = []
    for job, (name, fault) in zip(jobs, [*faults.items(), *[("", "")] * 9], strict=False):
        mark = str(tmp_path / name)
        once = f"o.path.exists({mark!r}) or open({mark!r}, 'w').close() or {fault}" if fault else "None"
        module = "__import__('loopbook.course.release.one', fromlist=['a'])"
        words.append(f"[o := __import__('os'), m := {module}, {once}, m.release_one(m.{job!r})][-1]")
    assert dict(Cluster(scheduler).run(eval, words)) == serial
    assert {p.name for p in tmp_path.iterdir()} >= set(faults)
