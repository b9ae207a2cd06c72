"""What a build says: one line per notebook, a bar only on a terminal, everything else at the end."""

import sys
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any, Protocol, TextIO

from notebook_reports.project.failures import Failure
from notebook_reports.project.printable import printable
from notebook_reports.project.project import Notebook

NAMES = {"value": ("value", "values"), "claim": ("claim", "claims"), "misprint": ("misprint", "misprints")}


class Finished(Protocol):
    """What a build knows of a notebook that it is done with; see `build.job.Done`."""

    notebook: Notebook
    seconds: float
    failures: list[Failure]
    warnings: list[list[Any]]
    counts: dict[str, int]
    ran: bool


class Console:
    """Writes to a stream; a progress bar beside it where the stream is a terminal."""

    def __init__(self, out: TextIO | None = None, quiet: bool = False):
        self.out = out or sys.stdout
        self.quiet = quiet
        self._bar: Any = None

    def line(self, text: str = "") -> None:
        if self.quiet:
            return
        text = printable(text)
        if self._bar is not None:
            self._bar.write(text, file=self.out)
        else:
            print(text, file=self.out, flush=True)

    @contextmanager
    def progress(self, total: int) -> Iterator[None]:
        """Show how many notebooks are done, where somebody watches."""
        if self.quiet or not self.out.isatty():
            yield
            return
        from tqdm import tqdm

        form = "{n_fmt}/{total_fmt} |{bar}| {elapsed}"
        with tqdm(total=total, file=sys.stderr, leave=False, bar_format=form) as self._bar:
            try:
                yield
            finally:
                bar, self._bar = self._bar, None
                bar.close()

    def done(self, done: Finished, reasons: Sequence[str]) -> None:
        """One notebook: ok or FAIL, how long, what was checked, and why it was built."""
        good = not done.failures
        counts = [
            f"{n} {NAMES[t][n != 1]}" for t, n in sorted(done.counts.items(), key=lambda c: list(NAMES).index(c[0]))
        ]
        words = [f"{'ok' if good else 'FAIL':4}", done.notebook.id, f"{done.seconds:.1f} s"]
        words += [", ".join(counts)] if counts and good else []
        words += [because(reasons, done.ran)] if good else [_brief(done)]
        self.line("  ".join(w for w in words if w))
        if self._bar is not None:
            self._bar.update(1)

    def changes(self, lines: Sequence[str], limit: int = 8) -> None:
        """What is new or different in the ledger's files."""
        for text in lines[:limit]:
            self.line(f"ledger  {text}")
        if len(lines) > limit:
            self.line(f"ledger  and {len(lines) - limit} more rows")

    def warnings(self, done: Sequence[Finished], limit: int = 5) -> None:
        """What notebooks said on stderr."""
        found = []
        for one in done:
            for cell, text in one.warnings:
                where = f"{one.notebook.id}, cell {cell}" if cell else one.notebook.id
                found.append(f"warn  {where}: {text[:160]}")
        for text in found[:limit]:
            self.line(text)
        if len(found) > limit:
            self.line(f"warn  and {len(found) - limit} more")


def because(reasons: Sequence[str], ran: bool) -> str:
    """Why a notebook was built, in a few words; nothing for a first build."""
    if not reasons or reasons == ["first build"]:
        return ""
    more = f" and {len(reasons) - 1} more" if len(reasons) > 1 else ""
    return f"({'rebuilt' if ran else 'exported again'}: {reasons[0]}{more})"


def _brief(done: Finished) -> str:
    first = done.failures[0]
    more = f" (and {len(done.failures) - 1} more)" if len(done.failures) > 1 else ""
    text = f"cell {first.cell}: {first.what}" if first.cell else first.what
    return (text if len(text) <= 100 else text[:99] + "…") + more
