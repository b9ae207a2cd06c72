"""What went wrong, for a person: notebook, cell, what was expected and got, and the command to repeat it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from notebook_reports.project.printable import printable

LINES = 15


@dataclass(frozen=True)
class Failure:
    """One thing that failed.

    notebook: id, or "" where no single notebook is to blame. cell: position from 1, or 0. what: one line.
    more: lines that help to mend it. repeat: the command that shows it again. kind: notebook, check, export, ledger
    or environment.
    """

    notebook: str
    what: str
    cell: int = 0
    more: tuple[str, ...] = ()
    repeat: str = ""
    kind: str = "notebook"

    @property
    def line(self) -> str:
        where = ", ".join(filter(None, [self.notebook, f"cell {self.cell}" if self.cell else ""]))
        return f"{where}: {self.what}" if where else self.what

    def lines(self) -> list[str]:
        return [self.line, *(f"    {m}" for m in self.more)]


def summary(failures: Sequence[Failure], file: Path = Path(".cache/failures.txt"), limit: int = LINES) -> list[str]:
    """At most ``limit`` lines of a bearable length: all details where they fit, else one line each, else the first and
    how many more, which are in the file.

    Every command that repeats a failure is named once, at the end.
    """
    if not failures:
        return []
    repeats = list(dict.fromkeys(f.repeat for f in failures if f.repeat))
    tail = [f"Repeat: {_together(repeats)}"] if repeats else []
    head = ["", f"{len(failures)} failed:" if len(failures) > 1 else "1 failed:"]
    room = limit - len(head) - len(tail)
    full = [_cut(line) for f in failures for line in f.lines()]
    if len(full) <= room:
        return [*head, *full, *tail]
    short = [_cut(f.line) for f in failures]
    if len(short) > room:
        rest = len(short) - (room - 1)
        short = [*short[: room - 1], f"and {rest} more: all of them in {_near(file)}"]
    return [*head, *short, *tail]


def _near(path: Path) -> str:
    """A path as one would type it here."""
    return str(path.relative_to(Path.cwd()) if path.is_relative_to(Path.cwd()) else path)


def _cut(line: str, width: int = 240) -> str:
    return line if len(line) <= width else line[: width - 1] + "…"


def everything(failures: Sequence[Failure]) -> str:
    """The whole list, without a limit, for the file."""
    blocks = ["\n".join([*f.lines(), *([f"    {f.repeat}"] if f.repeat else [])]) for f in failures]
    return printable("\n\n".join(blocks) + "\n") if blocks else ""


def _together(repeats: list[str]) -> str:
    """All of them: the builds of notebooks that differ in nothing else as one command, the others one after another."""
    start = "loopbook build "
    plain: dict[str, list[str]] = {}
    others = []
    for command in repeats:
        notebook, _, options = command.removeprefix(start).partition(" -")
        if command.startswith(start) and notebook and " " not in notebook and "-p " not in f"-{options}":
            plain.setdefault(f" -{options}" if options else "", []).append(notebook)
        else:
            others.append(command)
    return "; ".join([*(f"{start}{' '.join(names)}{options}" for options, names in plain.items()), *others])
