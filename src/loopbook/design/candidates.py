"""Every tuning rule of the project on one model: settings where a rule applies, its reason where it does not."""

import math
from dataclasses import dataclass

from loopbook.controllers.pid_forms import PidStandard
from loopbook.design.model import Model
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.registry import RULES
from loopbook.tuning.result import RuleDoesNotApply, Tuning

FILTER = 10.0  # N: the derivative's filter is Td/10


@dataclass(frozen=True)
class Candidate:
    """One rule's regulator, ready to be judged.

    pid: standard form, derivative on the measurement (c = 0) behind a filter Td/N, b as the rule gives it (1 where it
    gives none); the sign of K is that of the process. tuning: the rule as published, for the upright process.
    """

    name: str
    pid: PidStandard
    tuning: Tuning

    @property
    def notes(self) -> tuple[str, ...]:
        return self.tuning.notes


@dataclass(frozen=True)
class Refused:
    """A rule that does not apply to this model, with its reason."""

    name: str
    reason: str


def known(model: Model) -> ProcessData:
    """What the rules are told of a model: itself, and the ultimate point where that was measured."""
    lags = (math.inf,) * model.integrating + model.lags
    return ProcessData(model.upright.process, step=model.step_data, frequency=model.frequency, lags=lags)


def candidates(model: Model) -> tuple[list[Candidate], list[Refused]]:
    """Settings of every rule with integral action for one model, in the order of `RULES`, and the rules that refuse."""
    data, accepted, refused = known(model), [], []
    for rule in RULES.values():
        if not rule.fits(model.integrating) or rule.action == "P":
            continue
        try:
            tuning = rule(data)
        except RuleDoesNotApply as error:
            refused.append(Refused(rule.title, error.reason.removeprefix(f"{rule.name}: ")))
            continue
        pid = tuning.pid
        ready = PidStandard(model.sign * pid.K, pid.Ti, pid.Td, b=pid.b, c=0.0, N=FILTER if pid.Td else None)
        accepted.append(Candidate(rule.title, ready, tuning))
    return accepted, refused
