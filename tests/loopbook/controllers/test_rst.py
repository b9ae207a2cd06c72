"""Pole placement with numbers: the identity, the symbolic route, and what is refused."""

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from loopbook.controllers.rst import Rst, with_zeros, zeros_of
from loopbook.pole_placement.numeric import place_numerically, well_damped
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import simulate

TANK = Process([1 / 8360], [35, 12, 1], 2)
digit = st.integers(-9, 9)


def added(*rows):
    total = np.zeros(max(len(r) for r in rows))
    for r in rows:
        total[: len(r)] += r
    return total


def loop_polynomial(B, A, regulator):
    return added(np.convolve(A, regulator.R), np.convolve(B, regulator.S))


@settings(max_examples=40, deadline=None)
@given(
    st.lists(digit, min_size=1, max_size=3),
    st.lists(digit, min_size=1, max_size=3),
    st.integers(0, 2),
    st.integers(0, 2),
    st.lists(st.integers(-7, 7), min_size=1, max_size=5),
)
@pytest.mark.long
def test_equal_to_the_symbolic_route(a, b, delays, integrators, poles):
    """Random problems with coefficients in tenths, solved exactly by derivations.pole_placement.diophantine."""
    from sympy import Rational

    from derivations.algebra.delay_polynomials import coefficients, polynomial
    from derivations.pole_placement import diophantine as symbolic

    assume(a[-1] and b[-1])
    exact_a = [Fraction(1), *(Fraction(c, 10) for c in a)]
    exact_b = [Fraction(0)] * (delays + 1) + [Fraction(c, 10) for c in b]
    A, B = (np.array([float(c) for c in row]) for row in (exact_a, exact_b))
    wanted = with_zeros([p / 10 for p in poles])
    zeros, taken = zeros_of(B), np.append(zeros_of(A), np.ones(integrators))
    assume(not zeros.size or abs(zeros[:, None] - taken).min(initial=np.inf) > 0.05)
    assume(sum(b) != 0)
    numeric = place_numerically(B, A, wanted, 1.0, integrators=integrators)
    expressions = [polynomial([Rational(c.numerator, c.denominator) for c in row]) for row in (exact_a, exact_b)]
    P = polynomial([1])
    for p in poles:
        P = P * polynomial([1, -Rational(p, 10)])
    design = symbolic.place_exactly(*expressions, P, symbolic.integrators(integrators))
    for ours, theirs in ((numeric.regulator.R, design.C), (numeric.regulator.S, design.D)):
        exact = np.array([float(c) for c in coefficients(theirs)], dtype=float)
        size = max(len(ours), len(exact))
        padded = np.pad(exact, (0, size - len(exact))), np.pad(ours, (0, size - len(ours)))
        assert np.abs(padded[0] - padded[1]).max() < 1e-10 * numeric.condition * max(1, np.abs(exact).max(initial=0))
    assert numeric.regulator.T[0] == pytest.approx(float(design.Kr), rel=1e-9)


@settings(max_examples=40, deadline=None)
@given(
    st.lists(st.floats(0.5, 20), min_size=1, max_size=4, unique=True),
    st.floats(0, 3),
    st.floats(0.2, 2),
    st.floats(0.1, 0.8),
    st.floats(0.1, 0.5),
)
def test_the_loop_has_the_poles_that_were_asked_for(lags, delay, h, q, observer):
    den = [1.0]
    for lag in lags:
        den = np.polymul(den, [lag, 1])
    B, A = sample(Process([2.0], den, delay), h).polynomials
    design = place_numerically(B, A, with_zeros([q] * 2), h, observer=with_zeros([observer]))
    assume(design.condition < 1e6)
    got, wanted = loop_polynomial(B, A, design.regulator), with_zeros([q, q, observer])
    assert np.abs(got[: len(wanted)] - wanted).max() < 1e-9
    assert np.abs(got[len(wanted) :]).max(initial=0) < 1e-9
    assert design.residual < 1e-9


def test_the_double_tank_runs_without_error_left():
    """Load and reference steps are controlled away; the controller that runs is the recursion derived for it."""
    B, A = sample(TANK, 1.0).polynomials
    regulator = place_numerically(B, A, with_zeros([0.5] * 3), 1.0).regulator
    run = simulate(TANK, regulator.controller(), 1.0, 80, reference=1.0, load=-2000.0)
    assert run.y[-1] == pytest.approx(1, abs=1e-9)
    assert run.u[-1] == pytest.approx(8360 + 2000, abs=1e-4)
    by_hand = np.zeros(81)
    R, S, T = (np.array(row) for row in (regulator.R, regulator.S, regulator.T))
    for k in range(81):
        past = sum(R[i] * by_hand[k - i] for i in range(1, len(R)) if k >= i)
        by_hand[k] = T.sum() - sum(S[i] * run.y[k - i] for i in range(len(S)) if k >= i) - past
    assert np.abs(by_hand - run.u).max() < 1e-9 * np.abs(run.u).max()


def test_the_observer_does_not_change_the_reference_response():
    B, A = sample(TANK, 1.0).polynomials
    runs = [
        simulate(
            TANK,
            place_numerically(B, A, with_zeros([0.5] * 3), 1.0, observer=o).regulator.controller(),
            1.0,
            40,
            reference=1,
        )
        for o in ((1.0,), with_zeros([0.6, 0.6]))
    ]
    assert np.abs(runs[0].y - runs[1].y).max() < 1e-11


def test_cancelled_zeros_leave_the_loop_and_bad_ones_stay():
    A, B = [1, -1.2, 0.5], [0, 0.5, -0.2]
    design = place_numerically(B, A, with_zeros([0.3, 0.3]), 1.0, cancel_damping=0.5)
    assert design.cancelled == pytest.approx([0.4])
    assert np.abs(zeros_of(design.regulator.R) - 0.4).min() < 1e-9
    ringing = place_numerically([0, 0.5, 0.45], A, with_zeros([0.3, 0.3]), 1.0, cancel_damping=0.5)
    assert not ringing.cancelled.size
    assert well_damped(np.array([0.0, 0.9, -0.89, 0.7j, 1.1]), 0.3).tolist() == [True, True, False, False, False]


def test_saturation_does_not_wind_up():
    """The input limited to 1.2 times what the set-point needs: with u remembered as limited there is no overshoot to
    speak of; a regulator that remembers what it asked for overshoots by more than that."""
    B, A = sample(TANK, 1.0).polynomials
    regulator = place_numerically(B, A, with_zeros([0.5] * 3), 1.0, observer=with_zeros([0.5, 0.5])).regulator
    high = 1.2 * 8360
    limited = simulate(TANK, regulator.controller(0, high), 1.0, 120, reference=1.0)
    blind = simulate(TANK, regulator.controller(), 1.0, 120, reference=1.0, limits=(0, high))
    assert limited.u.max() <= high
    assert limited.y.max() < 1.02 < blind.y.max()
    assert limited.y[-1] == pytest.approx(1, abs=1e-3)


def test_a_regulator_unstable_by_itself_is_said_to_be_so():
    assert not Rst((1, -2.2, 1.2), (1,), (1,), 1.0).is_stable
    assert not Rst((1, -2, 1), (1,), (1,), 1.0).is_stable
    assert Rst((1, -1.3, 0.3), (1,), (1,), 1.0).is_stable


def test_the_condition_number_tells_of_a_near_common_factor():
    far, near = (place_numerically([0, 1, -0.5], [1, -a], with_zeros([0.2]), 1.0).condition for a in (0.9, 0.5001))
    assert near > 1e3 * far


@pytest.mark.parametrize(
    ("build", "says"),
    [
        (lambda: place_numerically([0, 1, -0.5], [1, -0.5], [1, -0.2], 1.0), r"A and B share the factor 1 - \(0.5\) z"),
        (
            lambda: place_numerically([0, 1, -1], [1, -0.5], [1, -0.2], 1.0),
            r"the integrator and B share the factor 1 - \(1\)",
        ),
        (lambda: place_numerically([0, 1, -1, 0.5], [1, -1, 0.5], [1], 1.0), r"share the factor 1 - \(0.5[+-]0.5j\)"),
        (lambda: place_numerically([1, 0.5], [1, -0.5], [1], 1.0), "without delay"),
        (lambda: place_numerically([0, 0], [1, -0.5], [1], 1.0), "does not reach the output"),
        (lambda: place_numerically([0, 1], [0, 1], [1], 1.0), "A = .* term without delay"),
        (lambda: place_numerically([0, 1], [1, -0.5], [2, 1], 1.0), "P = .* must start with 1"),
        (lambda: place_numerically([0, 1], [1, -0.5], [1, -1], 1.0), "P has a pole at z = 1"),
        (lambda: place_numerically([0, 1], [1, np.nan], [1], 1.0), "finite coefficients"),
        (lambda: Rst((0, 1), (1,), (1,), 1.0), "no term without delay"),
        (lambda: Rst((1,), (1,), (1,), 1.0, observer=(1, -1.5)), "not stable"),
        (lambda: Rst((1,), (1,), (1,), 1.0).controller(2, 1), "below the upper"),
    ],
)
def test_errors_name_the_factor_or_the_polynomial(build, says):
    with pytest.raises(ValueError, match=says):
        build()
