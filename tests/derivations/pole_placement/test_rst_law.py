"""The recursion of an RST regulator: without saturation it is R u = T r - S y whatever the observer polynomial."""

import sympy as sp

from derivations.algebra.delay_polynomials import K, Z
from derivations.pole_placement.rst_law import law


def transformed(equation):
    """The z transform of a difference equation, left less right."""
    from sympy.core.function import AppliedUndef

    signals = equation.atoms(AppliedUndef)
    return (equation.lhs - equation.rhs).subs(
        {s: sp.Symbol(s.func.__name__.upper()) * Z ** -(K - s.args[0]) for s in signals}
    )


def test_with_u_equal_to_v_the_observer_drops_out():
    with_observer, without = (transformed(law(2, 1, 1, o)).subs(sp.Symbol("V"), sp.Symbol("U")) for o in (2, 0))
    assert sp.expand(with_observer - without) == 0
    r1, r2, s0, s1, t0, t1 = sp.symbols("r_1 r_2 s_0 s_1 t_0 t_1")
    U, Y, R = sp.symbols("U Y R")
    expected = U * (1 + r1 / Z + r2 / Z**2) + Y * (s0 + s1 / Z) - R * (t0 + t1 / Z)
    assert sp.expand(without - expected) == 0


def test_in_saturation_v_follows_with_the_poles_of_the_observer():
    """With u held by the actuator, v depends on its own past through A_o alone."""
    equation = law(3, 1, 0, 2)
    v = sp.Function("v")
    assert equation.rhs.coeff(v(K - 1)) == -sp.Symbol("o_1")
    assert equation.rhs.coeff(v(K - 2)) == -sp.Symbol("o_2")
    assert not equation.rhs.has(v(K - 3))
