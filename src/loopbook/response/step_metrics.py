"""Rise time, settling time, overshoot and peak of a step response, in two named conventions.

``exact``    a continuous response y(t) and its true final value, from rest before the step. Crossing times are roots of
             y(t) - level, not grid points; the band of the settling time is 2 % of the whole step |final - rest|.
``sampled``  what MATLAB's ``stepinfo(y, t)`` does with samples: straight lines between them, the last sample as final
             value, and a band of 2 % of max |y - final|.

The two differ on the same response, so each result carries the name of its convention. In both, rise time is the time
from 10 % to 90 % of the way from the initial to the final value, and the settling time is the *absolute* time of the
last crossing into the band: it counts from t = 0 of the time axis given, not from the step.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from math import inf, isfinite, nan
from typing import Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.numerics.signals import Signal
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.response.signal_metrics import KNOWN, measures

BAND = 0.02
RISE = (0.1, 0.9)
SECTIONS, FINEST = 32, 1e-8
NO_STEP = 1e-12

Progress = Callable[[np.ndarray], np.ndarray]


class StepMetricsError(LoopbookError):
    """The response cannot be measured; the message says what to mend."""


class NotSettled(StepMetricsError):
    """The response is outside the band at the end of the horizon.

    horizon: end of the time axis, s. error: |y(horizon) - final|. band: half-width that it exceeds.
    """

    def __init__(self, horizon: float, error: float, band: float):
        self.horizon, self.error, self.band = horizon, error, band
        super().__init__(
            f"not settled at t = {horizon:g}: |y - final| = {error:.4g}, the band is {band:.4g}. "
            "Take a longer horizon; if that does not help, the loop is unstable or final is not its final value"
        )


@dataclass(frozen=True)
class StepMetrics(ShownAsTable):
    """Measures of one step response.

    rise: s. settling: s, absolute time. overshoot, undershoot: % of the step, >= 0. peak: largest |y|, in the unit of
    y. peak_time: s. final: the final value the others refer to. convention: "exact" or "sampled".
    """

    rise: float
    settling: float
    overshoot: float
    undershoot: float
    peak: float
    peak_time: float
    final: float
    convention: str

    def table(self) -> PlainTable:
        """Each measure with its unit."""
        rows = [["rise [s]", self.rise], ["settling [s]", self.settling], ["overshoot [%]", self.overshoot]]
        rows += [["undershoot [%]", self.undershoot], ["peak", self.peak], ["peak time [s]", self.peak_time]]
        return PlainTable(["step response", self.convention], [*rows, ["final", self.final]])


def _checked(t: np.ndarray, y: np.ndarray) -> None:
    if t.ndim != 1 or t.shape != y.shape:
        raise StepMetricsError(f"t and y must be one-dimensional and equally long, got shapes {t.shape} and {y.shape}")
    if len(t) < 2:
        raise StepMetricsError(f"a step response needs two samples or more, got {len(t)}")
    bad = np.flatnonzero(~np.isfinite(y) | ~np.isfinite(t))
    if bad.size:
        raise StepMetricsError(f"sample {bad[0]} is not finite: t = {t[bad[0]]}, y = {y[bad[0]]}")
    if np.any(np.diff(t) <= 0):
        raise StepMetricsError(f"t must increase; it does not after sample {np.flatnonzero(np.diff(t) <= 0)[0]}")


def sampled_metrics(
    y: Any, t: Any = None, final: float | None = None, band: float = BAND, *, rest: float | None = None
) -> StepMetrics:
    """Metrics of samples in the convention of MATLAB's ``stepinfo(y, t)``.

        rise       = t(90 %) - t(10 %), each the first crossing of rest + x (final - rest), linear between samples
        settling   = last time |y - final| falls to band * max|y - final|, linear between samples
        overshoot  = 100 max(0, max(y / final) - 1)           undershoot = 100 max(0, -min(y / final))
        peak       = max|y|, at its first sample

    y: samples. t: their times, s, increasing; default 1, 2, ... as in MATLAB. final: default the last sample. rest: y
    before the step, from which the first sample has jumped; by default the first sample (newer releases of MATLAB
    take 0 unless told otherwise; the same where the response starts at 0).
    NaN stands for a rise or settling time that the samples do not contain, as in MATLAB; with final = 0 overshoot is
    infinite. Raises StepMetricsError for NaN, unequal lengths, decreasing times.

    >>> m = sampled_metrics([0, 0.5, 1.0, 1.0], [0, 1, 2, 3])
    >>> round(m.rise, 9), round(m.settling, 9), m.overshoot
    (1.6, 1.96, 0.0)
    """
    y = np.asarray(y, dtype=float)
    t = np.arange(1.0, len(y) + 1) if t is None else np.asarray(t, dtype=float)
    _checked(t, y)
    final = float(y[-1]) if final is None else float(final)
    peak = int(np.argmax(np.abs(y)))
    over, under = _relative_to_final(y, final)
    peak_value, peak_time = float(abs(y[peak])), float(t[peak])
    if rest is not None and y[0] != rest:
        y, t = np.append(rest, y), np.append(t[0], t)
    low, high = (_first_crossing(t, y, y[0] + share * (final - y[0])) for share in RISE)
    return StepMetrics(
        rise=high - low,
        settling=_last_entry(t, y, final, band * float(np.max(np.abs(y - final)))),
        overshoot=over,
        undershoot=under,
        peak=peak_value,
        peak_time=peak_time,
        final=final,
        convention="sampled",
    )


def _between(t: np.ndarray, y: np.ndarray, i: int, level: float) -> float:
    """Where the straight line from sample i to sample i + 1 reaches the level."""
    if y[i] == y[i + 1]:
        return float(t[i + 1])
    return float(t[i] + (t[i + 1] - t[i]) * (level - y[i]) / (y[i + 1] - y[i]))


def _first_crossing(t: np.ndarray, y: np.ndarray, level: float) -> float:
    crossed = np.flatnonzero((y[:-1] - level) * (y[1:] - level) <= 0)
    return _between(t, y, int(crossed[0]), level) if crossed.size else nan


def _last_entry(t: np.ndarray, y: np.ndarray, final: float, band: float) -> float:
    outside = np.flatnonzero(np.abs(y - final) > band)
    if not outside.size:
        return 0.0
    last = int(outside[-1])
    if last == len(y) - 1:
        return nan
    return _between(t, y, last, final + np.sign(y[last] - final) * band)


def _relative_to_final(y: np.ndarray, final: float) -> tuple[float, float]:
    if final == 0:
        return inf, 0.0 if np.all(y >= 0) else inf
    over, under = float((y / final).max()) - 1, -float((y / final).min())
    return 100 * over if over > KNOWN else 0.0, 100 * under if under > KNOWN else 0.0


def exact_metrics(
    y: Signal | Callable[[np.ndarray], np.ndarray],
    final: float,
    horizon: float,
    *,
    rest: float | None = None,
    breakpoints: Iterable[float] = (),
    points: int = 4000,
    band: float = BAND,
) -> StepMetrics:
    """Metrics of a continuous response to a step at t = 0, with its true final value.

    With n(t) = (y(t) - rest) / (final - rest), where rest is the output before the step:

        rise       = t(n = 0.9) - t(n = 0.1), first crossings      settling  = last t with |n - 1| = band
        overshoot  = 100 max(0, max n - 1)                         undershoot = 100 max(0, -min n)

    y: a `Signal`, whose rest is 0 and of which nothing can be missed; or a function of an array of times, s, in
    [0, horizon]. final: lim y(t); for a disturbance that is controlled away it equals rest and none of these measures
    exists. horizon: s, long enough to settle.
    Of a function only: rest: by default y(0), right where y does not jump there. breakpoints: times where y has a
    corner or a jump (multiples of a dead time); extrema between two of them are found by refining. points: grid on
    which crossings are bracketed before they are refined to rounding; two crossings closer than horizon/points may be
    missed.
    Raises NotSettled (with horizon, error, band), and StepMetricsError for final = rest, NaN, a horizon <= 0.

    >>> m = exact_metrics(lambda t: 1 - np.exp(-t), final=1.0, horizon=20.0)
    >>> round(m.rise, 9), round(m.settling, 9)                           # ln 9, ln 50
    (2.197224577, 3.912023005)
    """
    if not (isfinite(horizon) and horizon > 0):
        raise StepMetricsError(f"horizon must be a positive time in s, got {horizon}")
    if not isfinite(final):
        raise StepMetricsError(f"final must be finite, got {final}: a response without a final value does not settle")
    if isinstance(y, Signal):
        y = y.until(min(horizon, y.end))
        largest, end = abs(y.peak()[1]), float(y(y.end))
        _need_a_step(final, 0.0, largest)
        if abs(end - final) > band * abs(final):
            raise NotSettled(y.end, abs(end - final), band * abs(final))
        return StepMetrics(*measures(y, final, band, RISE), final=float(final), convention="exact")
    inside = [b for b in breakpoints if 0 < b < horizon]
    t = np.unique(np.concatenate([np.linspace(0.0, horizon, points + 1), inside]))
    values = np.asarray(y(t), dtype=float)
    _checked(t, values)
    before = float(values[0] if rest is None else rest)
    step = final - before
    _need_a_step(final, before, float(np.max(np.abs(values))))

    def progress(s: np.ndarray) -> np.ndarray:
        return (np.asarray(y(s), dtype=float) - before) / step

    n = (values - before) / step
    if abs(n[-1] - 1) > band:
        raise NotSettled(horizon, abs(values[-1] - final), band * abs(step))
    low, high = (_root(progress, t, int(np.flatnonzero(n >= share)[0]), share) for share in RISE)
    top, bottom = _extremum(progress, t, n, 1), _extremum(progress, t, n, -1)
    settling = _settling(progress, t, n, band)
    peak_time, peak = max(((s, float(before + v * step)) for s, v in (top, bottom)), key=lambda p: abs(p[1]))
    return StepMetrics(
        rise=high - low,
        settling=settling,
        overshoot=100 * max(0.0, top[1] - 1),
        undershoot=100 * max(0.0, -bottom[1]),
        peak=abs(peak),
        peak_time=peak_time,
        final=float(final),
        convention="exact",
    )


def _need_a_step(final: float, rest: float, largest: float) -> None:
    if abs(final - rest) <= NO_STEP * max(largest, abs(final)):
        raise StepMetricsError(
            f"the response ends where it begins ({final + 0.0:g}): rise, settling and overshoot refer to the step "
            "final - y(0). For a disturbance response use its peak and integrals"
        )


def _root(progress: Progress, t: np.ndarray, i: int, level: float) -> float:
    """The crossing of the level between grid points i - 1 and i; at a jump, the jump."""
    from scipy.optimize import brentq

    gap = lambda s: float(progress(np.array([s]))[0]) - level  # noqa: E731
    if i == 0 or gap(t[i - 1]) == 0:
        return float(t[max(i - 1, 0)])
    return float(brentq(gap, t[i - 1], t[i], xtol=1e-13 * t[-1], rtol=1e-14))


def _extremum(progress: Progress, t: np.ndarray, n: np.ndarray, sign: int) -> tuple[float, float]:
    """Time and value of the largest (sign 1) or smallest (sign -1) n, refined between its neighbours on the grid."""
    return _refined(progress, t, n, int(np.argmax(sign * n)), sign)


def _refined(progress: Progress, t: np.ndarray, n: np.ndarray, i: int, sign: int) -> tuple[float, float]:
    """The same from grid point i on: a finer grid around the best point, again and again, on either side of i."""
    best = (float(t[i]), float(n[i]))
    for a, b in ((i - 1, i), (i, i + 1)):
        if a < 0 or b == len(t):
            continue
        low, high = t[a], t[b]
        while high - low > FINEST * (t[b] - t[a]):
            s = np.linspace(low, high, SECTIONS + 1)
            values = progress(s)
            k = int(np.argmax(sign * values))
            if sign * values[k] > sign * best[1]:
                best = (float(s[k]), float(values[k]))
            low, high = s[max(k - 1, 0)], s[min(k + 1, SECTIONS)]
    return best


def _settling(progress: Progress, t: np.ndarray, n: np.ndarray, band: float) -> float:
    """Last time the error leaves the band, with the extrema between grid points taken into account."""
    error = np.abs(n - 1)
    outside = np.flatnonzero(error > band)
    if not outside.size:
        return 0.0
    last = int(outside[-1])
    middle = error[1:-1]
    tops = 1 + np.flatnonzero((middle >= error[:-2]) & (middle >= error[2:]) & (middle > 0.5 * band))
    for i in (int(k) for k in tops[::-1] if k > last):
        sign = 1 if n[i] > 1 else -1
        s, value = _refined(progress, t, n, i, sign)
        if sign * (value - 1) > band:
            after = np.searchsorted(t, s, side="right")
            t = np.concatenate([[s], t[after:]])
            return _root(progress, t, 1, 1 + sign * band)
    return _root(progress, t, last + 1, 1 + np.sign(n[last] - 1) * band)
