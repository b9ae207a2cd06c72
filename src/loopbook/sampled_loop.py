"""A continuous process under a sampled regulator R u = T r - S y: poles, margins, responses between the samples.

On the unit circle z = exp(jwh) everything is a polynomial in cos wh: with the loop transfer n/d in z^-1,

    |d|^2 - |n|^2 = sum c_k cos(k w h)        Im(n conj d)/sin(w h) = sum e_k cos(k w h)

so gain and phase crossovers and the extremes of |1 + n/d| are roots of polynomials, all of them. The delay margin is a
delay of the continuous process, resampled with the dead time it adds: not an angle divided by a frequency.
"""

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.polynomial import chebyshev

from loopbook.loop_transfer import LoopError
from loopbook.process import Process
from loopbook.rst import Rst
from loopbook.sampling import SampledProcess, sample
from loopbook.sensitivity_peaks import Peak
from loopbook.simulation import Simulation, simulate

BORDER = 1e-9
SEARCH = 12


def _cosines(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Re(p conj q) on the unit circle as a Chebyshev series in cos wh; p, q in z^-1, ascending."""
    full = np.correlate(p, q, "full")
    middle = len(q) - 1
    series = np.zeros(max(len(p), len(q)))
    for i, c in enumerate(full):
        series[abs(i - middle)] += c
    return series


def _sines(p: np.ndarray, q: np.ndarray) -> np.ndarray:
    """Im(p conj q)/sin wh on the unit circle as a Chebyshev series: sin(k wh)/sin(wh) is U_(k-1)."""
    full = np.correlate(p, q, "full")
    middle = len(q) - 1
    series = np.zeros(max(len(p), len(q), 2))
    for i, c in enumerate(full):
        k = i - middle
        for j in range(abs(k) - 1, -1, -2):  # U_(k-1) = 2 T_(k-1) + 2 T_(k-3) + ..., the last T_0 once
            series[j] -= np.sign(k) * c * (2 if j else 1)
    return series


def _angles(series: np.ndarray) -> np.ndarray:
    """The angles wh in (0, pi) where a Chebyshev series in cos wh vanishes, ascending."""
    series = chebyshev.chebtrim(series, 1e-14 * np.abs(series).max(initial=0.0))
    if len(series) < 2:
        return np.zeros(0)
    x = chebyshev.chebroots(series)
    x = x[(abs(x.imag) < 1e-7) & (abs(x.real) < 1)].real
    return np.sort(np.arccos(x))


@dataclass(frozen=True)
class SampledMargins:
    """Margins of a stable sampled loop. gain, gain_low [-], phase [degrees], delay [s], Ms, Mt as in `margins.Margins`.

    delay is the smallest dead time that, added to the continuous process, makes the loop unstable; inf if none up to
    12 sampling intervals.
    """

    gain: float
    gain_low: float
    phase: float
    delay: float
    Ms: Peak
    Mt: Peak

    @property
    def gain_decibels(self) -> float:
        return float(20 * np.log10(self.gain))


@dataclass(frozen=True)
class SampledLoop:
    """process: continuous, with dead time. regulator: an `Rst`; its h is the sampling interval."""

    process: Process
    regulator: Rst

    @cached_property
    def sampled(self) -> SampledProcess:
        return sample(self.process, self.regulator.h)

    @cached_property
    def transfer(self) -> tuple[np.ndarray, np.ndarray]:
        """(n, d) of the loop transfer S B/(R A), in z^-1."""
        B, A = self.sampled.polynomials
        return np.convolve(self.regulator.S, B), np.convolve(self.regulator.R, A)

    @cached_property
    def poles(self) -> np.ndarray:
        """The zeros of A R + B S, the loop's poles in the z plane; those at the origin left out."""
        n, d = self.transfer
        total = np.zeros(max(len(n), len(d)))
        total[: len(n)] += n
        total[: len(d)] += d
        return np.roots(total).astype(complex)

    @cached_property
    def is_stable(self) -> bool:
        """All poles inside the unit circle, also those that process and regulator cancel."""
        return bool((abs(self.poles) < 1 - BORDER).all())

    def with_delay(self, more: float) -> "SampledLoop":
        """The same regulator on a process with `more` seconds of dead time added."""
        return SampledLoop(self.process.delayed(more), self.regulator)

    def with_gain(self, factor: float) -> "SampledLoop":
        """The same regulator on a process with `factor` times the gain."""
        return SampledLoop(self.process * factor, self.regulator)

    def at(self, angle: np.ndarray) -> np.ndarray:
        """The loop transfer at z = exp(j angle)."""
        inverse = np.exp(-1j * np.asarray(angle, dtype=float))
        n, d = self.transfer
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.polyval(n[::-1], inverse) / np.polyval(d[::-1], inverse)

    @cached_property
    def gain_crossovers(self) -> np.ndarray:
        """The w in (0, pi/h) [rad/s] with |n/d| = 1, ascending."""
        n, d = self.transfer
        return _angles(chebyshev.chebsub(_cosines(d, d), _cosines(n, n))) / self.regulator.h

    @cached_property
    def phase_crossovers(self) -> np.ndarray:
        """The w in [0, pi/h] [rad/s] where n/d is real and negative, ascending; both ends where they are."""
        n, d = self.transfer
        angles = np.concatenate([[0.0], _angles(_sines(n, d)), [np.pi]])
        value = self.at(angles)
        negative = np.isfinite(value) & (value.real < 0) & (abs(value.imag) < 1e-6 * np.maximum(abs(value), 1e-300))
        return angles[negative] / self.regulator.h

    def margins(self) -> SampledMargins:
        """All margins. Raises LoopError for an unstable loop, which has none."""
        if not self.is_stable:
            raise LoopError(f"the loop is unstable (a pole at |z| = {abs(self.poles).max():.6g}) and has no margins")
        h = self.regulator.h
        factors = 1 / abs(self.at(self.phase_crossovers * h))
        factors[factors < BORDER] = 0.0  # an integrator: the loop transfer is infinite at z = 1
        at_gain = np.degrees(np.angle(-self.at(self.gain_crossovers * h)))
        return SampledMargins(
            gain=float(factors[factors > 1].min(initial=np.inf)),
            gain_low=float(factors[factors < 1].max(initial=0.0)),
            phase=float(min(at_gain, key=abs, default=np.inf)),
            delay=self._delay_margin(),
            Ms=self._peak(self.transfer[1]),
            Mt=self._peak(self.transfer[0]),
        )

    def _peak(self, numerator: np.ndarray) -> Peak:
        """max |numerator/(d + n)| on the circle: the roots of the derivative of a quotient of two cosine series."""
        n, d = self.transfer
        total = np.zeros(max(len(n), len(d)))
        total[: len(n)] += n
        total[: len(d)] += d
        top, below = _cosines(numerator, numerator), _cosines(total, total)
        slope = chebyshev.chebsub(
            chebyshev.chebmul(chebyshev.chebder(top), below), chebyshev.chebmul(top, chebyshev.chebder(below))
        )
        angles = np.concatenate([[0.0], _angles(slope), [np.pi]])
        inverse = np.exp(-1j * angles)
        values = abs(np.polyval(numerator[::-1], inverse) / np.polyval(total[::-1], inverse))
        i = int(np.argmax(values))
        return Peak(float(values[i]), float(angles[i] / self.regulator.h))

    def _delay_margin(self) -> float:
        """The first added delay at which a pole reaches the unit circle, between grid points by root finding."""
        from scipy.optimize import brentq

        def beyond(delay: float) -> float:
            return float(abs(self.with_delay(delay).poles).max(initial=0.0)) - 1

        h = self.regulator.h
        steps = np.linspace(0, SEARCH * h, 8 * SEARCH + 1)
        for a, b in pairwise(steps):
            if beyond(b) > 0:
                return float(brentq(beyond, a, b, xtol=1e-12 * h))
        return np.inf

    def step(self, source: str, steps: int, low: float = -np.inf, high: float = np.inf) -> Simulation:
        """A unit step at t = 0 of "reference", "load" (at the process input) or "output" (added to the process output),
        over `steps` sampling intervals, with the actuator's limits low, high known to the regulator.
        """
        if source not in ("reference", "load", "output"):
            raise LoopError(f"source = {source!r}; one of reference, load, output")
        return simulate(self.process, self.regulator.controller(low, high), self.regulator.h, steps, **{source: 1.0})
