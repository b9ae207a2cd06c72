"""What is offered beside the PID: only where it is clearly better, with the number that says so."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from loopbook.design.evaluation import Evaluation

CLEARLY = 0.8  # of the PID's integrated error: what is less is offered
SHORTER = 2.5  # than `settling_horizon`, which waits for eleven decades
SAME = 1e-3  # what two integrals may differ by and be the same


@dataclass(frozen=True)
class Offer:
    """One structure beyond the PID.

    what: its name. measured: by which error it is compared. theirs, pid: that error with it and with the best PID
    [y s].
    numbers: what to enter, by name. says: sentences; how wrong the model may be is among them. refused: why it was not
    tried, "" where it was.
    """

    what: str
    measured: str = ""
    theirs: float = math.nan
    pid: float = math.nan
    numbers: tuple[tuple[str, float], ...] = ()
    says: tuple[str, ...] = ()
    refused: str = ""

    @property
    def offered(self) -> bool:
        """Is it clearly better than the best PID?"""
        return not self.refused and self.theirs <= CLEARLY * (1 + SAME) * self.pid

    @property
    def verdict(self) -> str:
        """In a sentence, with the number."""
        if self.refused:
            return f"not tried: {self.refused}"
        less = 100 * (1 - self.theirs / self.pid)
        change = f"{less:.0f} % less" if less >= 0 else f"{-less:.0f} % more"
        told = f"the integrated error after {self.measured} is {self.theirs:.4g} instead of {self.pid:.4g}"
        if self.offered:
            return f"clearly better: {told}, {change}"
        return f"not clearly better than the best PID: {told} ({change}; {100 * (1 - CLEARLY):.0f} % less are asked)"

    def data(self) -> dict[str, Any]:
        """As plain data; infinite and unknown are None."""
        finite = lambda x: x if math.isfinite(x) else None  # noqa: E731
        return {
            "what": self.what,
            "offered": self.offered,
            "verdict": self.verdict,
            "iae": finite(self.theirs),
            "iae_pid": finite(self.pid),
            "numbers": {name: finite(value) for name, value in self.numbers},
            "says": list(self.says),
        }


def best_pid(loops: Sequence[Evaluation], Ms: float) -> Evaluation | None:
    """Of the loops that keep Ms the one that does best after a load step; None where none keeps it."""
    kept = [e for e in loops if e.stable and e.Ms <= Ms]
    return min(kept, key=lambda e: e.iae_load, default=None)


def integrated_error(loop: Any, source: str, horizon: float) -> float:
    """The integral of |error| [y s] after a unit step of one input, over a horizon [s] in which it vanishes.

    Until a delayed output begins to move, the error after a reference step is 1.
    """
    y = loop.closed(source, "y").step_signal(horizon)
    error = 1.0 - y if source == "reference" else y
    return float(error.integral_of_magnitude()) + (float(y.edges[0]) if source == "reference" else 0.0)


def vanished(loop: Any, lags: Sequence[float], late: float) -> float:
    """A horizon [s] after which nothing is left: of the slowest mode and of further lags [s], behind dead times [s]."""
    return max([float(loop.settling_horizon()) / SHORTER, *(12 * T for T in lags)]) + 4 * late
