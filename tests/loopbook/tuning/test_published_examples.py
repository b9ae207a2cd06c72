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


@pytest.mark.parametrize(
    ("rule", "options", "printed"),
    [  # a public comparison of rules on 1.5 e^(-15 s)/(60 s + 1): K, Ti, Ms, gain margin, phase margin
        ("tyreus-luyben-pi", {}, (1.4447, 120.865, 1.5789, 3.065, 74.04)),
        ("imc-pi", {"closed": 22.5}, (2.0, 67.5, 2.0883, 2.1226, 49.44)),
        ("cohen-coon-pi", {}, (2.4556, 32.946, 3.6623, 1.5091, 23.07)),
    ],
)
def test_three_rules_on_one_process(rule, options, printed):
    process = Process.fopdt(1.5, 60, 15)
    tuning = tune(process, rule, **options)
    m = Loop(process, tuning).margins()
    units = (1e-4, 1e-3, 1e-4, 1e-3, 1e-2)
    for found, value, unit in zip((tuning.K, tuning.Ti, m.Ms.value, m.gain, m.phase), printed, units, strict=True):
        assert found == pytest.approx(value, abs=unit), rule


FORMULAS = {
    # K k T0/T (or K/Ku), Ti/T0 (Ti/T, Ti/Tu), Td/T0 (Td/Tu) as the tables print them, at T = 4 T0
    "zn-step-pi-3.33": (0.9, 3.33, 0),
    "zn-step-pi-3.3": (0.9, 3.3, 0),
    "chr-pid-20-1.36": (0.95, 1.36 * 4, 0.47),
    "cohen-coon-p": (1 + 1 / 12, math.inf, 0),
    "cohen-coon-pid": (4 / 3 + 1 / 16, (32 + 6 / 4) / (13 + 2), 4 / (11 + 0.5)),
}


@pytest.mark.parametrize("name", FORMULAS)
def test_variants_by_their_tables(name):
    tuning = tune(StepData(2.0, 20.0, 5.0), name)
    found = (tuning.K * 2.0 * 5 / 20, tuning.Ti / 5, tuning.Td / 5)
    assert found == pytest.approx(FORMULAS[name], rel=1e-12)


def test_rules_of_the_ultimate_point_by_their_tables():
    data = FrequencyData(0.25, 20.0)  # Ku = 4, Tu = 20 s
    assert (tune(data, "zn-ultimate-pi-0.4").K, tune(data, "zn-ultimate-pi-0.4").Ti) == pytest.approx((1.6, 16))
    pid = tune(data, "tyreus-luyben", "PID")  # Ku/2.2, 2.2 Tu, Tu/6.3
    assert (pid.K, pid.Ti, pid.Td) == pytest.approx((4 / 2.2, 44, 20 / 6.3))


def test_imc_of_rivera_morari_and_skogestad():
    """Table II: (2 tau + theta)/(k (2 epsilon + theta)), tau + theta/2, tau theta/(2 tau + theta); tau/(k epsilon)."""
    data = StepData(2.0, 10.0, 4.0)
    pid, lag = tune(data, "imc-pid", closed=6.0), tune(data, "imc-pi-lag", closed=8.0)
    assert (pid.K, pid.Ti, pid.Td) == pytest.approx((24 / (2 * 16), 12, 40 / 24))
    assert (lag.K, lag.Ti) == pytest.approx((10 / 16, 10))
    assert tune(data, "imc", "PI").values["closed"] == pytest.approx(6.8) and not tune(data, "imc", "PI").notes
    assert not lag.notes
    assert "shorter than 1.7 T0" in tune(data, "imc-pi", closed=5.0).notes[0]


def test_poles_by_frequency_and_damping():
    """1/(s + 1), w0 = 2, zeta = 0.7: Kp = 9/5, Ti = 9/20."""
    tuning = tune(Process([1], [1, 1]), "damping-pi", w0=2, zeta=0.7)
    assert (tuning.K, tuning.Ti) == pytest.approx((9 / 5, 9 / 20), rel=1e-13)
    for process, options in (
        (Process([3], [2, -1]), {"w0": 4, "zeta": 0.5}),
        (Process([3], [2, 0]), {"w0": 4, "zeta": 1.2}),
    ):
        pi = tune(process, "damping", "PI", **options)
        closed = np.polyadd(np.polymul([1, 0], process.den), np.polymul(process.num, [pi.K, pi.ki]))
        w0, zeta = options["w0"], options["zeta"]
        assert np.allclose(closed / closed[0], [1, 2 * zeta * w0, w0**2], rtol=1e-12)
    oscillator = Process([3], [2, 0.3, 5])
    pid = tune(oscillator, "damping", "PID", w0=4, zeta=0.5, alpha=2)
    closed = np.polyadd(np.polymul([1, 0], oscillator.den), np.polymul(oscillator.num, [pid.kd, pid.K, pid.ki]))
    assert np.allclose(closed / closed[0], np.polymul([1, 8], [1, 4, 16]), rtol=1e-12)


def test_a_phase_margin_by_pi():
    process = Process([2], [40, 14, 1], 3)
    m = Loop(process, tune(process, "phase-margin-pi", w=0.08, phase_margin=60)).margins()
    assert (m.phase, m.gain_crossovers[0].w) == pytest.approx((60, 0.08), rel=1e-9)


@pytest.mark.parametrize(
    ("process", "rule", "options", "says"),
    [
        (FOURTH, "phase-margin-pi", {"w": 0.8, "phase_margin": 60}, r"P = 2\.2129, I = -1\.223"),
        (Process([1], [1, 1]), "damping-pi", {"w0": 0.2, "zeta": 0.7}, "not all of one sign"),
        (Process([1], [1, 1], 2), "damping-pi", {"w0": 2, "zeta": 0.7}, "dead time"),
        (Process([1], [1, 2, 1]), "damping-pi", {"w0": 2, "zeta": 0.7}, "use damping-pid"),
        (Process([1], [1, 1]), "damping-pid", {"w0": 2, "zeta": 0.7}, "use damping-pi"),
        (Process([1, 1], [1, 2, 1]), "damping-pid", {"w0": 2, "zeta": 0.7}, "without zeros"),
        (Process([1], [1, 1]), "damping-pi", {"w0": 0, "zeta": 0.7}, "w0 = 0 must be positive"),
        (Process([1], [1, 1]), "damping-pi", {"w0": 1}, "needs zeta"),
    ],
)
def test_negative_gains_are_refused(process, rule, options, says):
    from loopbook.tuning import RuleDoesNotApply

    with pytest.raises(RuleDoesNotApply, match=says):
        tune(process, rule, **options)


def test_gains_of_either_sign_can_be_seen():
    """The published P and I of 1/(s + 1)^4 at 0.8 rad/s with 60 degrees, and of 1/(s + 1) with w0 = 0.2."""
    from loopbook.tuning import by_damping, by_margin

    assert by_margin.gains(FOURTH, 0.8, 60) == pytest.approx((2.2128613, -1.2230305), abs=5e-8)
    assert by_damping.gains(Process([1], [1, 1]), 0.2, 0.7) == pytest.approx((-0.72, 0.04, 0))
