"""The six figures that a PID tuning tool shows of a loop, computed exactly."""

from loopbook.ledger import rounds_to
from loopbook.loop import Loop

SHOWN = ("rise", "settling", "overshoot", "peak", "gain-margin", "phase-margin")


def displayed(loop: Loop) -> dict[str, float]:
    """rise [s], settling [s], overshoot [%], peak [y], gain-margin [dB], phase-margin [degrees] of a stable loop.

    The first four from the response to a unit step of the reference in continuous time, the band of the settling time
    2 %; the margins with the exact dead time.
    """
    step, margins = loop.step("reference").metrics(), loop.margins()
    found = (step.rise, step.settling, step.overshoot, step.peak, margins.gain_decibels, margins.phase)
    return dict(zip(SHOWN, found, strict=True))


def agreeing(found: dict[str, float], printed: dict[str, str]) -> int:
    """How many of the figures round to what is printed.

    >>> agreeing({"rise": 2.958, "peak": 1.44}, {"rise": "2.96", "peak": "1.4"})
    2
    """
    return sum(rounds_to(found[name], digits) for name, digits in printed.items())
