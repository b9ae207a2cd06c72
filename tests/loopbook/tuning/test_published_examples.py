"""The design side against worked examples of the literature: the digits as printed there, each with its source."""

import math

import numpy as np
import pytest

from loopbook.experiments.data import FrequencyData, StepData
from loopbook.loop.continuous import Loop
from loopbook.loop.ultimate_point import ultimate
from loopbook.process.transfer_function import Process
from loopbook.tuning import migo, tune
from loopbook.tuning.half_rule import half_rule
from notebook_reports.ledger.verdicts import rounds_to

FOURTH = Process((1.0,), (1.0, 4.0, 6.0, 4.0, 1.0))
DELAYED = Process((1.0,), (0.0025, 0.1, 1.0), 1.0)


def digits(settings, *printed: str) -> None:
    """Do K, Ti (and Td) round to what is printed?"""
    found = (settings.K, settings.Ti, settings.Td)
    assert all(rounds_to(v, p) for v, p in zip(found, printed, strict=False)), (found, printed)


HALF_RULE = {
    # S. Skogestad, Simple analytic rules for model reduction and PID controller tuning, J. Process Control 13 (2003)
    # 291-309, the table of examples E1 to E15 with tau_c = theta: lags, dead time, zeros of inverse response; then
    # theta and tau_1 for PI; then theta, tau_1 and tau_2 for PID. E2 with (0.08 s + 1)/(0.2 s + 1) as 1/(0.12 s + 1).
    "E2": ([2, 1, 0.4, 0.12, 0.05, 0.05, 0.05], 0, [0.3], ("1.47", "2.5"), ("0.77", "2", "1.2")),
    "E4": ([1, 1, 1, 1], 0, [], ("2.5", "1.5"), ("1.5", "1", "1.5")),
    "E5": ([1, 0.2, 0.04, 0.008], 0, [], ("0.148", "1.1"), ("0.028", "1", "0.22")),
    "E7": ([1, 1, 1], 0, [2], ("3.5", "1.5"), ("2.5", "1", "1.5")),
    "E9": ([1, 1], 1, [], ("1.5", "1.5"), ("1", "1", "1")),
    "E10": ([20, 2], 1, [], ("2", "21"), ("1", "20", "2")),
    "E11": ([6, 2, 2], 1, [1], ("5", "7"), ("3", "6", "3")),
    # D. E. Seborg, T. F. Edgar, D. A. Mellichamp, Process Dynamics and Control, the two worked examples of the half
    # rule; the same digits in the tests of github.com/alchemyst/Dynamics-and-Control
    "Seborg, three lags": ([5, 3, 0.5], 0, [0.1], ("2.1", "6.5"), None),
    "Seborg, four lags": ([12, 3, 0.2, 0.05], 1, [1], ("3.75", "13.5"), ("2.15", "12", "3.1")),
}


@pytest.mark.parametrize("name", HALF_RULE)
def test_half_rule(name):
    lags, delay, inverse, one, two = HALF_RULE[name]
    for order, printed in ((1, one), (2, two)):
        if printed is not None:
            kept, effective = half_rule(lags, delay, inverse, order)
            assert all(rounds_to(v, p) for v, p in zip((effective, *kept), printed, strict=True)), (effective, kept)


SIMC = {
    # the same table: k or k', theta, tau_1 (inf: integrating), tau_2 -> Kc, tau_I, tau_D of the series form
    "E1, PI": ((1, 0.1, 1.1, 0), ("5.5", "0.8")),
    "E2, PI": ((1, 1.47, 2.5, 0), ("0.85", "2.5")),
    "E2, PID": ((1, 0.77, 2, 1.2), ("1.30", "2", "1.2")),
    "E3, PI": ((1.5, 0.15, 1.05, 0), ("2.33", "1.05")),
    "E3, PID": ((1.5, 0.05, 1, 0.15), ("6.67", "0.4", "0.15")),
    "E4, PI": ((1, 2.5, 1.5, 0), ("0.3", "1.5")),
    "E4, PID": ((1, 1.5, 1.5, 1), ("0.5", "1.5", "1")),
    "E5, PI": ((1, 0.148, 1.1, 0), ("3.72", "1.1")),
    "E5, PID": ((1, 0.028, 1, 0.22), ("17.9", "0.224", "0.22")),
    "E6, PI": ((1, 1.69, math.inf, 0), ("0.296", "13.5")),
    "E6, PID": ((1, 0.358, math.inf, 1.33), ("1.40", "2.86", "1.33")),
    "E7, PI": ((1, 3.5, 1.5, 0), ("0.214", "1.5")),
    "E8, PI": ((1, 1.5, math.inf, 0), ("0.33", "12")),
    "E8, PID": ((1, 0.5, math.inf, 1.5), ("1", "4", "1.5")),
    "E9, PI": ((1, 1.5, 1.5, 0), ("0.5", "1.5")),
    "E9, PID": ((1, 1, 1, 1), ("0.5", "1", "1")),
    "E10, PI": ((1, 2, 21, 0), ("5.25", "16")),
    "E10, PID": ((1, 1, 20, 2), ("10", "8", "2")),
    "E11, PI": ((1, 5, 7, 0), ("0.7", "7")),
    "E11, PID": ((1, 3, 6, 3), ("1", "6", "3")),
    "E12, PI": ((0.225, 0.3, 1, 0), ("7.41", "1")),
    "E15, PI": ((1, 1, 1, 0), ("0.5", "1")),
}


@pytest.mark.parametrize("name", SIMC)
def test_simc_settings(name):
    (k, theta, first, second), printed = SIMC[name]
    slow = (1.0, 0.0) if math.isinf(first) else (first, 1.0)
    tuning = tune(Process((k,), tuple(np.polymul(slow, (second, 1.0))), theta), "simc", "PID" if second else "PI")
    digits(tuning.pid.series() if second else tuning, *printed)


def test_simc_from_the_full_process():
    """E4, E8 and E10 of the same table, from all their lags."""
    integrating = Process((1.0,), (1.0, 2.0, 1.0, 0.0))
    digits(tune(FOURTH, "simc", "PI"), "0.3", "1.5")
    digits(tune(integrating, "simc", "PI"), "0.33", "12")
    digits(tune(integrating, "simc", "PID").pid.series(), "1", "4", "1.5")
    digits(tune(Process((1.0,), (40.0, 22.0, 1.0), 1.0), "simc", "PID").pid.series(), "10", "8", "2")


@pytest.mark.parametrize(
    ("process", "rule", "printed"),
    [
        (Process((1.0,), (5.0, 1.0), 1.0), "simc-pi", ("3.14", "61.4", "1.59", "1.00", "2.14")),
        (Process((1.0,), (1.0, 0.0), 1.0), "simc-pi-integrating", ("2.96", "46.9", "1.70", "1.30", "1.59")),
    ],
    ids=["lag, tau_1 <= 8 theta", "integrating"],
)
def test_simc_robustness(process, rule, printed):
    """The paper's table 1 for tau_c = theta: gain margin, phase margin, Ms, Mt, allowed delay error over theta."""
    m = Loop(process, tune(process, rule)).margins()
    assert all(
        rounds_to(v, p) for v, p in zip((m.gain, m.phase, m.Ms.value, m.Mt.value, m.delay), printed, strict=True)
    )


@pytest.mark.parametrize(("closed", "gain"), [(3.0, "1.88"), (10.0, "0.682")])
def test_direct_synthesis(closed, gain):
    """Seborg, Edgar, Mellichamp (2004), example 12.1: 2 e^-s/((10 s + 1)(5 s + 1)); tau_I = 15, tau_D = 3.33.

    SIMC is this method with the integral time bounded; for these two speeds the bound does not bind.
    """
    digits(tune(Process((2.0,), (50.0, 15.0, 1.0), 1.0), "simc-pid", closed=closed), gain, "15", "3.33")


AMIGO = {
    # K. J. Åström, T. Hägglund, Revisiting the Ziegler-Nichols step response method for PID control, J. Process
    # Control 14 (2004) 635-650, the examples 1/(s + 1)^4 and e^-s/(0.05 s + 1)^2, from the printed T and L
    "balanced, PI": ("amigo-step-pi", (2.9, 1.42), ("0.414", "2.66")),
    "balanced, PID": ("amigo-step-pid", (2.9, 1.42), ("1.12", "2.40", "0.619")),
    "delay dominated, PID": ("amigo-step-pid", (0.0932, 1.01), ("0.242", "0.474", "0.119")),
}


@pytest.mark.parametrize("name", AMIGO)
def test_amigo_settings(name):
    rule, (T, L), printed = AMIGO[name]
    digits(tune(StepData(1.0, T, L), rule), *printed)


def test_what_amigo_starts_from():
    from loopbook.experiments import step

    for process, T, L in ((FOURTH, 2.9, 1.42), (DELAYED, 0.0932, 1.01)):
        found = step.step_data(process)
        assert (found.T, found.L) == pytest.approx((T, L), rel=0.01)


@pytest.mark.parametrize(
    ("design", "process", "printed"),
    [
        (migo.pi, FOURTH, ("0.432", "2.43")),
        (migo.pid, FOURTH, ("1.19", "2.22")),
        (migo.pi, DELAYED, ("0.170", "0.404")),
        (migo.pid, DELAYED, ("0.216", "0.444", "0.129")),
    ],
    ids=["balanced, PI", "balanced, PID", "delay dominated, PI", "delay dominated, PID"],
)
def test_migo_optima(design, process, printed):
    """The optima of the same examples with M = 1.4."""
    digits(design(process), *printed)


def test_ziegler_nichols():
    """K. J. Åström, T. Hägglund, PID Controllers, 2nd ed. (1995), examples 4.1 and 4.2: 1/(s + 1)^3."""
    third = Process((1.0,), (1.0, 3.0, 3.0, 1.0))
    a, L = 0.218, 0.806
    steepest = 2 * math.exp(-2)  # of the step response, at t = 2 s
    assert rounds_to(steepest * L, "0.218")
    digits(tune(StepData(1, L / a, L), "zn-step-pid"), "5.50", "1.61", "0.403")
    point = ultimate(third)
    assert rounds_to(point.K180, "0.125") and rounds_to(point.T180, "3.63")
    digits(tune(FrequencyData(point.K180, point.T180), "zn-ultimate-pid"), "4.8", "1.81")
