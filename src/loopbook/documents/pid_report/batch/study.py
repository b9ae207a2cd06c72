"""Experiments, AMIGO and MIGO on every process of the batch: the numbers behind the statements of section 5.3.

`study` does the work for one process, `run` for all with a progress bar, `ratios` brings one rule's settings over the
optimum's into arrays against the relative dead time.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

import numpy as np

from loopbook.documents.pid_report.batch.processes import Member, batch
from loopbook.experiments import combination, integrating_step, short_pulse, step
from loopbook.experiments.data import FrequencyData, IntegratingStepData, StepData
from loopbook.experiments.plant import ExperimentError
from loopbook.loop.ultimate_point import ultimate
from loopbook.tuning import migo
from loopbook.tuning.registry import RULES as rules
from loopbook.tuning.result import RuleDoesNotApply, Tuning

OPTIMUM = {"PI": "PI MIGO", "PID": "PID MIGO"}
RULES = ("PI step", "PID step", "PI frequency", "PID frequency", "PID combined")


@dataclass(frozen=True)
class MemberStudy:
    """One process: data of exact experiments, and settings by rule name.

    settings holds "PI MIGO", "PID MIGO" and those of `RULES` that exist for the process; missing says why one does not.
    missed: how far the two-lag model's step response is from 63 % at T63, 0 where the process has that form.
    """

    member: Member
    step: StepData | IntegratingStepData
    frequency: FrequencyData
    settings: dict[str, Tuning]
    missing: dict[str, str]
    missed: float = 0.0

    @property
    def tau(self) -> float:
        """Relative dead time, 0 for an integrating process."""
        return self.step.tau if isinstance(self.step, StepData) else 0.0

    @property
    def kappa(self) -> float:
        """Gain ratio K180/Kp, 0 for an integrating process."""
        return self.frequency.K180 / self.member.process.static_gain


@cache
def study_process(member: Member, optimum: bool = True) -> MemberStudy:
    """Exact experiments on one process, all AMIGO rules that apply, and both optima (optimum=False leaves them out)."""
    process = member.process
    point = ultimate(process)
    frequency = FrequencyData(point.K180, point.T180)
    settings: dict[str, Tuning] = {"PI MIGO": migo.pi(process), "PID MIGO": migo.pid(process)} if optimum else {}
    missing: dict[str, str] = {}
    missed = 0.0
    if member.integrates:
        data: StepData | IntegratingStepData = integrating_step.slope_data(process)
        for action in ("PI", "PID"):
            settings[f"{action} step"] = rules[f"amigo-step-{action.lower()}-integrating"](data)
        settings["PID combined"] = rules["amigo-combined-pid-integrating"](short_pulse.pulse_data(process))
    else:
        data = found = step.step_data(process)
        settings["PI step"], settings["PID step"] = rules["amigo-step-pi"](found), rules["amigo-step-pid"](found)
        try:
            lags, missed = combination.nearest(found, frequency)
            settings["PID combined"] = rules["amigo-combined-pid"](lags, tau=found.tau)
        except (ExperimentError, RuleDoesNotApply) as error:
            missing["PID combined"] = str(error)
    for action in ("PI", "PID"):
        rule = rules[f"amigo-frequency-{action.lower()}"]
        settings[f"{action} frequency"] = rule(frequency, Kp=process.static_gain, extrapolate=True)
    return MemberStudy(member, data, frequency, settings, missing, missed)


def study_batch(members: Sequence[Member] | None = None, progress: bool = True) -> tuple[MemberStudy, ...]:
    """`study` for the whole batch (or some members), in order, with a progress bar on a terminal."""
    from tqdm import tqdm

    members = batch() if members is None else members
    shown = tqdm(members, desc="batch", unit="process", leave=False, disable=None if progress else True)
    return tuple(study_process(member) for member in shown)


@dataclass(frozen=True)
class Ratios:
    """One rule over the optimum, arrays over the processes that have both; Td of a PI rule is NaN."""

    rule: str
    members: tuple[Member, ...]
    tau: np.ndarray
    kappa: np.ndarray
    K: np.ndarray
    Ti: np.ndarray
    Td: np.ndarray
    ki: np.ndarray

    def where(self, keep: np.ndarray) -> "Ratios":
        """The processes for which keep is true."""
        members = tuple(m for m, yes in zip(self.members, keep, strict=True) if yes)
        return Ratios(self.rule, members, *(getattr(self, n)[keep] for n in ("tau", "kappa", "K", "Ti", "Td", "ki")))


def ratios(studies: Sequence[MemberStudy], rule: str) -> Ratios:
    """The settings of one of `RULES` over the optimum of the same kind of regulator."""
    best = OPTIMUM[rule.split()[0]]
    kept = [s for s in studies if rule in s.settings]
    pairs = [(s.settings[rule], s.settings[best]) for s in kept]

    def column(name: str) -> np.ndarray:
        return np.array([_over(getattr(a, name), getattr(b, name)) for a, b in pairs])

    tau, kappa = np.array([s.tau for s in kept]), np.array([s.kappa for s in kept])
    ki = np.array([_over(a.K / a.Ti, b.K / b.Ti) for a, b in pairs])
    return Ratios(rule, tuple(s.member for s in kept), tau, kappa, column("K"), column("Ti"), column("Td"), ki)


def share_within(values: np.ndarray, width: float) -> float:
    """The part of the values within a factor 1 +- width.

    >>> share_within(np.array([0.9, 1.0, 1.3]), 0.15).__round__(3)
    0.667
    """
    return float(np.mean(abs(values - 1) <= width)) if len(values) else math.nan


def _over(a: float, b: float) -> float:
    return a / b if b else math.nan
