"""The fit of AMIGO's formulas: optima made with other constants give these back, and those of the rule stay apart."""

from functools import cache
from inspect import signature
from types import SimpleNamespace

import numpy as np
import pytest
import sympy

from derivations.tuning.letters import K_180, T_180, K_p, L, T, kappa
from loopbook.documents.pid_report.batch.nearness import RULES, nearness
from loopbook.experiments.data import FrequencyData, StepData

pytestmark = pytest.mark.long


@cache
def studies(factor):
    """Processes of many lags, whose optima are the rules' formulas with every constant multiplied by a factor."""
    made = []
    for number, tau in enumerate(np.linspace(0.25, 0.95, 24)):
        step, kap = StepData(1.0 + 0.1 * number, float(1 - tau), float(tau)), 0.21 + 0.025 * number
        point = FrequencyData(kap * step.Kp, 1.0 + 0.3 * number)
        data = {K_p: step.Kp, T: step.T, L: step.L, K_180: point.K180, T_180: point.T180, kappa: kap}
        settings = {}
        for name, rule in RULES.items():
            scaled = {n: tuple(factor * c for c in p.default) for n, p in signature(rule).parameters.items()}
            found = {n: float(sympy.sympify(getattr(rule(**scaled), n)).subs(data)) for n in scaled}
            settings[name] = SimpleNamespace(**found)
        made.append(SimpleNamespace(step=step, frequency=point, tau=step.tau, kappa=kap, settings=settings))
    return made


@pytest.mark.parametrize("name", RULES)
def test_constants_come_back(monkeypatch, name):
    optimum = {"PI": "PI step", "PID": "PID step", name.split()[0]: name}
    monkeypatch.setattr("loopbook.documents.pid_report.batch.nearness.OPTIMUM", optimum)
    for found in nearness(studies(0.9)):
        if found.rule == name:
            assert found.fitted == pytest.approx([0.9 * float(c) for c in found.own], rel=2e-3)
            assert found.off_fitted < 1e-4 < 0.02 < found.off and found.processes > 10
