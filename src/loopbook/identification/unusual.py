"""Shapes that no lags have: a response that rings, and one that starts the wrong way. Only where the record asks."""

from loopbook.identification.fit import Fit
from loopbook.identification.least_squares import fit_structure
from loopbook.identification.models import UNDERDAMPED, UNUSUAL
from loopbook.records.record import Record
from loopbook.records.steps import Steps

ASKS = 0.3  # correlation of the residuals that shows that the lags leave something
GOOD = 97.0  # percent
MOST_STEPS = 40
MOST_DAMPED = 0.7  # above, two lags do as well
LEAST_ZERO = 0.1  # of the lags: a shorter one is a dead time


def asks(best: Fit, steps: Steps) -> bool:
    """Do the lags leave a pattern, in a record of steps?"""
    return len(steps.list) <= MOST_STEPS and (best.correlation > ASKS or best.fit < GOOD)


def unusual_fits(record: Record, steps: Steps, nuisance: str) -> list[Fit]:
    """The unusual structures whose own part is seen: a ringing that rings, a zero that is longer than a dead time."""
    fits = [
        fit_structure(record, structure, steps, "drift" if nuisance == "drift" else "rest") for structure in UNUSUAL
    ]
    return [fit for fit in fits if _is_seen(fit)]


def _is_seen(fit: Fit) -> bool:
    own = fit.parameters[-2]
    if own.half_width >= abs(own.value) or any(p.half_width >= abs(p.value) for p in fit.parameters[:-2]):
        return False
    if fit.structure is UNDERDAMPED:
        return own.value < MOST_DAMPED
    return own.value > LEAST_ZERO * sum(fit.lags[:2])
