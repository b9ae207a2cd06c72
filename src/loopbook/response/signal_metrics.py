"""The measures of a step response that is known as a `Signal`: crossings and extremes of its polynomials, no grid.

However long the response creeps, nothing that happens early is missed. The signal is at rest, at zero, before it
begins, so that a jump at the beginning is part of the step.
"""

from typing import NamedTuple

from loopbook.numerics.signals import Signal

KNOWN = 1e-11
"""What part of the step the response is known to: a smaller overshoot is rounding."""


class Measures(NamedTuple):
    """rise, settling [s], overshoot, undershoot [%], peak [y], peak_time [s] of a `step_metrics.StepMetrics`."""

    rise: float
    settling: float
    overshoot: float
    undershoot: float
    peak: float
    peak_time: float


def measures(y: Signal, final: float, band: float, rise: tuple[float, float]) -> Measures:
    """Of a response from 0 to `final` that ends inside the band around it.

    A peak that is only approached, as by a response without overshoot, is that of the end; of one jump, the jump.
    """
    low, high = (float(y.roots(share * final)[0]) for share in rise)
    entries = [*y.roots((1 + band) * final), *y.roots((1 - band) * final)]
    extremes = [(time, value / final) for time, value in (y.maximum(), y.minimum())]
    (bottom_time, bottom), (top_time, top) = sorted(extremes, key=lambda point: point[1])
    if top <= 1 + KNOWN:
        at_once = high == low and abs(float(y(low)) / final - 1) <= KNOWN
        top_time, top = (low if at_once else y.end), float(y(y.end)) / final
    peak, peak_time = (-bottom, bottom_time) if -bottom > top else (top, top_time)
    return Measures(
        rise=high - low,
        settling=float(max(entries)),
        overshoot=100 * (top - 1) if top > 1 + KNOWN else 0.0,
        undershoot=-100 * bottom if bottom < -KNOWN else 0.0,
        peak=peak * abs(final),
        peak_time=peak_time,
    )
