"""Numbers of every type people have: each works as the float or fraction it is, or is refused in one sentence."""

import math
import warnings
from dataclasses import fields
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest
import sympy

from loopbook.controllers import Pid, PidSettings, SettingError
from loopbook.controllers.pid import BadMeasurementWarning
from loopbook.controllers.pid_forms import FormError, PidParallel, PidSeries, PidStandard
from loopbook.controllers.regulator import Regulator
from loopbook.controllers.rst import PlacementError, Rst
from loopbook.experiments.data import DataError, FrequencyData, StepData
from loopbook.loop.continuous import Loop
from loopbook.pole_placement.numeric import place_numerically
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process, ProcessError
from loopbook.response.simulation import simulate
from loopbook.tuning.by_name import tune
from loopbook.tuning.half_rule import half_rule
from loopbook.tuning.result import RuleDoesNotApply

KINDS = [
    int,
    float,
    np.int64,
    np.int32,
    np.uint8,
    np.float64,
    np.float32,
    np.float16,
    Fraction,
    Decimal,
    sympy.Integer,
    sympy.Float,
    np.array,
    lambda n: np.longdouble(n),
]


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_number_does_what_the_float_does(kind):
    two, three, five = kind(2), kind(3), kind(5)
    process = Process([two], [five, three, kind(1)], two)
    assert process == Process([2.0], [5.0, 3.0, 1.0], 2.0)
    assert Process.fopdt(two, five, three) == Process.fopdt(2, 5, 3)
    assert process * two == process * 2.0 and process.delayed(three).delay == 5.0
    for form, plain in (
        (PidStandard(two, five, three, N=five), PidStandard(2, 5, 3, N=5)),
        (PidParallel(two, three, kind(1), five), PidParallel(2, 3, 1, 5)),
        (PidSeries(two, five, kind(1)), PidSeries(2, 5, 1)),
    ):
        for row in "TSR":
            assert getattr(form.regulator(), row) == pytest.approx(getattr(plain.regulator(), row), rel=1e-15)
        assert all(getattr(form, f.name) == pytest.approx(getattr(plain, f.name)) for f in fields(form))
        assert all(type(c) is float for row in (form.regulator().T, form.regulator().R) for c in row)
    assert Regulator.of(two) == Regulator.of(2.0)
    loop = Loop(Process([1], [five, 1], two), PidStandard(kind(1), five))
    assert loop.margins() == Loop(Process([1], [5, 1], 2), PidStandard(1, 5)).margins()
    assert loop.step(horizon=five).y.end >= 5 and loop.with_gain(two).process.num == (2.0,)
    assert (sample(process, two).polynomials[0] == sample(process, 2.0).polynomials[0]).all()
    assert Rst((kind(1), two), (three,), (three,), two) == Rst((1, 2), (3,), (3,), 2)
    assert place_numerically([0, kind(1)], [kind(1), two], [kind(1)], h=two).regulator.h == 2.0
    assert FrequencyData.from_ultimate(two, five) == FrequencyData(0.5, 5)
    assert tune(StepData(2, 5, 3), "lambda-pi", closed=two) == tune(StepData(2, 5, 3), "lambda-pi", closed=2)
    assert half_rule([five, two], kind(1)) == ((6.0,), 2.0)
    assert tune(StepData(two, five, three), "amigo-step-pid") == tune(StepData(2, 5, 3), "amigo-step-pid")
    settings = PidSettings(K=two, Ti=five, Td=kind(1), Tf=kind(1), h=kind(1), u_low=kind(0), u_high=five, Tt=two)
    assert settings == PidSettings(K=2, Ti=5, Td=1, Tf=1, h=1, u_low=0, u_high=5, Tt=2)
    assert Pid(settings).step(kind(1), two) == Pid(settings).step(1.0, 2.0)


def test_single_precision_does_not_spread():
    third = np.float32(1 / 3)
    assert PidStandard(third, third * 2).parallel().I == 0.5
    assert type(PidStandard(third).K) is float
    assert Process([third], [1, 1]).num == (float(third),)


def test_exact_numbers_stay_exact_where_the_program_is():
    pid = Pid(PidSettings(K=Decimal("0.1"), Ti=Fraction(3), h=np.int64(1), Tt=Fraction(2)))
    assert pid.step(Decimal("0.2"), 1) == Fraction(1, 10) * Fraction(4, 5)
    assert isinstance(pid.I, Fraction)


BAD = ["1", None, 1j, True, math.nan, math.inf, [1], object(), sympy.Symbol("x"), Decimal("NaN")]


@pytest.mark.parametrize("bad", BAD, ids=lambda bad: type(bad).__name__)
def test_what_is_no_number_is_refused_in_one_sentence(bad):
    doors = [
        (ProcessError, lambda: Process([bad], [1, 1])),
        (ProcessError, lambda: Process([1], [1, 1], bad)),
        (ProcessError, lambda: sample(Process([1], [1, 1]), bad)),
        (PlacementError, lambda: Rst((1,), (1,), (1,), bad)),
        (PlacementError, lambda: Rst((1, bad), (1,), (1,), 1)),
        (PlacementError, lambda: place_numerically([0, 1], [1, -0.5], [1], h=bad)),
        (FormError, lambda: PidParallel(bad)),
        (SettingError, lambda: PidSettings(K=bad, h=1)),
        (DataError, lambda: FrequencyData.from_ultimate(bad, 1)),
        (DataError, lambda: FrequencyData.from_ultimate(1, bad)),
        (RuleDoesNotApply, lambda: tune(StepData(1, 1, 1), "lambda-pi", closed=-1 if bad is None else bad)),
        (DataError, lambda: StepData(1, bad, 1)),
        (DataError, lambda: FrequencyData(bad, 1)),
    ]
    for error, door in doors:
        with pytest.raises(error) as caught:
            door()
        assert "\n" not in str(caught.value) and len(str(caught.value)) < 260


@pytest.mark.parametrize("h", [0, -1, -1e-9, math.nan, math.inf])
def test_a_sampling_interval_is_positive(h):
    with pytest.raises(PlacementError, match="h = "):
        place_numerically([0, 0.5], [1, -0.8], [1, -0.3], h=h)
    with pytest.raises(PlacementError, match="h = "):
        Rst((1, -1), (1,), (1,), h)
    with pytest.raises(PlacementError, match="integrators = -1"):
        place_numerically([0, 0.5], [1, -0.8], [1, -0.3], h=1, integrators=-1)


@pytest.mark.parametrize("I, held", [(0, 0.0), (2.5, 2.5), (99.0, 10.0), (-3, 0.0)])
def test_a_bad_first_measurement_holds_the_start_value_within_the_limits(I, held):
    pid = Pid(PidSettings(K=2.0, Ti=4.0, h=1.0, u_low=0.0, u_high=10.0), I=I, on_bad="hold")
    with pytest.warns(BadMeasurementWarning, match="y = nan"):
        assert pid.step(math.nan, 1.0) == held
    with pytest.warns(BadMeasurementWarning):
        u = Pid(pid.settings, I=I, on_bad="hold").run(np.array([math.nan, math.nan, 0.5, 0.5]), 1.0)
    assert u.dtype == float and np.isfinite(u).all() and (u[:2] == held).all()
    assert u[2:].tolist() == Pid(pid.settings, I=I).run(np.array([0.5, 0.5]), 1.0).tolist()


@pytest.mark.parametrize(
    "y", [np.array([0.0, 2.0, 9.0]), np.array([0, 2, 9]), np.array([0, 2, 9], dtype=np.float32)], ids=str
)
@pytest.mark.parametrize("exact", [True, False])
def test_an_array_gives_an_array(y, exact):
    """Also where some outputs are ints, the limits, and some floats."""
    number = Fraction if exact else float
    settings = PidSettings(K=number(2), Ti=number(4), h=number(1), u_low=0, u_high=1)
    found = Pid(settings).run(y, 1)
    assert isinstance(found, np.ndarray) and found.shape == y.shape
    single = Pid(settings)
    assert found.tolist() == [single.step(float(v), 1) for v in y]
    assert isinstance(Pid(settings).run(y.tolist(), np.array(1.0)), list | np.ndarray)


def test_ints_beside_fractions_stay_exact():
    found = Pid(PidSettings(K=Fraction(1, 3), h=1, u_high=1)).run([0, 1, 2], 1)
    assert found == [Fraction(1, 3), 0, Fraction(-1, 3)] and all(isinstance(u, Fraction) for u in found)


def test_a_number_too_long_for_a_sentence_is_cut():
    with pytest.raises(ProcessError) as caught:
        Process([1], [1, 1], 10**400)
    assert len(str(caught.value)) < 200


def test_no_integral_action_is_none_or_infinite():
    for endless in (math.inf, np.float32(np.inf), Decimal("Infinity"), sympy.oo):
        assert PidSettings(K=2.0, Ti=endless, h=1.0) == PidSettings(K=2.0, h=1.0)
    assert Pid(PidSettings(K=2.0, Ti=math.inf, h=1.0)).step(0.5, 1.0) == 1.0
    with pytest.raises(SettingError, match="Ti"):
        PidSettings(K=2.0, Ti=-math.inf, h=1.0)


def test_rules_that_do_not_divide_by_the_dead_time_take_none():
    """lambda PI cancels the lag: the loop is 1/(closed s + 1)."""
    for name, closed in (("lambda-pi", 0.5), ("simc-pi", 0.9)):
        tuning = tune(Process([2], [3, 1]), name, closed=closed)
        assert tuning.K == pytest.approx(3 / (2 * closed)) and tuning.Ti == 3.0
        assert tune(StepData(2, 3, 0), name, closed=closed).K == tuning.K
    assert tune(Process([2], [3, 1]), "simc-pi", closed=0.5).Ti == 2.0
    pid = tune(StepData(2, 3, 0), "lambda-pid", closed=0.5).pid
    assert (pid.K, pid.Ti, pid.Td) == (3.0, 3.0, 0.0)
    assert tune(Process([0.5], [1, 0]), "simc-pi-integrating", closed=2).Ti == 8.0
    assert tune(Process([0.5], [3, 1, 0]), "simc-pid-integrating", closed=2).Td == pytest.approx(3 * 8 / 11)
    for name, process in (("simc-pi", Process([1], [10, 1])), ("simc-pi-integrating", Process([1], [1, 0]))):
        with pytest.raises(RuleDoesNotApply, match="give closed"):
            tune(process, name)
        with pytest.raises(RuleDoesNotApply, match="closed = 0 must be a positive number"):
            tune(process, name, closed=0)
    with pytest.raises(RuleDoesNotApply, match="its gain is infinite"):
        tune(StepData(1, 2, 0), "chr-pi-0")


def test_the_half_rule_without_lags():
    for lags, order in (([], 1), ([], 2), ([3.0], 2)):
        with pytest.raises(RuleDoesNotApply, match=rf"half rule: {len(lags)} lags cannot be reduced to {order}"):
            half_rule(lags, 1, order=order)
    for bad in (-2, math.nan):
        with pytest.raises(RuleDoesNotApply, match="is no time"):
            half_rule([1, bad], 1)


@pytest.mark.parametrize("n", [3, 10, 20, 30])
@pytest.mark.parametrize("delay", [0.0, 0.5, 20.0])
def test_nothing_leaks_from_many_lags_with_dead_time(n, delay):
    """No warning of NumPy's, and Ms and margins of a loop of n lags as on a dense grid."""
    loop = Loop(Process([1], np.poly([-1.0] * n), delay), PidStandard(0.3, n / 2 + delay))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = loop.margins()
        loop.step().metrics()
        simulate(loop.process, _Gain(), 0.5, 20, reference=1.0)
    w = np.geomspace(1e-3, 10, 400_001)
    G = 0.3 * (1 + 1 / (1j * w * (n / 2 + delay))) / (1 + 1j * w) ** n * np.exp(-delay * 1j * w)
    assert found.Ms.value == pytest.approx((1 / abs(1 + G)).max(), rel=1e-5)
    turned = np.unwrap(np.angle(G))
    first = int(np.flatnonzero(turned < -np.pi)[0])
    assert found.gain == pytest.approx(1 / abs(G[first]), rel=1e-3)


class _Gain:
    def step(self, y, reference):
        return 0.5 * (reference - y)


def test_a_closed_loop_as_fast_as_its_dead_time_allows():
    """K = T/(Kp (closed + T0)): nothing divides by closed = 0 where there is dead time."""
    for name in ("simc-pi", "lambda-pi"):
        found = tune(StepData(2, 10, 3), name, closed=0)
        assert found.K == pytest.approx(10 / 6) and found.notes
    for bad in (-1, math.inf):
        with pytest.raises(RuleDoesNotApply, match="closed = "):
            tune(StepData(2, 10, 3), "simc-pi", closed=bad)


def test_dead_time_alone_is_left_to_integral_action():
    for known in (StepData(2, 0, 3), Process([2], [1], 3)):
        with pytest.raises(RuleDoesNotApply, match=r"dead time alone.*PidParallel"):
            tune(known, "simc-pi")


@pytest.mark.parametrize("times", [["1", "2"], [1j], [None], [0.0, math.nan]], ids=str)
def test_times_and_inputs_are_real_numbers(times):
    process = Process([2], [3, 1], 1)
    for door in (process.step, process.impulse, process.ramp, sample(process, 1.0).response):
        with pytest.raises(ProcessError) as caught:
            door(times)
        assert "\n" not in str(caught.value) and len(str(caught.value)) < 200
    plain = process.step([0.0, 2.0, 4.0])
    for row in ([0, 2, 4], [Fraction(0), Decimal(2), sympy.Integer(4)], np.array([0, 2, 4], dtype=np.uint8)):
        assert process.step(row).tolist() == plain.tolist()
