"""The difference operators, against hand-made recursions and the order of their error."""

import pytest
from sympy import Derivative, Eq, Function, Rational, Symbol, exp, series, simplify, solve

from derivations.algebra.differences import (
    BACKWARD,
    FORWARD,
    TUSTIN,
    at,
    by_signals,
    discretise,
    h,
    name_gains,
    t,
    update,
)

x, r = Function("x"), Function("r")
T = Symbol("T", positive=True)
LAG = Eq(T * x(t).diff(t), r(t) - x(t))


@pytest.mark.parametrize(
    ("difference", "expected"),
    [
        (FORWARD, {1: 1 - h / T}),
        (BACKWARD, {0: T / (T + h)}),
        (TUSTIN, {0: (2 * T - h) / (2 * T + h)}),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_pole_of_a_lag(difference, expected):
    """Forward 1 - h/T, backward T/(T + h), Tustin (2T - h)/(2T + h): the textbook poles."""
    ((newest, pole),) = expected.items()
    gains = by_signals(update(LAG, "x", difference).rhs)
    assert simplify(gains[at("x", newest - 1)] - pole) == 0


@pytest.mark.parametrize(("difference", "order"), [(FORWARD, 2), (BACKWARD, 2), (TUSTIN, 3)])
def test_order_of_the_error(difference, order):
    """The pole differs from exp(-h/T) by h^2 for the one-sided differences and by h^3 for Tustin."""
    pole = next(g for s, g in by_signals(update(LAG, "x", difference).rhs).items() if s.func == x)
    error = series(pole - exp(-h / T), h, 0, order + 1).removeO()
    assert error.coeff(h, order) != 0
    assert all(error.coeff(h, n) == 0 for n in range(order))


@pytest.mark.parametrize("difference", [FORWARD, BACKWARD, TUSTIN], ids=lambda d: d.name)
def test_a_constant_stays_and_a_ramp_has_its_slope(difference):
    """Consistency: weights of the value sum to 1, of the slope to 0, and a ramp of slope 1 has the difference 1."""
    assert sum(difference.value.values()) == 1
    assert sum(difference.slope.values()) == 0
    assert sum(n * w for n, w in difference.slope.items()) == 1


def test_only_first_derivatives():
    with pytest.raises(ValueError, match="only first derivatives have a forward difference"):
        discretise(Eq(Derivative(x(t), t, t), r(t)), FORWARD)


def test_named_gains_reproduce_the_equation():
    raw = update(LAG, "x", BACKWARD)
    p = Symbol("p")
    gains, short = name_gains(raw, {p: at("x", -1)})
    assert short.rhs == p * at("x", -1) + (1 - p) * at("r")
    assert simplify(short.rhs.subs(gains) - raw.rhs) == 0


def test_a_gain_that_has_no_name_is_refused():
    g = Symbol("g", positive=True)
    other = Eq(at("x"), at("x", -1) * T / (T + h) + g * at("r"))
    gains, short = name_gains(other, {Symbol("p"): at("x", -1)})
    assert short.rhs.coeff(at("r")) == g  # a free gain stays as it is
    assert gains == {Symbol("p"): T / (T + h)}


def test_final_value_of_each_lag():
    """Whatever the difference, a constant input ends at itself."""
    for difference in (FORWARD, BACKWARD, TUSTIN):
        equation = update(LAG, "x", difference)
        rest = Symbol("rest")
        constant = equation.subs({s: rest for s in equation.atoms(Function) if s.func == x}).subs(
            {s: Rational(3) for s in equation.atoms(Function) if s.func == r}
        )
        assert solve(constant, rest) == [3]
