"""A loop in the z domain: a plant known at the samples only, under a sampled regulator R u = T r - S y.

What a `loopbook.loop.sampled.SampledLoop` answers about a continuous process between the samples cannot be told here.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from loopbook.controllers.rst import Rst, zeros_of
from loopbook.loop.circle_margins import circle_margins
from loopbook.loop.frequency_curves import of_circle
from loopbook.loop.inside_circle import is_stable_in_z, row_sum
from loopbook.loop.margins import Margins
from loopbook.loop.shown_loop import ShownLoop, said_of
from loopbook.loop.transfer import LoopError
from loopbook.loop.unit_circle import CircleTransfer
from loopbook.plots.frequency import Curve
from loopbook.plots.stairs import stairs
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.near_one import zeros_near_one
from loopbook.process.sampled import SampledProcess

SOURCES, OUTPUTS = ("reference", "load", "noise"), ("y", "u")


def _rst(regulator: Any, h: float) -> Rst:
    if isinstance(regulator, Rst):
        if regulator.h != h:
            raise LoopError(f"the plant is sampled every {h:g} s, the regulator every {regulator.h:g} s")
        return regulator
    one = DiscreteProcess((1.0,), (1.0,), h).with_other(regulator)
    if one is None:
        raise LoopError(f"{type(regulator).__name__} is no regulator: give an Rst, a DiscreteProcess or a number")
    return Rst(tuple(one.den), tuple(one.num), tuple(one.num), h)


@dataclass(frozen=True, repr=False)
class DiscreteLoop(ShownLoop):
    """plant: a `DiscreteProcess` or a `SampledProcess`. regulator: an `Rst`, a `DiscreteProcess`, or a number.

    >>> loop = DiscreteLoop(DiscreteProcess.in_z([0.04798, 0.0464], [1, -1.81, 0.9048], 0.1))
    >>> round(loop.margins().gain, 4), round(loop.margins().phase, 4)
    (2.0517, 13.5712)
    """

    plant: Any
    regulator: Any = 1.0

    @cached_property
    def _plant(self) -> DiscreteProcess:
        return DiscreteProcess.of(self.plant)

    @cached_property
    def polynomials(self) -> Rst:
        """The regulator as polynomials R, S, T."""
        return _rst(self.regulator, self._plant.h)

    @property
    def h(self) -> float:
        """The sampling interval [s]."""
        return self._plant.h

    @cached_property
    def transfer(self) -> DiscreteProcess:
        """The loop transfer S B/(R A)."""
        c = self.polynomials
        num, den = np.convolve(c.S, self._plant.num), np.convolve(c.R, self._plant.den)
        return DiscreteProcess(tuple(num), tuple(den), self.h)

    @cached_property
    def on_circle(self) -> CircleTransfer:
        """The loop transfer at z = exp(j angle)."""
        if isinstance(self.plant, SampledProcess):
            return circle_of_sampled(self.plant, self.polynomials)
        return circle_of(self.transfer)

    @cached_property
    def poles(self) -> np.ndarray:
        """The zeros of R A + S B in z, those at the origin included."""
        return self.closed("reference", "y").poles

    @cached_property
    def is_stable(self) -> bool:
        """All poles inside the unit circle, also those that plant and regulator cancel.

        Where poles crowd around the circle they are counted by the turning of the loop transfer, which needs no root of
        a long polynomial.
        """
        n, d = np.asarray(self.transfer.num), np.asarray(self.transfer.den)
        return is_stable_in_z(n, d, lambda: self.on_circle)

    def closed(self, source: str = "reference", output: str = "y") -> DiscreteProcess:
        """From "reference", "load" (at the plant's input) or "noise" to "y" or "u"."""
        if source not in SOURCES or output not in OUTPUTS:
            raise LoopError(f"from {source!r} to {output!r}: from {', '.join(SOURCES)}, to {' or '.join(OUTPUTS)}")
        c, B, A = self.polynomials, self._plant.num, self._plant.den
        n, d = self.transfer.num, self.transfer.den
        below = row_sum(np.asarray(n), np.asarray(d))
        above = {
            ("reference", "y"): np.convolve(c.T, B),
            ("reference", "u"): np.convolve(c.T, A),
            ("load", "y"): np.convolve(c.R, B),
            ("load", "u"): -np.convolve(c.S, B),
            ("noise", "y"): -np.convolve(c.S, B),
            ("noise", "u"): -np.convolve(c.S, A),
        }[source, output]
        return DiscreteProcess(tuple(above), tuple(below), self.h)

    def parts(self) -> list[list[Any]]:
        """What it is made of."""
        return [["plant", said_of(self.plant)], ["regulator", said_of(self.regulator)], ["h [s]", self.h]]

    def frequency_curve(self, w: np.ndarray | None = None) -> Curve:
        """Gain and phase of the loop transfer at w [rad/s], with its margins: what a diagram draws."""
        return of_circle(self.on_circle, self.h, w, self.is_stable)

    def default_horizon(self) -> float:
        """As long as the slowest pole rings [s], at least sixty samples."""
        slowest = float(abs(self.poles).max(initial=0.0))
        if not slowest < 1:
            raise LoopError("the loop is unstable: its steps have no end; give a horizon")
        return self.h * max(12 / max(-np.log(max(slowest, 1e-9)), 1e-9), 60.0)

    def reference_and_load(self, horizon: float) -> tuple[tuple[np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]:
        """((t, y), (t, u)), held between samples, after unit steps of the reference at 0 and of the load half-way."""
        steps = int(np.ceil(horizon / self.h))
        at_once = np.ones(steps + 1)
        later = (np.arange(steps + 1) >= steps // 2).astype(float)
        t = self.h * np.arange(steps + 1)
        y, u = (
            self.closed("reference", output).response(at_once) + self.closed("load", output).response(later)
            for output in ("y", "u")
        )
        return stairs(t, y), stairs(t, u)

    def margins(self) -> Margins:
        """All margins, each with its frequency [rad/s]; Ms and Mt over the whole circle, certified.

        delay [s]: the least one with which exp(-jw delay) takes the loop transfer to -1; the plant itself, known at the
        samples only, tells of whole samples. Raises LoopError for an unstable loop.
        """
        if not self.is_stable:
            raise LoopError(f"the loop is unstable (a pole at |z| = {abs(self.poles).max():.6g}) and has no margins")
        return circle_margins(self.on_circle, self.h)


def circle_of_sampled(plant: SampledProcess, regulator: Rst) -> CircleTransfer:
    """The same of a sampled process under a regulator, its poles and zeros as it knows them, to all digits."""
    B, A = plant.polynomials
    zeros = np.concatenate([zeros_of(regulator.S), zeros_near_one(plant)])
    poles = np.concatenate([zeros_of(regulator.R), np.exp(plant.process.poles * plant.h)])
    return CircleTransfer(np.convolve(regulator.S, B), np.convolve(regulator.R, A), zeros, poles)


def circle_of(system: DiscreteProcess) -> CircleTransfer:
    """A transfer function in z on the unit circle."""
    zeros, poles = (np.roots(row).astype(complex) for row in (np.trim_zeros(system.num, "f"), system.den))
    return CircleTransfer(np.asarray(system.num), np.asarray(system.den), zeros, poles)
