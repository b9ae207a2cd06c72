"""The double tank from its heat balances."""

import sympy as sp

from derivations.plants import heated_tanks as tank


def test_the_balance_holds():
    T = tank.mixed_tank(tank.V1, tank.V, tank.U)
    stored = tank.rho * tank.c * tank.V1 * tank.s * T
    assert sp.simplify(stored - tank.rho * tank.c * tank.Q * (tank.V - T) - tank.U) == 0


def test_both_inputs_pass_the_same_path():
    assert sp.simplify(tank.path(tank.U) / tank.path(tank.V) - 1 / (tank.Q * tank.c * tank.rho)) == 0


def test_numbers_of_double_tank():
    values = {
        tank.V1: sp.Rational(10, 1000),
        tank.Vr: sp.Rational(4, 1000),
        tank.V2: sp.Rational(14, 1000),
        tank.Q: sp.Rational(2, 1000),
        tank.c: 4180,
        tank.rho: 1000,
    }
    expected = sp.exp(-2 * tank.s) / (8360 * (5 * tank.s + 1) * (7 * tank.s + 1))
    assert sp.simplify(tank.path(tank.U).subs(values) / expected) == 1


def test_without_flow_there_is_no_rest():
    """Heat that is not carried away accumulates: the static gain grows without bound as Q falls."""
    assert sp.limit(tank.path(tank.U).subs(tank.s, 0), tank.Q, 0, "+") == sp.oo
