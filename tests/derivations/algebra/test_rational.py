"""Zero tests and linear solutions against SymPy's general routines."""

import pytest
from sympy import Eq, Function, Rational, cos, exp, simplify, sin, solve, sqrt, symbols

from derivations.algebra.rational import NotLinear, solved_for, vanishes

a, b, c, x, y = symbols("a b c x y")
T, K = symbols("T K", positive=True)
f = Function("f")
ZERO = {
    "one fraction": 1 / x - y / (x * y),
    "nested": 1 / (1 + 1 / x) - x / (x + 1),
    "powers": (x + y) ** 3 / (x + y) - x**2 - 2 * x * y - y**2,
    "samples": (f(a) + 1) ** 2 - f(a) ** 2 - 2 * f(a) - 1,
    "exponentials as they stand": exp(-a / T) * (1 - 1 / K) - (K - 1) * exp(-a / T) / K,
    "roots": (sqrt(K) + sqrt(T)) * (sqrt(K) - sqrt(T)) - K + T,
    "angles": sin(x) ** 2 + cos(x) ** 2 - 1,
}
NOT_ZERO = {
    "a term": 1 / x - 1 / y,
    "a small number": Rational(1, 10**30) * x,
    "a sign": a / (b - c) - a / (c - b),
    "an exponential": exp(x) - exp(y),
    "a sample": f(a) - f(b),
}


@pytest.mark.parametrize("name", ZERO)
def test_zero(name):
    assert vanishes(ZERO[name])
    assert simplify(ZERO[name]) == 0


@pytest.mark.parametrize("name", NOT_ZERO)
def test_not_zero(name):
    assert not vanishes(NOT_ZERO[name])
    assert simplify(NOT_ZERO[name]) != 0


@pytest.mark.parametrize(
    ("equation", "unknown"),
    [
        (Eq(a * x, b - x), x),
        (Eq(a / x, b / (x + c)), x),
        (Eq(x / (1 + x), y), x),
        (Eq(f(a) * K + T, f(a) / T - f(b)), f(a)),
        (Eq(exp(-a) * x + 1, b * x), x),
        (Eq(y, a * (b + c) / (T * x + 1)), x),
    ],
)
def test_linear_equations_as_sympy_solves_them(equation, unknown):
    found = solved_for(unknown, *equation.args)
    (slow,) = solve(equation, unknown)
    assert simplify(found - slow) == 0
    assert simplify((equation.lhs - equation.rhs).subs(unknown, found)) == 0


@pytest.mark.parametrize("equation", [Eq(x**2, a), Eq(x * (x + 1), x**2 + b * x**3), Eq(sin(x), a * x), Eq(a, b)])
def test_what_is_not_linear_is_refused(equation):
    with pytest.raises(NotLinear) as error:
        solved_for(x, *equation.args)
    assert error.value.unknown == x
    assert "must be linear in x" in str(error.value)
