"""What of a plant's loops needs attention, and in which order."""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

FAILED, REFUSED, LACKS, FRAGILE, LIMITED, DOUBTFUL, MIND, FINE = (
    "failed",
    "refused",
    "lacks",
    "fragile",
    "at a limit",
    "poor fit",
    "mind",
    "good",
)
ORDER = (FAILED, REFUSED, LACKS, FRAGILE, LIMITED, DOUBTFUL, MIND, FINE)
"""The worst first: nothing is known; no model can be trusted; the aim is not kept; the rest by what may go wrong."""
MOST_MS = 2.0
MOST_AT_LIMIT = 0.05  # of the samples
LEAST_FIT = 80.0  # % of the response


@dataclass(frozen=True)
class LoopRow:
    """One loop. failed, refused: why there is no design, "" where there is one. fit [%], Ms, overshoot [%],
    settling [s], at_limit (share of the samples), the process and its settings: None where unknown. lacks: does the
    program not keep what the aim asks? mind: the cautions.
    """

    name: str
    failed: str = ""
    refused: str = ""
    rule: str = ""
    gain: float | None = None
    time_constant: float | None = None
    delay: float | None = None
    K: float | None = None
    Ti: float | None = None
    Td: float | None = None
    fit: float | None = None
    Ms: float | None = None
    overshoot: float | None = None
    settling: float | None = None
    at_limit: float | None = None
    lacks: bool = False
    mind: tuple[str, ...] = ()

    @property
    def state(self) -> str:
        """The first of `ORDER` that holds."""
        if self.failed or self.refused:
            return FAILED if self.failed else REFUSED
        if self.lacks:
            return LACKS
        if self.Ms is not None and self.Ms > MOST_MS:
            return FRAGILE
        if self.at_limit is not None and self.at_limit > MOST_AT_LIMIT:
            return LIMITED
        if self.fit is not None and self.fit < LEAST_FIT:
            return DOUBTFUL
        return MIND if self.mind else FINE

    @property
    def why(self) -> str:
        """One sentence or more: what to look at."""
        state = self.state
        if state in (FAILED, REFUSED):
            return self.failed or self.refused
        said = any("unexplained" in text for text in self.mind)
        told = {
            FRAGILE: f"Ms is {self.Ms or 0:.2f}.",
            LIMITED: f"{100 * (self.at_limit or 0):.0f} % of the samples are at a limit.",
            DOUBTFUL: "" if said else f"The model explains {self.fit or 0:.0f} % of the response.",
        }
        return " ".join(filter(None, [told.get(state, ""), *self.mind]))


def ranked(rows: Iterable[LoopRow]) -> list[LoopRow]:
    """The loops, what needs attention most first: by `ORDER`, then the larger Ms, the poorer fit, the name."""
    return sorted(rows, key=lambda r: (ORDER.index(r.state), -(r.Ms or 0.0), _known(r.fit), r.name))


def _known(value: float | None) -> float:
    return math.inf if value is None else value


def row_of(name: str, found: dict[str, Any], lacks: bool, cautions: Sequence[str]) -> LoopRow:
    """The row of a design. found: its JSON. Limits that the record gave are every loop's, and no reason to look."""
    process, settings, expected = found["process"], found["settings"], found["expected"]
    lags, fit = process["time_constants"], process["fit"]
    return LoopRow(
        name,
        rule=found["rule"],
        gain=process["gain"],
        time_constant=sum(lags) if lags else None,
        delay=process["delay"],
        K=settings["K"],
        Ti=settings["Ti"] if settings["Ti"] and math.isfinite(settings["Ti"]) else None,
        Td=settings["Td"],
        fit=fit["percent"] if fit else None,
        Ms=expected["Ms"],
        overshoot=expected["overshoot"],
        settling=expected["settling"],
        at_limit=expected["share_at_limit"],
        lacks=lacks,
        mind=tuple(text for text in cautions if not text.startswith("Limits")),
    )
