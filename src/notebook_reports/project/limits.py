"""What the machine has to allow before work begins: open files and memory."""

import sys
from pathlib import Path

from notebook_reports.project.project import EnvironmentProblem

FILES, FILES_A_KERNEL = 64, 32
MEMORY = 1_000_000_000
"""Bytes of address space that one kernel with its libraries takes, with room for its work."""
RESIDENT = 500_000_000
_CONTAINER = Path("/sys/fs/cgroup/memory.max")


def check(jobs: int) -> None:
    """Raise EnvironmentProblem where so many kernels cannot run beside each other, with what to do about it."""
    if sys.platform == "win32":
        return
    import resource

    needed = FILES + FILES_A_KERNEL * jobs
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    if soft != resource.RLIM_INFINITY and soft < needed:
        if hard != resource.RLIM_INFINITY and hard < needed:
            fewer = (hard - FILES) // FILES_A_KERNEL
            cure = f"-j {fewer}" if fewer >= 1 else f"ulimit -n {needed}"
            raise EnvironmentProblem(
                f"only {hard} files may be open at once, {needed} are needed for {jobs} "
                f"kernel{'s' if jobs > 1 else ''}: {cure}"
            )
        resource.setrlimit(resource.RLIMIT_NOFILE, (needed, hard))
    for limit in (resource.RLIMIT_AS, resource.RLIMIT_DATA):
        allowed = resource.getrlimit(limit)[0]
        if allowed != resource.RLIM_INFINITY and allowed < MEMORY:
            raise EnvironmentProblem(
                f"only {allowed / 1e6:.0f} MB of memory are allowed (ulimit -v, ulimit -d), "
                f"{MEMORY / 1e6:.0f} MB are needed: ulimit -v unlimited"
            )
    room = _of_the_container()
    if room < RESIDENT:
        raise EnvironmentProblem(
            f"this container has {room / 1e6:.0f} MB of memory, {RESIDENT / 1e6:.0f} MB are needed: allow it more"
        )


def _of_the_container() -> float:
    try:
        return float(_CONTAINER.read_text())
    except (OSError, ValueError):
        return float("inf")
