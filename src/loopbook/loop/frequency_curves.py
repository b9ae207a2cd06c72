"""What a frequency diagram draws: gain and phase of a loop transfer with its crossovers and its peak, as arrays."""

import math
from typing import Any

import numpy as np

from loopbook.loop import circle_margins, margins
from loopbook.loop.sensitivity_peaks import sampled_peaks, sensitivity_peak
from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.loop.unit_circle import CircleTransfer
from loopbook.numerics.exponential_polynomial import characteristic_time_of
from loopbook.plots.frequency import Curve
from loopbook.process.algebra import TransferAlgebra

DECADES = 1.5  # beyond the outermost corner
TURN = 0.1  # rad of dead-time phase between neighbouring points


def _degrees(value: np.ndarray) -> np.ndarray:
    return np.degrees(np.unwrap(np.angle(value)))


def of_transfer(transfer: LoopTransfer, w: np.ndarray | None = None, stable: bool | None = None) -> Curve:
    """Of a rational transfer with one dead time. stable: is the closed loop? None: no loop, no margins."""
    w = _frequencies(transfer) if w is None else w
    value = transfer(1j * w)
    if stable is None:
        return Curve(w, abs(value), _degrees(value))
    at_gain = [(c.w, c.phase_margin) for c in margins.gain_crossovers(transfer)]
    at_phase = [(c.w, c.gain) for c in margins.phase_crossovers(transfer)]
    peak = None
    if stable:
        try:
            Ms = sensitivity_peak(transfer)
            peak = (Ms.w, Ms.value)
        except LoopError:
            peak = None
    return Curve(w, abs(value), _degrees(value), at_phase, at_gain, peak)


def _frequencies(transfer: LoopTransfer) -> np.ndarray:
    """From below the lowest corner to above the highest, dense enough for the turns of a dead time."""
    corners = [abs(r) for r in (*transfer.poles, *transfer.zeros) if abs(r) > 0] + list(transfer.gain_crossovers)
    corners += [1 / transfer.delay] if transfer.delay else []
    low, high = min(corners, default=1.0) / 10**DECADES, max(corners, default=1.0) * 10**DECADES
    if transfer.delay:
        high = min(high, max(8 / transfer.delay, 3 * max(transfer.gain_crossovers, default=0.0)))
    w = np.geomspace(low, high, 600)
    if transfer.delay:
        w = np.union1d(w, np.arange(TURN, high * transfer.delay, TURN) / transfer.delay)
    return w


def of_sums(transfer: TransferAlgebra, w: np.ndarray | None = None, found: Any = None) -> Curve:
    """Of what has dead times inside: its corners are not all roots of a polynomial. found: `Margins`, if there are."""
    num, den = transfer.fraction
    if w is None:
        time, longest = characteristic_time_of(num, den), max([*num.delays, *den.delays])
        high = max(30 / time, 8 / longest if longest else 0.0)
        w = np.geomspace(1e-3 / time, high, 900)
        w = np.union1d(w, np.arange(TURN, high * longest, TURN) / longest) if longest else w
    value = np.asarray(num(1j * w) / den(1j * w))
    if found is None:
        return Curve(w, abs(value), _degrees(value))
    at_gain = [(c.w, c.phase_margin) for c in found.gain_crossovers]
    at_phase = [(c.w, c.gain) for c in found.phase_crossovers]
    return Curve(w, abs(value), _degrees(value), at_phase, at_gain, (found.Ms.w, found.Ms.value))


def of_circle(circle: CircleTransfer, h: float, w: np.ndarray | None = None, stable: bool = False) -> Curve:
    """Of a loop transfer at z = exp(jwh), up to half the sampling frequency."""
    w = up_to_half_the_sampling(h) if w is None else w
    value = circle(w * h)
    at_gain = [(c.w, c.phase_margin) for c in circle_margins.gain_crossovers(circle, h)]
    at_phase = [(c.w, c.gain) for c in circle_margins.phase_crossovers(circle, h) if c.w > 0]
    Ms = sampled_peaks(circle)[0] if stable else None
    return Curve(w, abs(value), _degrees(value), at_phase, at_gain, None if Ms is None else (Ms.w / h, Ms.value))


def of_pulses(system: Any, w: np.ndarray | None = None) -> Curve:
    """Of a sampled process or a plant in z alone."""
    w = up_to_half_the_sampling(system.h) if w is None else w
    value = system(np.exp(1j * w * system.h))
    return Curve(w, abs(value), _degrees(value))


def up_to_half_the_sampling(h: float) -> np.ndarray:
    """Frequencies [rad/s] over three decades."""
    return np.geomspace(1e-3, 1.0, 1200) * math.pi / h
