"""The program that runs, in numbers: sampled every h, filtered, within the limits, with the record's noise.

The loop is the exact sampled one. Its linear part is R u = T r - S y with

    R = (1 - z^-1)(1 - p3 z^-1)
    S = p2 R + p5 z^-1 (1 - p3 z^-1) - p4 z^-1 (1 - z^-1)
    T = p1 R + p5 z^-1 (1 - p3 z^-1)

which are the difference equations of the program (pid-report, figure 4.13) with the shift z^-1 for "one sample ago".
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from loopbook.controllers.pid import Pid
from loopbook.controllers.rst import Rst
from loopbook.design.model import Model
from loopbook.design.program import SampledProgram
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.sensitivity_peaks import sampled_peaks
from loopbook.response.simulation import Simulation, simulate

SAMPLES = 20000
SETTLED = 0.02  # of the step
AT_LIMIT = 1e-9  # of the limits' distance
CIRCLE = 1 << 14  # points on half of it
LONGEST_DELAY = 200  # samples: beyond, sampling costs nothing that could be seen and the polynomials grow long


def polynomials(program: SampledProgram) -> Rst:
    """The program's linear part as R u = T r - S y."""
    g = program.gains
    integral, filter = np.array([1.0, -1.0]), np.array([1.0, -g["p_3"]])
    R = np.convolve(integral, filter)
    late = np.array([0.0, 1.0])
    slow = g["p_5"] * np.convolve(late, filter)
    S = g["p_2"] * R + slow - g["p_4"] * np.convolve(late, integral)
    return Rst(tuple(R), tuple(S), tuple(g["p_1"] * R + slow), float(program.settings.h))


@dataclass(frozen=True)
class Running:
    """One program on one model.

    noise: standard deviation of the measurement's noise [y]. rest: (u, y) of the operating point. reference [y], load
    [u]: the steps. milder: a second model for the other direction, None where the process is the same both ways.
    """

    model: Model
    program: SampledProgram
    horizon: float
    reference: float
    load: float
    noise: float
    rest: tuple[float, float]
    milder: Model | None = None

    @cached_property
    def regulator(self) -> Rst:
        return polynomials(self.program)

    @cached_property
    def sampled(self) -> SampledLoop:
        return SampledLoop(self.model.process, self.regulator)

    @property
    def is_long(self) -> bool:
        """Is the dead time too many samples long for polynomials?"""
        return self.model.delay > LONGEST_DELAY * float(self.program.settings.h)

    @cached_property
    def Ms(self) -> float:
        """Of the sampled loop, infinite where it is unstable; NaN where `is_long`."""
        if self.is_long:
            return math.nan
        return sampled_peaks(self.sampled.on_circle)[0].value if self.sampled.is_stable else math.inf

    @cached_property
    def input_noise(self) -> float:
        """Standard deviation of u [u] that the measurement's noise makes: sigma sqrt(sum of h_k^2), h_k the response of
        u to one sample of noise, -C/(1 + C G) with C = S/R; the sum by Parseval, as the mean over the unit circle.
        With a dead time that `is_long` the loop is open to what noise does: C with its integrator made to forget.
        """
        if not self.is_long and not self.sampled.is_stable:
            return math.inf
        angle = (np.arange(CIRCLE) + 0.5) * np.pi / CIRCLE
        z = np.exp(-1j * angle)
        R, S = np.array(self.regulator.R), np.array(self.regulator.S)
        if self.is_long:
            R = R * np.power(1 - 1 / LONGEST_DELAY, np.arange(len(R)))
        answer = np.polyval(S[::-1], z) / np.polyval(R[::-1], z)
        if not self.is_long:
            answer = answer / (1 + self.sampled.at(angle))
        return self.noise * float(np.sqrt(np.mean(np.abs(answer) ** 2)))

    def _limits(self) -> tuple[float, float]:
        s = self.program.settings
        return float(s.u_low) - self.rest[0], float(s.u_high) - self.rest[0]

    def _run(self, reference: float, load: bool, noise: float) -> Simulation:
        settings = self.program.settings
        h, (low, high) = float(settings.h), self._limits()
        steps = max(int(min(self.horizon / h, SAMPLES)), 2)
        loads = np.where(np.arange(steps + 1) >= steps // 2, self.load, 0.0) if load else 0.0
        random = np.random.default_rng(0).normal(0, noise, steps + 1) if noise else 0.0
        controller = Pid(settings.changed(u_low=low, u_high=high))
        return simulate(self.model.process, controller, h, steps, reference=reference, load=loads, noise=random,
                        limits=(low, high))  # fmt: skip

    @cached_property
    def clean(self) -> Simulation:
        """A reference step at once and a load step half-way, without noise, as deviations from rest."""
        return self._run(self.reference, True, 0.0)

    @cached_property
    def _outputs(self) -> list[tuple[np.ndarray, float]]:
        """y after reference steps, with the height: of the first half of `clean`, and both ways where they differ."""
        if self.milder is None:
            half = len(self.clean.y) // 2
            return [(self.clean.y[:half], self.reference)]
        return [(self._both_ways(self.milder, sign * self.reference), sign * self.reference) for sign in (1.0, -1.0)]

    def _both_ways(self, milder: Model, reference: float) -> np.ndarray:
        """The program on a process that is faster one way than the other, from the middle of the limits' reach."""
        settings = self.program.settings
        h, (low, high) = float(settings.h), self._limits()
        if reference * self.reference < 0:  # the way back, from where the way out ended
            shift = self.reference / self.model.gain
            low, high = low - shift, high - shift
        rising, falling = self.model.lags[0], milder.lags[0]
        if not self.model.rises:
            rising, falling = falling, rising
        controller = Pid(settings.changed(u_low=low, u_high=high))
        ratio = self.model.delay / h
        whole, late = int(ratio + 1e-9), max(ratio - int(ratio + 1e-9), 0.0) * h
        slower = max(milder.lags[0] / self.model.lags[0], 1.0)
        steps = max(int(min(slower * self.horizon / 2 / h, SAMPLES)), 2)
        inputs, y, found = [0.0] * (whole + 2), 0.0, np.empty(steps)
        for k in range(steps):
            found[k] = y
            inputs.append(controller.step(y, reference))
            for u, time in ((inputs[-2 - whole], late), (inputs[-1 - whole], h - late)):
                target = self.model.gain * u
                T = rising if target > y else falling
                y = target + (y - target) * math.exp(-time / T)
        return found

    @cached_property
    def overshoot(self) -> float:
        """Of the reference step [%], the larger one where the directions differ."""
        return max(max(float(np.max(y / r)) - 1, 0.0) * 100 for y, r in self._outputs)

    @cached_property
    def settling(self) -> float:
        """From when on the output stays within 2 % of the reference step [s]; infinite where it does not."""
        found = []
        for y, r in self._outputs:
            outside = np.flatnonzero(np.abs(y / r - 1) > SETTLED)
            last = int(outside[-1]) + 1 if outside.size else 0
            found.append(last * float(self.program.settings.h) if last < len(y) else math.inf)
        return max(found)

    @cached_property
    def at_limit(self) -> float:
        """Share of the samples at a limit after a reference step, with the noise, once the step is over."""
        run = self._run(self.reference, False, self.noise)
        low, high = self._limits()
        if not (math.isfinite(low) or math.isfinite(high)):
            return 0.0
        later = run.u[len(run.u) // 2 :]
        slack = AT_LIMIT * (high - low if math.isfinite(high - low) else 1.0)
        return float(np.mean((later <= low + slack) | (later >= high - slack)))

    def _delay_margin(self, searched: float) -> float:
        """The delay margin [s]; beyond the few samples in which it is searched, the phase at the crossovers over w."""
        w = self.sampled.gain_crossovers
        if math.isfinite(searched) or not len(w):
            return searched
        left = np.angle(-self.sampled.at(w * float(self.program.settings.h))) % (2 * np.pi)
        return float(np.min(left / w))

    @property
    def peak_input(self) -> float:
        """The largest |u - u0| after the reference step [u]."""
        return float(np.abs(self.clean.u[: len(self.clean.u) // 2]).max())

    @cached_property
    def expected(self) -> dict[str, float | None]:
        """What to expect of the program that runs. Units: seconds, degrees, those of the record; null for infinite."""
        half = len(self.clean.y) // 2
        h = float(self.program.settings.h)
        errors = np.abs(self.clean.reference - self.clean.y)
        margins = self.sampled.margins() if not self.is_long and self.model.delay < 60 * h else None
        numbers = {
            "Ms": margins.Ms.value if margins else self.Ms,
            "Mt": margins.Mt.value if margins else math.nan,
            "gain_margin": margins.gain if margins else math.nan,
            "phase_margin": margins.phase if margins else math.nan,
            "delay_margin": self._delay_margin(margins.delay) if margins else math.nan,
            "reference_step": self.reference,
            "load_step": self.load,
            "overshoot": self.overshoot,
            "settling": self.settling,
            "iae_reference": float(errors[:half].sum() * h / abs(self.reference)),
            "iae_load": float(errors[half:].sum() * h / abs(self.load)) if self.load else math.nan,
            "peak_input": self.peak_input / abs(self.reference),
            "measurement_noise": self.noise,
            "input_noise": self.input_noise,
            "share_at_limit": self.at_limit,
        }
        return {name: float(v) if v is not None and math.isfinite(v) else None for name, v in numbers.items()}
