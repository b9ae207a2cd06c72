"""The executor that a command's options ask for."""

from collections.abc import Sequence

from notebook_reports.executors.cluster import Cluster
from notebook_reports.executors.executor import Executor
from notebook_reports.executors.processes import Processes


def executor_for(jobs: int | None, cluster: str | None, packages: Sequence[str], preloaded: Sequence[str]) -> Executor:
    """Processes here, so many as `jobs` says (None: one per core), or the workers that `cluster` names.

    packages: whose sources have to be the same on every worker, the one that is installed last. preloaded: modules
    that each process would import, imported once where it starts.
    """
    if cluster is None:
        return Processes(jobs, preloaded)
    return Cluster(cluster, packages, preloaded)
