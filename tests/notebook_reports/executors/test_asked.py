"""Which executor a command's options ask for."""

from notebook_reports.executors.asked import executor_for
from notebook_reports.executors.cluster import Cluster
from notebook_reports.executors.processes import Processes


def test_processes_here_or_a_cluster():
    here = executor_for(3, None, ("notebook_reports",), ("json",))
    assert isinstance(here, Processes) and here.number == 3 and here.preloaded == ("json",)
    there = executor_for(3, "tls://host:8786", ("notebook_reports",), ("json",))
    assert isinstance(there, Cluster) and there.packages == ("notebook_reports",) and there.preloaded == ("json",)
