"""What a design starts from: a process model, its uncertainty, and what an experiment at the ultimate point found."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.experiments import step
from loopbook.experiments.data import FrequencyData, IntegratingStepData, StepData
from loopbook.identification.models import INVERSE, RINGS
from loopbook.process.transfer_function import Process
from notebook_reports.display import number

if TYPE_CHECKING:
    from loopbook.experiments.data import FrequencyData, IntegratingStepData, StepData
    from loopbook.identification.choice import Identified
    from loopbook.identification.fit import Fit
    from loopbook.process.transfer_function import Process


MOST_FACTORS = 5  # different time constants in one formula; more are written as a product


class ModelError(LoopbookError):
    """The description of a process cannot be used; the message says which entry and how to mend it."""


@dataclass(frozen=True)
class Model:
    """gain e^(-delay s) / ((1 + T1 s)(1 + T2 s)...), times 1/s for an integrating process.

    With damping zeta < 1 the two lags (T, T) are a pair that rings, 1 + 2 zeta T s + T^2 s^2; zero Tz > 0 [s] puts
    1 - Tz s in front: the output starts the wrong way.

    gain: Kp [y/u] or, integrating, Kv [y/(u s)]; its sign is free. lags: time constants [s], longest first.
    delay: L [s]. frequency: K180 and T180 where they were measured; otherwise they follow from the model.
    covariance: of (gain, lags..., delay), None where the model is taken as exact. source: where it comes from.
    """

    gain: float
    lags: tuple[float, ...]
    delay: float
    integrating: bool = False
    frequency: "FrequencyData | None" = None
    covariance: Any = None
    source: str = ""
    damping: float | None = None
    zero: float = 0.0

    def __post_init__(self) -> None:
        lags = tuple(sorted((float(T) for T in self.lags), reverse=True))
        object.__setattr__(self, "lags", lags)
        if not np.isfinite([self.gain, self.delay, *lags]).all() or self.gain == 0:
            raise ModelError(f"gain = {self.gain!r}: a finite number other than zero is expected, and finite times")
        if any(T <= 0 for T in lags):
            raise ModelError(f"time constants = {list(lags)}: each must be positive, in seconds")
        if self.damping is not None and not (0 < self.damping < 1 and len(lags) == 2 and lags[0] == lags[1]):
            raise ModelError(f"damping = {self.damping}: between 0 and 1, with the time constant twice")
        if not 0 <= self.zero < float("inf"):
            raise ModelError(f"zero = {self.zero} s: a time, zero or longer, is expected")
        if self.delay < 0:
            raise ModelError(f"delay = {self.delay} s is negative")
        if not lags and not self.integrating:
            raise ModelError("a process without time constants follows its input at once; give time_constants")

    @property
    def rises(self) -> bool:
        """Does y rise with u?"""
        return self.gain > 0

    @property
    def sign(self) -> float:
        """1 where y rises with u, -1 where it falls."""
        return 1.0 if self.gain > 0 else -1.0

    @cached_property
    def process(self) -> "Process":
        """The model as a Process."""
        den = np.array([1.0, 0.0]) if self.integrating else np.array([1.0])
        for T in self.lags:
            den = np.polymul(den, [T, 1.0])
        if self.damping is not None:
            den = np.array([self.lags[0] ** 2, 2 * self.damping * self.lags[0], 1.0])
        num = (-self.gain * self.zero, self.gain) if self.zero else (self.gain,)
        return Process(num, tuple(den), self.delay)

    @property
    def of_lags(self) -> bool:
        """Is it lags and a dead time, as the rules are written for?"""
        return self.damping is None and not self.zero

    def latex(self) -> str:
        """The transfer function as LaTeX, four digits."""

        def text(value: float) -> str:
            digits, e, power = number(value, 4).replace("−", "-").partition("e")
            return rf"{digits} \cdot 10^{{{power}}}" if e else digits

        alike = [(T, self.lags.count(T)) for T in dict.fromkeys(self.lags)]
        if len(alike) > MOST_FACTORS:
            lags = [rf"\prod_{{i=1}}^{{{len(self.lags)}}} (1 + T_i s)"]
        else:
            lags = [f"(1 + {text(T)} s)" + (f"^{{{n}}}" if n > 1 else "") for T, n in alike]
        if self.damping is not None:
            T = self.lags[0]
            lags = [f"(1 + {text(2 * self.damping * T)} s + {text(T**2)} s^2)"]
        factors = ["s"] * self.integrating + lags
        alone = len(factors) == 1 and factors[0].startswith("(") and factors[0].endswith(")")
        below = factors[0][1:-1] if alone else " ".join(factors)
        above = f"{text(self.gain)} (1 - {text(self.zero)} s)" if self.zero else text(self.gain)
        fraction = rf"\frac{{{above}}}{{{below}}}"
        return rf"G(s) = {fraction}" + (rf" e^{{-{text(self.delay)} s}}" if self.delay else "")

    @cached_property
    def upright(self) -> "Model":
        """The same model with a positive gain, for which the rules are written."""
        return self if self.gain > 0 else replace(self, gain=-self.gain)

    @cached_property
    def step_data(self) -> "StepData | IntegratingStepData":
        """What a step experiment on the upright model tells (tangent and 63 %, or final slope and its intercept)."""
        model = self.upright
        if model.integrating:
            return IntegratingStepData(model.gain, model.delay + sum(model.lags))
        if len(model.lags) == 1 and model.of_lags:
            return StepData(model.gain, model.lags[0], model.delay)
        return step.step_data(model.process)

    def variations(self, number: int, seed: int = 0) -> list["Model"]:
        """Models drawn from the confidence region, normal around this one; none where it is taken as exact.

        Draws with a time that is not positive (a dead time below zero is set to zero) or a gain of the other sign
        are drawn again.
        """
        if self.covariance is None:
            return []
        shape = self._shape
        centre = np.array([self.gain, *shape, self.delay])
        random = np.random.default_rng(seed)
        drawn: list[Model] = []
        for _ in range(50 * number):
            if len(drawn) == number:
                break
            values = random.multivariate_normal(centre, self.covariance, method="eigh")
            gain, lags, delay = values[0], values[1:-1], max(values[-1], 0.0)
            if gain * self.gain > 0 and (lags > 0).all() and (self.damping is None or lags[1] < 1):
                drawn.append(self._like(gain, lags.tolist(), delay))
        return drawn

    @property
    def _shape(self) -> tuple[float, ...]:
        """The numbers that the covariance is of, between gain and dead time."""
        if self.damping is not None:
            return self.lags[0], self.damping
        return (*self.lags, self.zero) if self.zero else self.lags

    def _like(self, gain: float, shape: list[float], delay: float) -> "Model":
        """A model of the same structure."""
        if self.damping is not None:
            return Model(gain, (shape[0], shape[0]), delay, damping=shape[1])
        if self.zero:
            return Model(gain, tuple(shape[:-1]), delay, zero=shape[-1])
        return Model(gain, tuple(shape), delay, self.integrating)


def from_identified(found: "Identified", frequency: "FrequencyData | None" = None) -> Model:
    """The chosen model of an identification, with its covariance."""
    return from_fit(found.chosen, found.record.source or "the record", frequency)


def from_fit(fit: "Fit", source: str, frequency: "FrequencyData | None" = None) -> Model:
    """A fitted model, with its covariance."""
    described = f"{fit.structure.name}, fitted to {source}"
    if fit.structure.parts == RINGS:
        T, zeta = fit.lags
        return Model(fit.gain, (T, T), fit.delay, False, frequency, fit.covariance, described, damping=zeta)
    if fit.structure.parts == INVERSE:
        T1, T2, Tz = fit.lags
        return Model(fit.gain, (T1, T2), fit.delay, False, frequency, fit.covariance, described, zero=Tz)
    order = [0, *(1 + np.argsort(fit.lags)[::-1]), len(fit.lags) + 1]
    covariance = fit.covariance[np.ix_(order, order)]
    return Model(fit.gain, fit.lags, fit.delay, fit.structure.integrating, frequency, covariance, described)
