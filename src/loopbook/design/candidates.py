"""Every tuning rule of the project on one model: settings where a rule applies, its reason where it does not."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

from loopbook.controllers.pid_forms import LEFT_OUT, PidStandard
from loopbook.design.model import Model
from loopbook.loop.transfer import LoopError
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
    lags = (math.inf,) * model.integrating + model.lags if model.of_lags else None
    return ProcessData(model.upright.process, step=model.step_data, frequency=model.frequency, lags=lags)


def candidates(
    model: Model, tunings: Mapping[str, Callable[[ProcessData], Tuning]] | None = None
) -> tuple[list[Candidate], list[Refused]]:
    """Settings of every rule with integral action for one model, in the order of `RULES`, and the rules that refuse.

    tunings: other ways to settings by name, instead of the rules.
    """
    data, accepted, refused = known(model), [], []
    for title, tune in (of_rules(model) if tunings is None else tunings).items():
        try:
            tuning = tune(data)
        except RuleDoesNotApply as error:
            refused.append(Refused(title, error.reason.removeprefix(f"{getattr(tune, 'name', '')}: ")))
            continue
        except LoopError as error:
            refused.append(Refused(title, f"its loop cannot be judged: {error}"))
            continue
        accepted.append(Candidate(title, ready(model, tuning.pid), tuning))
    return accepted, refused


def of_rules(model: Model) -> dict[str, Callable[[ProcessData], Tuning]]:
    """The rules with integral action for such a process, by title."""
    return {r.title: r for r in RULES.values() if r.fits(model.integrating) and r.action != "P"}


def ready(model: Model, pid: PidStandard) -> PidStandard:
    """A rule's settings as they are run: the sign of the process, derivative on the measurement, filter Td/N."""
    return PidStandard(model.sign * pid.K, pid.Ti, pid.Td, b=pid.b, c=0.0, N=FILTER if pid.Td else LEFT_OUT)


def filtered(candidate: Candidate, N: float) -> Candidate:
    """The same settings behind a filter of Td/N."""
    return replace(candidate, pid=replace(candidate.pid, N=N, Tf=LEFT_OUT))
