"""What a tuning rule is told of a process: data of experiments, or a model from which they follow by a stated method.

    asked for                  given a model, it follows by
    step data                  the tangent and 63 % of the exact step response; a lag with dead time gives its own
    integrating step data      the final tangent of the exact step response
    one lag, two lags          the half rule
    frequency data             the exact point at -180 degrees
    two lags                   the model's own where it has two, else step and frequency data together
    pulse data                 the step response without the integrator

Data without a model stand for one: step data for a lag with dead time, pulse data for an integrator with lag and dead
time. Data given themselves are always taken as they are.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from derivations.tuning.takes import Takes
from loopbook.experiments import combination, integrating_step, short_pulse, step
from loopbook.experiments.data import (
    DataError,
    FrequencyData,
    IntegratingPulseData,
    IntegratingStepData,
    StepData,
    TwoLagData,
)
from loopbook.experiments.plant import ExperimentError
from loopbook.loop.ultimate_point import NoSuchFrequency, ultimate
from loopbook.process.transfer_function import Process
from loopbook.tuning.half_rule import half_rule, lags_of
from loopbook.tuning.result import RuleDoesNotApply

FIELDS = {
    StepData: "step",
    IntegratingStepData: "step",
    FrequencyData: "frequency",
    TwoLagData: "two_lags",
    IntegratingPulseData: "pulse",
    Process: "process",
}
GIVEN = ""


@dataclass(frozen=True)
class ProcessData:
    """Make it with `ProcessData.of`. process: with a positive gain; sign: -1 where the one that was given has not.
    The data as measured, None where they were not. lags [s]: of the half rule, math.inf for an integrator.
    """

    process: Process | None = None
    step: StepData | IntegratingStepData | None = None
    frequency: FrequencyData | None = None
    two_lags: TwoLagData | None = None
    pulse: IntegratingPulseData | None = None
    lags: tuple[float, ...] | None = None
    sign: float = 1.0

    @classmethod
    def of(cls, *known: Any) -> "ProcessData":
        """From a `Process`, data of experiments, what an experiment or an identification found, or several of these.

        Raises TypeError for anything else.

        >>> ProcessData.of(StepData(2, 10, 3)).numbers(Takes.STEP)[0]["tau"].__round__(4)
        0.2308
        """
        found: dict[str, Any] = {}
        for item in (part for thing in known for part in (thing if isinstance(thing, tuple | list) else (thing,))):
            if isinstance(item, cls):
                return item
            item = _data_of(item)
            if type(item) not in FIELDS:
                raise TypeError(
                    f"{type(item).__name__} says nothing of a process: give a Process, data of an experiment "
                    f"({', '.join(kind.__name__ for kind in FIELDS if kind is not Process)}), or what an experiment or "
                    "an identification found"
                )
            found[FIELDS[type(item)]] = item
        process, sign = found.get("process"), 1.0
        if process is not None and _gain(process) < 0:
            found["process"], sign = process * -1.0, -1.0
        return cls(**found, sign=sign)

    @cached_property
    def model(self) -> Process | None:
        """The process, or the one that the data stand for; None where frequency data alone are known."""
        if self.process is not None:
            return self.process
        if self.two_lags is not None:
            Kp, T1, T2, L1 = (getattr(self.two_lags, n) for n in ("Kp", "T1", "T2", "L1"))
            return Process((Kp,), tuple(np.polymul([T1, 1.0], [T2, 1.0])), L1)
        if self.pulse is not None:
            return Process.integrating(self.pulse.Kv, self.pulse.L1, self.pulse.T2)
        if isinstance(self.step, IntegratingStepData):
            return Process.integrating(self.step.Kv, self.step.L)
        return Process((self.step.Kp,), (self.step.T, 1.0), self.step.L) if self.step is not None else None

    @property
    def integrates(self) -> bool | None:
        """Does the process integrate? None where nothing tells."""
        return None if self.model is None else math.isinf(self.model.static_gain)

    def numbers(self, takes: Takes, Kp: float | None = None, tau: float | None = None) -> tuple[dict[str, float], str]:
        """The quantities that a rule of this kind takes, by name, and how they became known ("" as given).

        Kp [y/u], tau: the static gain beside frequency data, the relative dead time beside two lags, where they are
        known otherwise; Kp = math.inf for an integrating process.
        Raises RuleDoesNotApply where the quantities do not follow from what is known.
        """
        try:
            if takes is Takes.FREQUENCY_AND_GAIN:
                return self._frequency_and_gain(Kp)
            return self._two_lags(tau) if takes is Takes.TWO_LAGS else _MEANS[takes](self)
        except (ExperimentError, NoSuchFrequency, DataError) as error:
            raise RuleDoesNotApply(error.reason) from None

    def _need(self, what: str) -> Process:
        if self.model is None:
            raise RuleDoesNotApply(f"{what} cannot be told from frequency data alone: give step data or a process too")
        return self.model

    def _step(self) -> tuple[dict[str, float], str]:
        data, how = self.step, GIVEN
        if data is None:
            process = self._need("step data")
            if process.order == 1 and len(process.num) == 1 and process.den[-1]:
                T = process.den[0] / process.den[1]
                data, how = StepData(process.static_gain, T, process.delay), "its own gain, lag and dead time"
            else:
                data, how = step.step_data(process), "tangent and 63 % of the exact step response"
        if not isinstance(data, StepData):
            raise RuleDoesNotApply("the process integrates: its step response has no final level")
        return {"Kp": data.Kp, "T": data.T, "L": data.L, "tau": data.tau}, how

    def _integrating_step(self) -> tuple[dict[str, float], str]:
        data, how = self.step, GIVEN
        if data is None:
            data, how = (
                integrating_step.slope_data(self._need("step data")),
                "final tangent of the exact step response",
            )
        if not isinstance(data, IntegratingStepData):
            raise RuleDoesNotApply("the process does not integrate")
        return {"Kv": data.Kv, "L": data.L}, how

    def _half_rule(self, order: int) -> tuple[dict[str, float], str]:
        process = self._need("lags")
        lags, inverse = (self.lags, ()) if self.lags is not None else lags_of(process)
        if not lags:
            raise RuleDoesNotApply(
                "the process is dead time alone: without a lag the rule leaves integral action alone, "
                "I = 1/(Kp (closed + T0))",
                "use PidParallel(0, I)",
            )
        kept, L = half_rule(lags, process.delay, inverse, min(order, len(lags)))
        second = kept[1] if len(kept) > 1 else 0.0
        how = "its own lags and dead time" if len(lags) <= order else f"half rule on {len(lags)} lags"
        if math.isinf(kept[0]):
            return {"Kv": self._integrating_step()[0]["Kv"], "T2": second, "L": L}, how
        return {"Kp": process.static_gain, "T": kept[0], "T2": second, "L": L}, how

    def _frequency(self) -> tuple[dict[str, float], str]:
        data, how = self.frequency, GIVEN
        if data is None:
            point = ultimate(self._need("the point at -180 degrees"))
            data, how = FrequencyData(point.K180, point.T180), "exact point at -180 degrees"
        return {"K180": data.K180, "T180": data.T180, "Ku": data.Ku}, how

    def _frequency_and_gain(self, Kp: float | None) -> tuple[dict[str, float], str]:
        numbers, how = self._frequency()
        gain = self._need("the static gain").static_gain if Kp is None else Kp
        if not gain > 0:
            raise RuleDoesNotApply(f"Kp = {gain!r} must be positive (math.inf for an integrating process)")
        return {**numbers, "kappa": numbers["K180"] / gain}, how

    def _two_lags(self, tau: float | None) -> tuple[dict[str, float], str]:
        data, how = self.two_lags, GIVEN
        if self.integrates:
            raise RuleDoesNotApply("the process integrates: two lags do not describe it")
        stepped = self._step()[0] if data is None or tau is None else {}
        if data is None:
            lags = self._own_lags()
            if lags is not None:
                assert self.model is not None, "own lags are those of a model"
                data, how = TwoLagData(stepped["Kp"], *lags, self.model.delay), "its own lags and dead time"
            else:
                point, step_data = self._frequency()[0], StepData(*(stepped[n] for n in ("Kp", "T", "L")))
                data = combination.solve(step_data, FrequencyData(point["K180"], point["T180"]))
                how = "step response and point at -180 degrees together"
        return {
            "Kp": data.Kp,
            "T1": data.T1,
            "T2": data.T2,
            "L1": data.L1,
            "tau": stepped["tau"] if tau is None else tau,
        }, how

    def _own_lags(self) -> tuple[float, float] | None:
        """Both lags of a model that has no more, one of them 0 where it has one; None where measured data decide."""
        measured = self.process is None and self.step is not None and self.frequency is not None
        if measured or self.model is None or len(self.model.num) > 1 or self.model.order > 2:
            return None
        try:
            lags = self.lags if self.lags is not None else lags_of(self.model)[0]
        except RuleDoesNotApply:
            return None
        return (*lags, 0.0)[0], (*lags, 0.0)[1]

    def _pulse(self) -> tuple[dict[str, float], str]:
        data, how = self.pulse, GIVEN
        if data is None:
            process = self._need("pulse data")
            if not math.isinf(process.static_gain):
                raise RuleDoesNotApply("the process does not integrate")
            lags = lags_of(process)[0] if self.lags is None else self.lags
            if len(lags) <= 2 and len(process.num) == 1:
                kv = self._integrating_step()[0]["Kv"]
                data, how = IntegratingPulseData(kv, sum(lags[1:]), process.delay), "its own lag and dead time"
            else:
                data, how = short_pulse.pulse_data(process), "step response without the integrator"
        return {"Kv": data.Kv, "T2": data.T2, "L1": data.L1}, how

    def upright(self) -> Process:
        """The model, for rules that take the whole process."""
        return self._need("a process")


_MEANS: dict[Takes, Callable[[ProcessData], tuple[dict[str, float], str]]] = {
    Takes.STEP: ProcessData._step,
    Takes.INTEGRATING_STEP: ProcessData._integrating_step,
    Takes.ONE_LAG: lambda known: known._half_rule(1),
    Takes.TWO_LAGS_OF_MODEL: lambda known: known._half_rule(2),
    Takes.FREQUENCY: ProcessData._frequency,
    Takes.PULSE: ProcessData._pulse,
}


def _data_of(item: Any) -> Any:
    """The data of an `Estimate`, the process of an identified model, anything else as it is."""
    for attribute in ("data", "chosen", "process"):
        inside = getattr(item, attribute, None)
        if type(item) not in FIELDS and inside is not None:
            return _data_of(inside)
    return item


def _gain(process: Process) -> float:
    """The sign of the response to a step in the long run; an unstable pole, which grows the other way, turns it."""
    den = [c for c in process.den if c]
    unstable = int((process.poles.real > 0).sum()) if process.order else 0
    return process.num[-1] / den[-1] * (-1) ** unstable
