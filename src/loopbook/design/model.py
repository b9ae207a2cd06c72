"""What a design starts from: a process model, its uncertainty, and what an experiment at the ultimate point found."""

import tomllib
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from loopbook.experiments.data import FrequencyData, IntegratingStepData, StepData
    from loopbook.identification.choice import Identified
    from loopbook.process.transfer_function import Process


class ModelError(ValueError):
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

    def __post_init__(self):
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
    def sign(self) -> float:
        """1 where y rises with u, -1 where it falls."""
        return 1.0 if self.gain > 0 else -1.0

    @cached_property
    def process(self) -> "Process":
        """The model as a Process."""
        from loopbook.process.transfer_function import Process

        den = np.array([1.0, 0.0]) if self.integrating else np.array([1.0])
        for T in self.lags:
            den = np.polymul(den, [T, 1.0])
        return Process((self.gain,), tuple(den), self.delay)

    def latex(self) -> str:
        """The transfer function as LaTeX, four digits."""
        from notebook_reports.display import number

        def text(value: float) -> str:
            digits, e, power = number(value, 4).replace("−", "-").partition("e")
            return rf"{digits} \cdot 10^{{{power}}}" if e else digits

        factors = ["s"] * self.integrating + [f"(1 + {text(T)} s)" for T in self.lags]
        below = factors[0].strip("()") if len(factors) == 1 else " ".join(factors)
        fraction = rf"\frac{{{text(self.gain)}}}{{{below}}}"
        return rf"G(s) = {fraction}" + (rf" e^{{-{text(self.delay)} s}}" if self.delay else "")

    @cached_property
    def upright(self) -> "Model":
        """The same model with a positive gain, for which the rules are written."""
        return self if self.gain > 0 else replace(self, gain=-self.gain)

    @cached_property
    def step_data(self) -> "StepData | IntegratingStepData":
        """What a step experiment on the upright model tells (tangent and 63 %, or final slope and its intercept)."""
        from loopbook.experiments import step
        from loopbook.experiments.data import IntegratingStepData, StepData

        model = self.upright
        if model.integrating:
            return IntegratingStepData(model.gain, model.delay + sum(model.lags))
        if len(model.lags) == 1:
            return StepData(model.gain, model.lags[0], model.delay)
        return step.exact(model.process)

    @cached_property
    def frequency_data(self) -> "FrequencyData":
        """K180 and T180: measured, or of the model. Raises NoSuchFrequency where the model never lags so far."""
        from loopbook.experiments.data import FrequencyData
        from loopbook.process.frequency_response import ultimate

        if self.frequency is not None:
            return self.frequency
        point = ultimate(self.upright.process)
        return FrequencyData(point.K180, point.T180)

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
    fit = found.chosen
    order = [0, *(1 + np.argsort(fit.lags)[::-1]), len(fit.lags) + 1]
    covariance = fit.covariance[np.ix_(order, order)]
    source = f"{fit.structure.name}, fitted to {found.record.source or 'the record'}"
    return Model(fit.gain, fit.lags, fit.delay, fit.structure.integrating, frequency, covariance, source)


def read_toml(path: str | Path) -> Model:
    """Read a process from a TOML file.

        [process]
        gain = 2.0                    # y/u, for an integrating process y/(u s)
        time_constants = [10.0, 4.0]  # s
        delay = 3.0                   # s
        integrating = false           # optional
        [experiment]                  # optional: a relay or oscillation experiment
        K180 = 0.21                   # y/u
        T180 = 22.0                   # s

    Raises ModelError with the entry that is missing, unknown or of the wrong kind.
    """
    from loopbook.experiments.data import DataError, FrequencyData

    path = Path(path)
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ModelError(f"there is no file {path}") from None
    except tomllib.TOMLDecodeError as error:
        raise ModelError(f"{path.name}: {error}") from None
    entries = dict(content.get("process", {}))
    if not entries:
        raise ModelError(f"{path.name} has no [process] with gain, time_constants and delay")
    known = {"gain", "time_constants", "delay", "integrating"}
    _only(path, "process", entries, known)
    missing = {"gain", "delay"} - set(entries)
    if missing:
        raise ModelError(f"{path.name}: [process] lacks {', '.join(sorted(missing))}")
    for name in ("gain", "delay"):
        _number(path, name, entries[name])
    lags = entries.get("time_constants", [])
    for T in lags if isinstance(lags, list) else [None]:
        _number(path, "time_constants", T)
    measured = content.get("experiment")
    frequency = None
    if measured is not None:
        _only(path, "experiment", measured, {"K180", "T180"})
        try:
            frequency = FrequencyData(float(measured["K180"]), float(measured["T180"]))
        except (KeyError, TypeError, ValueError, DataError) as error:
            raise ModelError(f"{path.name}: [experiment] needs K180 and T180, positive numbers ({error})") from None
    integrating = bool(entries.get("integrating", False))
    try:
        return Model(
            float(entries["gain"]), tuple(lags), float(entries["delay"]), integrating, frequency, None, path.name
        )
    except ModelError as error:
        raise ModelError(f"{path.name}: {error}") from None


def _only(path: Path, table: str, entries: dict, known: set[str]) -> None:
    import difflib

    for name in sorted(set(entries) - known):
        near = difflib.get_close_matches(name, known, n=1)
        hint = f"; did you mean {near[0]}?" if near else f"; known: {', '.join(sorted(known))}"
        raise ModelError(f"{path.name}: [{table}] has no entry {name!r}{hint}")


def _number(path: Path, name: str, value: Any) -> None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise ModelError(f"{path.name}: {name} = {value!r}: a number is expected")
