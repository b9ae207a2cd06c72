"""Every tuning rule of the project on one model: settings where a rule applies, its reason where it does not."""

import math
from collections.abc import Callable
from dataclasses import dataclass

from loopbook.controllers.pid_forms import PidStandard
from loopbook.design.model import Model
from loopbook.tuning.rule import RuleDoesNotApply, Tuning

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


def rules(model: Model) -> dict[str, Callable[[], Tuning]]:
    """The rules by name, each a function that tunes for the upright model or raises RuleDoesNotApply."""
    from loopbook.tuning import amigo, chien_hrones_reswick, lambda_tuning, migo, simc, ziegler_nichols

    up, data = model.upright, model.step_data
    frequency = lambda: up.frequency_data  # noqa: E731 (a model that never lags by 180 degrees raises here)
    common = {
        "Ziegler-Nichols ultimate, PI": lambda: _ultimate(ziegler_nichols, frequency(), "pi"),
        "Ziegler-Nichols ultimate, PID": lambda: _ultimate(ziegler_nichols, frequency(), "pid"),
        "MIGO, PI": lambda: migo.pi(up.process),
        "MIGO, PID": lambda: migo.pid(up.process),
    }
    lags = (math.inf,) * model.integrating + up.lags
    by_half_rule = {
        "SIMC, PI": lambda: simc.reduced(up.gain, lags, up.delay),
        "SIMC, PID": lambda: simc.reduced(up.gain, lags, up.delay, order=2),
    }
    if model.integrating:
        pulse = lambda: _pulse(up)  # noqa: E731
        return {
            **by_half_rule,
            "AMIGO step, PI": lambda: amigo.pi_step_integrating(data),
            "AMIGO step, PID": lambda: amigo.pid_step_integrating(data),
            "AMIGO step and frequency, PID": lambda: amigo.pid_combined_integrating(pulse()),
            **common,
        }
    k, T, L = data.Kp, data.T, data.L
    closed = max(T, L)
    return {
        "Ziegler-Nichols step, PI": lambda: ziegler_nichols.step_method(k, T, L, "pi"),
        "Ziegler-Nichols step, PID": lambda: ziegler_nichols.step_method(k, T, L, "pid"),
        **{
            f"Chien-Hrones-Reswick {overshoot} %, {type.upper()}": (
                lambda type=type, overshoot=overshoot: chien_hrones_reswick.settings(k, T, L, type, overshoot)
            )
            for overshoot in (0, 20)
            for type in ("pi", "pid")
        },
        "lambda, PI": lambda: lambda_tuning.settings(k, T, L, closed, "pi"),
        "lambda, PID": lambda: lambda_tuning.settings(k, T, L, closed, "pid"),
        **by_half_rule,
        "AMIGO step, PI": lambda: amigo.pi_step(data),
        "AMIGO step, PID": lambda: amigo.pid_step(data),
        "AMIGO frequency, PI": lambda: amigo.pi_frequency(frequency(), k),
        "AMIGO frequency, PID": lambda: amigo.pid_frequency(frequency(), k),
        "AMIGO step and frequency, PID": lambda: amigo.pid_combined(up.two_lag_data, data.tau),
        **common,
    }


def _ultimate(module, found, variant: str) -> Tuning:
    return module.ultimate_method(found.Ku, found.T180, variant)


def _pulse(model: Model):
    from loopbook.experiments.data import IntegratingPulseData

    return IntegratingPulseData(model.gain, sum(model.lags), model.delay)


def candidates(model: Model) -> tuple[list[Candidate], list[Refused]]:
    """Settings of every rule for one model, in the order of `rules`, and the rules that refused it."""
    from loopbook.experiments.data import DataError
    from loopbook.process.frequency_response import NoSuchFrequency

    accepted, refused = [], []
    for name, tune in rules(model).items():
        try:
            tuning = tune()
        except (RuleDoesNotApply, NoSuchFrequency, DataError) as error:
            refused.append(Refused(name, error.reason))
            continue
        pid = tuning.pid
        ready = PidStandard(model.sign * pid.K, pid.Ti, pid.Td, b=pid.b, c=0.0, N=FILTER if pid.Td else None)
        accepted.append(Candidate(name, ready, tuning))
    return accepted, refused
