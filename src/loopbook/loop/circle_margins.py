"""The crossovers of a transfer function on the unit circle as objects with their frequencies."""

import numpy as np

from loopbook.loop.margins import GainCrossover, PhaseCrossover
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
