"""What a student's notebook may use."""

from dataclasses import asdict, dataclass
from typing import Any

MB = 1 << 20


@dataclass(frozen=True)
class NotebookLimits:
    """seconds: of the clock, for the whole notebook; call: for one call of a function. memory, file: bytes, of the
    process and of all that it writes. processes, open_files: at a time."""

    seconds: float = 60.0
    call: float = 2.0
    memory: int = 1536 * MB
    file: int = 32 * MB
    processes: int = 32
    open_files: int = 128

    def data(self) -> dict[str, Any]:
        """As plain data."""
        return asdict(self)


def impose(limits: dict[str, Any], own_processes: bool) -> None:
    """Set the limits of this process and of all that it starts. own_processes: are those of its user its own alone?"""
    import resource

    cpu = int(limits["seconds"]) + 1
    wanted = {
        "RLIMIT_AS": limits["memory"],
        "RLIMIT_FSIZE": limits["file"],
        "RLIMIT_NOFILE": limits["open_files"],
        "RLIMIT_CPU": cpu,
        "RLIMIT_CORE": 0,
    }
    if own_processes:
        wanted["RLIMIT_NPROC"] = limits["processes"]
    for name, value in wanted.items():
        number = getattr(resource, name, None)
        if number is not None:
            _, hard = resource.getrlimit(number)
            value = value if hard == resource.RLIM_INFINITY else min(value, hard)
            resource.setrlimit(number, (value, value))
