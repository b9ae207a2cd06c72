"""What a design starts from: a process model, its uncertainty, and what an experiment at the ultimate point found."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.experiments import step
from loopbook.experiments.data import FrequencyData, IntegratingStepData, StepData
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

    def __post_init__(self) -> None:
        lags = tuple(sorted((float(T) for T in self.lags), reverse=True))
        object.__setattr__(self, "lags", lags)
        if not np.isfinite([self.gain, self.delay, *lags]).all() or self.gain == 0:
            raise ModelError(f"gain = {self.gain!r}: a finite number other than zero is expected, and finite times")
        if any(T <= 0 for T in lags):
            raise ModelError(f"time constants = {list(lags)}: each must be positive, in seconds")
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
        return Process((self.gain,), tuple(den), self.delay)

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
        factors = ["s"] * self.integrating + lags
        alone = len(factors) == 1 and factors[0].startswith("(") and factors[0].endswith(")")
        below = factors[0][1:-1] if alone else " ".join(factors)
        fraction = rf"\frac{{{text(self.gain)}}}{{{below}}}"
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
        if len(model.lags) == 1:
            return StepData(model.gain, model.lags[0], model.delay)
        return step.step_data(model.process)

    def variations(self, number: int, seed: int = 0) -> list["Model"]:
        """Models drawn from the confidence region, normal around this one; none where it is taken as exact.

        Draws with a time that is not positive (a dead time below zero is set to zero) or a gain of the other sign
        are drawn again.
        """
        if self.covariance is None:
            return []
        centre = np.array([self.gain, *self.lags, self.delay])
        random = np.random.default_rng(seed)
        drawn: list[Model] = []
        for _ in range(50 * number):
            if len(drawn) == number:
                break
            values = random.multivariate_normal(centre, self.covariance, method="eigh")
            gain, lags, delay = values[0], values[1:-1], max(values[-1], 0.0)
            if gain * self.gain > 0 and (lags > 0).all():
                drawn.append(Model(gain, tuple(lags), delay, self.integrating))
        return drawn


def from_identified(found: "Identified", frequency: "FrequencyData | None" = None) -> Model:
    """The chosen model of an identification, with its covariance."""
    return from_fit(found.chosen, found.record.source or "the record", frequency)


def from_fit(fit: "Fit", source: str, frequency: "FrequencyData | None" = None) -> Model:
    """A fitted model, with its covariance."""
    order = [0, *(1 + np.argsort(fit.lags)[::-1]), len(fit.lags) + 1]
    covariance = fit.covariance[np.ix_(order, order)]
    source = f"{fit.structure.name}, fitted to {source}"
    return Model(fit.gain, fit.lags, fit.delay, fit.structure.integrating, frequency, covariance, source)
