"""Zero-order-hold sampling against SciPy, against simulation of the integral, and in its limits."""

from fractions import Fraction

import numpy as np
import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import cont2discrete

from derivations.algebra.delay_polynomials import Z, coefficients
from derivations.sampling.zero_order_hold import (
    S,
    SamplingError,
    dead_time_in_samples,
    impulse_response,
    two_lags,
    zero_order_hold,
)

pytestmark = pytest.mark.long

T1, T2, h, part = sp.symbols("T_1 T_2 h lambda", positive=True)
R = sp.Rational
times = st.fractions(min_value=Fraction(1, 5), max_value=8, max_denominator=7)


LAGS = zero_order_hold(two_lags(T1, T2), h)


def numbers(model, **values):
    subs = {sp.Symbol(k, positive=True): v for k, v in values.items()}
    return [[float(c.subs(subs)) for c in coefficients(p)] for p in (model.A, model.B)]


@settings(deadline=None, max_examples=15)
@given(t1=times, t2=times, step=times)
def test_symbolic_two_lags_against_scipy(t1, t2, step):
    if t1 == t2:
        t2 += 1
    a, b = numbers(LAGS, T_1=R(t1), T_2=R(t2), h=R(step))
    num, den, _ = cont2discrete(([1.0], np.polymul([float(t1), 1], [float(t2), 1])), float(step), method="zoh")
    assert a == pytest.approx(den, rel=1e-9)
    assert b == pytest.approx(num[0], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    "G",
    [
        1 / (S + 2) ** 3,
        (1 - S) / ((S + 1) * (S + 3)),
        1 / (S * (S + 1)),
        1 / S**2,
        2 / (S**2 + 2 * S + 5),
        (S + 4) / ((S + 1) ** 2 * (S + 2)),
    ],
    ids=str,
)
def test_other_rational_processes_against_scipy(G):
    a, b = numbers(zero_order_hold(G, R(3, 10)))
    num, den = (np.array(sp.Poly(p, S).all_coeffs(), dtype=float) for p in sp.fraction(sp.together(G)))
    other, other_den, _ = cont2discrete((num, den), 0.3, method="zoh")
    assert a == pytest.approx(other_den, rel=1e-9)
    assert b == pytest.approx(other[0], rel=1e-7, abs=1e-10)


@pytest.mark.parametrize("share", [R(1, 4), R(1, 2), R(99, 100)])
def test_fraction_of_a_sample_of_dead_time_is_the_shifted_step_response(share):
    model = zero_order_hold(two_lags(5, 7), 1, 2, share)
    a, b = numbers(model)
    y = np.zeros(40)
    for k in range(40):  # unit step at k = 0
        y[k] = sum(b[i] for i in range(min(k, len(b) - 1) + 1)) - sum(a[i] * y[k - i] for i in range(1, min(k, 2) + 1))
    t = np.maximum(np.arange(40) - 2 - float(share), 0)
    assert y == pytest.approx(1 - (5 * np.exp(-t / 5) - 7 * np.exp(-t / 7)) / (5 - 7), abs=1e-13)


def test_the_numerator_is_finite_its_next_coefficient_vanishes():
    longer = zero_order_hold(two_lags(T1, T2), h, 0, R(1, 2))
    whole = zero_order_hold(two_lags(T1, T2), h, 1)
    assert len(coefficients(longer.B)) == 4 and len(coefficients(whole.B)) == 4
    g = impulse_response(two_lags(T1, T2))
    t = next(s for s in g.free_symbols if s.name == "t")
    pulse = [sp.integrate(sp.expand(g).subs({T1: 2, T2: 3}), (t, i, i + 1)) for i in range(4)]
    a = [c.subs({T1: 2, T2: 3, h: 1}) for c in coefficients(whole.A)]
    assert abs(sp.N(sum(a[j] * pulse[3 - j] for j in range(3)))) < 1e-14


def test_equal_lags_are_the_limit_of_different_ones():
    equal, different = zero_order_hold(two_lags(T1, T1), h), zero_order_hold(two_lags(T1, T2), h)
    for name, value in equal.coefficients.items():
        assert sp.simplify(sp.limit(different.coefficients[name], T2, T1) - value) == 0


def test_the_part_goes_over_into_whole_samples():
    model = zero_order_hold(two_lags(T1, T2), h, 1, part)
    none, full = zero_order_hold(two_lags(T1, T2), h, 1), zero_order_hold(two_lags(T1, T2), h, 2)
    for limit, other in ((0, none), (1, full)):
        difference = sp.expand(model.B.subs(part, limit) - other.B)
        assert sp.simplify(difference) == 0


def test_static_gain_is_kept():
    V1, V2, Q, Ku = sp.symbols("V_1 V_2 Q K_u", positive=True)
    model = zero_order_hold(two_lags(V1 / Q, V2 / Q, Ku), h, 2)
    assert sp.simplify(model.B.subs(Z, 1) / model.A.subs(Z, 1) - Ku) == 0
    assert list(model.coefficients) == ["a_1", "a_2", "b_3", "b_4"]


def test_the_transfer_function_in_z():
    model = zero_order_hold(two_lags(5, 7), 1, 2)
    num, den = sp.fraction(model.transfer)
    assert sp.degree(num, Z) == 1 and sp.degree(den, Z) == 4
    assert sp.expand(num * Z**-4 - model.B) == 0


@pytest.mark.parametrize(
    "call, text",
    [
        (lambda: zero_order_hold(1 / (S + 1), 0), "h = 0: the sampling interval"),
        (lambda: zero_order_hold(1 / (S + 1), -1), "> 0 s"),
        (lambda: zero_order_hold(1 / (S + 1), 0.1), "must be an exact number"),
        (lambda: zero_order_hold(1 / (S + 1), 1, -1), "whole = -1"),
        (lambda: zero_order_hold(1 / (S + 1), 1, 0, 1), r"must lie in \[0, 1\)"),
        (lambda: zero_order_hold(S / (S + 1), 1), "strictly proper"),
        (lambda: zero_order_hold(sp.exp(-S) / (S + 1), 1), "give the dead time as whole and part"),
        (lambda: zero_order_hold(1 / (S**5 + S + 1), 1), "factors of degree 1 and 2"),
        (lambda: zero_order_hold(1 / (S**3 + sp.Symbol("x") * S + 1), 1), r"G = 1/\(x\*s \+ s\*\*3 \+ 1\)"),
        (lambda: dead_time_in_samples(sp.Symbol("L"), 1), "must be an exact number"),
        (lambda: dead_time_in_samples(-1, 1), "cannot be negative"),
    ],
)
def test_errors(call, text):
    with pytest.raises(SamplingError, match=text):
        call()


@pytest.mark.parametrize(
    "G, step, share",
    [
        (10 / (S**2 + 3 * S + 10), R(1, 10), R(1, 2)),
        ((S + 4) / (S**2 + S + 1), R(2, 5), R(3, 10)),
        (1 / (S * (S**2 + S + 1)), R(1, 2), 0),
        (1 / (S**2 + 1) ** 2, R(1, 3), R(1, 4)),
        ((S + 1) / ((S**2 + 2 * S + 5) * (S + 3)), R(1, 5), R(9, 10)),
        (3 / ((S**2 + S + 2) * (S**2 + 4)), R(1, 4), 0),
    ],
    ids=str,
)
def test_complex_poles_with_any_dead_time(G, step, share):
    """Real expressions in cosines and sines, with the numbers of the numeric route."""
    from loopbook.process.sampled import sample
    from loopbook.process.transfer_function import Process

    model = zero_order_hold(G, step, 2, share)
    assert not (model.A.has(sp.I) or model.B.has(sp.I))
    a, b = numbers(model)
    num, den = ([float(c) for c in sp.Poly(p, S).all_coeffs()] for p in sp.fraction(sp.together(G)))
    B, A = sample(Process(num, den, float((2 + share) * step)), float(step)).polynomials
    assert a == pytest.approx(A, abs=1e-13)
    assert b == pytest.approx(B, abs=1e-13)


def test_the_published_fractional_delay_in_symbols():
    """10 exp(-0.25 s)/(s^2 + 3 s + 10), sampled every 0.1 s, as MATLAB's page on c2d prints it."""
    a, b = numbers(zero_order_hold(10 / (S**2 + 3 * S + 10), R(1, 10), 2, R(1, 2)))
    assert [float(f"{c:.4g}") for c in (*a, *b[3:])] == [1, -1.655, 0.7408, 0.01187, 0.06408, 0.009721]


def test_symbols_without_assumptions_are_real_numbers():
    T, step, share, w, a, b = sp.symbols("T h lambda w a b")
    known = {x: sp.Symbol(x.name, positive=True) for x in (T, step, share)}
    plain, positive = (
        zero_order_hold(1 / (1 + S * T), step, 1, share),
        zero_order_hold(1 / (1 + S * known[T]), known[step], 1, known[share]),
    )
    assert plain.B.subs(known) == positive.B and plain.A.subs(known) == positive.A
    oscillator = zero_order_hold(w**2 / (S**2 + w**2), step)
    assert sp.simplify(oscillator.coefficients["b_1"] - (1 - sp.cos(step * w))) == 0
    second = zero_order_hold(b / (S**2 + a * S + b), step)
    at = {a: 3, b: 10, step: R(1, 10)}
    exact = zero_order_hold(10 / (S**2 + 3 * S + 10), R(1, 10))
    for name, value in second.coefficients.items():
        assert abs(sp.N(value.subs(at) - exact.coefficients[name])) < 1e-14


def test_a_fractional_delay_of_complex_poles_as_matlab_prints_it():
    """MATLAB, c2d: 10 e^(-0.25 s)/(s^2 + 3 s + 10), Ts = 0.1: z^-3 (.01187 z^2 + .06408 z + .009721)/(...)."""
    found = zero_order_hold(10 / (S**2 + 3 * S + 10), sp.Rational(1, 10), 2, sp.Rational(1, 2))
    values = {name: float(f"{float(value):.4g}") for name, value in found.coefficients.items()}
    assert values == {"a_1": -1.655, "a_2": 0.7408, "b_3": 0.01187, "b_4": 0.06408, "b_5": 0.009721}
