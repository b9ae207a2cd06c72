"""The whole batch: the optimum's robustness on every process, and the statements tested on it."""

import math

import numpy as np
import pytest

from loopbook.controllers.pid_forms import PidStandard
from loopbook.documents.open import printed as load
from loopbook.documents.pid_report.batch import statements as says
from loopbook.documents.pid_report.batch.processes import batch, four_lags
from loopbook.documents.pid_report.batch.robustness import joint
from loopbook.documents.pid_report.batch.study import study_batch, study_process
from loopbook.loop.continuous import Loop
from loopbook.loop.joint_robustness import joint_M
from loopbook.process.transfer_function import Process
from notebook_reports.ledger.verdicts import FAILS, HOLDS, PARTLY, claim_verdict

pytestmark = pytest.mark.long


@pytest.fixture(scope="module")
def whole():
    return says.Batch(study_batch(progress=False), load("pid-report"))


@pytest.fixture(scope="module")
def statements(whole):
    found = {}
    for section in (
        "derivative",
        "derivative_filter",
        "pi_step",
        "pid_step",
        "pid_step_robustness",
        "combined",
        "whole",
    ):
        found |= getattr(says, section)(whole)
    for rule in ("PI frequency", "PID frequency"):
        found |= says.frequency(whole, rule)
    return found


def test_every_optimum_has_the_robustness_asked_for(whole):
    for name in ("PI MIGO", "PID MIGO"):
        assert joint(whole.studies, name) == pytest.approx(1.4, abs=2e-5)


def test_every_statement_is_a_printed_claim_with_evidence(statements):
    assert set(statements) <= set(load("pid-report").claims)
    assert all(evidence.strip() and "nan" not in evidence for _, evidence in statements.values())


VERDICTS = {
    "derivative-helps-lags": PARTLY,  # balanced processes gain up to 2.1 times
    "derivative-raises-gains": HOLDS,
    "pi-step-agrees": PARTLY,  # not for all processes
    "pid-K-low": HOLDS,
    "pid-Td-good": HOLDS,
    "pid-Td-half": HOLDS,
    "pid-Td-either": HOLDS,
    "pid-conservative-below": PARTLY,  # not between 0.3 and 0.5
    "pi-frequency-unfit": HOLDS,
    "pi-frequency-integrating": PARTLY,  # the formulas can be evaluated
    "combined-better": HOLDS,
    "zn-shortcomings": HOLDS,
}


@pytest.mark.parametrize("name", VERDICTS)
def test_verdict(statements, name):
    parts, _ = statements[name]
    assert claim_verdict(parts if isinstance(parts, dict) else {"": parts}) == VERDICTS[name] != FAILS


def test_pid_never_has_less_integral_gain_than_pi(whole):
    assert whole.gain("ki").min() > 1


def test_rule_over_optimum_by_hand():
    """e^-s/(1+s): K = 0.25 by the PI rule (0.15 + 0.35 - 0.25), over an optimum of 0.3738."""
    member = next(m for m in batch() if m.name == "family 1: T = 1")
    found = study_process(member)
    assert pytest.approx(0.25) == found.settings["PI step"].K
    assert pytest.approx(0.669, abs=1e-3) == found.settings["PI step"].K / found.settings["PI MIGO"].K
    assert found.tau == pytest.approx(0.5)


def test_joint_M_bounds_both_sensitivities_and_is_attained():
    process = four_lags(0.3)
    for K, Ti, Td in ((1.0, 1.0, 0.0), (3.0, 0.8, 0.2), (0.5, 5.0, 0.1)):
        pid = PidStandard(K, Ti, Td)
        margins, M = Loop(process, pid).margins(), joint_M(process, pid)
        assert max(margins.Ms.value, margins.Mt.value) - 1e-4 <= M
        curve = Loop(process, pid).transfer(1j * np.geomspace(1e-3, 1e3, 200001))
        C, R = 1 + 1 / (2 * M * (M - 1)), (2 * M - 1) / (2 * M * (M - 1))
        assert abs(abs(curve + C) - R).min() < 1e-4 and (abs(curve + C) - R).min() > -1e-5


def test_joint_M_of_an_unstable_loop_is_infinite():
    assert math.isinf(joint_M(Process((1.0,), (1.0, 3.0, 3.0, 1.0)), PidStandard(K=20.0)))


def test_a_filter_that_is_no_filter_changes_no_loop(whole):
    some = [s for s in whole.studies if not s.member.integrates][::12]
    found = says.Batch(some, load("pid-report"), divisor=1e6).filtered
    assert found["M filter"] == pytest.approx(found["M"], rel=1e-3)
    assert found["ki"] == pytest.approx(np.ones(len(some)), abs=1e-4)
