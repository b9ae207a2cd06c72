"""The crossovers and margins of a transfer function on the unit circle as objects with their frequencies."""

import numpy as np

from loopbook.loop.margins import GainCrossover, Margins, PhaseCrossover
from loopbook.loop.sensitivity_peaks import Peak, sampled_peaks
from loopbook.loop.unit_circle import CircleTransfer

NONE = 1e-9


def gain_crossovers(circle: CircleTransfer, h: float) -> tuple[GainCrossover, ...]:
    """All w in (0, pi/h) [rad/s] with |G| = 1, with the phase margin, and the delay exp(-jw delay) that uses it up."""
    found = []
    for angle in circle.gain_crossovers.tolist():
        margin = float(np.angle(-circle(np.array(angle))))
        found.append(GainCrossover(angle / h, float(np.degrees(margin)), (margin % (2 * np.pi)) * h / angle))
    return tuple(found)


def phase_crossovers(circle: CircleTransfer, h: float) -> tuple[PhaseCrossover, ...]:
    """All w in [0, pi/h] [rad/s] where G is real, negative and finite, with the factor to -1."""
    angles = circle.phase_crossovers
    return tuple(
        PhaseCrossover(angle / h, factor)
        for angle in angles.tolist()
        if (factor := float(1 / abs(circle(np.array(angle))))) > NONE
    )


def circle_margins(circle: CircleTransfer, h: float) -> Margins:
    """The margins of a stable loop whose transfer function on the circle is given."""
    at_gain, at_phase = gain_crossovers(circle, h), phase_crossovers(circle, h)
    Ms, Mt = sampled_peaks(circle)
    return Margins(
        gain=min((c.gain for c in at_phase if c.gain > 1), default=np.inf),
        gain_low=max((c.gain for c in at_phase if c.gain < 1), default=0.0),
        phase=min((c.phase_margin for c in at_gain), key=abs, default=np.inf),
        delay=min((c.delay_margin for c in at_gain), default=np.inf),
        Ms=Peak(Ms.value, Ms.w / h),
        Mt=Peak(Mt.value, Mt.w / h),
        gain_crossovers=at_gain,
        phase_crossovers=at_phase,
    )
