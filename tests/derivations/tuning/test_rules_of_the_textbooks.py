"""Tyreus-Luyben, Cohen-Coon, IMC by their tables; gains by damping and by phase margin by what they promise."""

import pytest
import sympy as sp
from sympy import Rational as R

from derivations.tuning import by_damping, cohen_coon, internal_model_control, pi_by_margin, tyreus_luyben
from derivations.tuning.letters import T_0, K_u, T, T_u, k, lam

r = T_0 / T
TABLES = {
    cohen_coon: {
        "cohen-coon-p": ((1 + r / 3) / (k * r), sp.oo, 0),
        "cohen-coon-pi": ((R(9, 10) + r / 12) / (k * r), T_0 * (30 + 3 * r) / (9 + 20 * r), 0),
        "cohen-coon-pid": ((R(4, 3) + r / 4) / (k * r), T_0 * (32 + 6 * r) / (13 + 8 * r), 4 * T_0 / (11 + 2 * r)),
    },
    tyreus_luyben: {
        "tyreus-luyben-pi": (K_u * 5 / 16, R(11, 5) * T_u, 0),
        "tyreus-luyben-pid": (K_u * 5 / 11, R(11, 5) * T_u, T_u * 10 / 63),
    },
    internal_model_control: {
        "imc-pi": ((2 * T + T_0) / (2 * k * lam), T + T_0 / 2, 0),
        "imc-pi-lag": (T / (k * lam), T, 0),
        "imc-pid": ((2 * T + T_0) / (k * (2 * lam + T_0)), T + T_0 / 2, T * T_0 / (2 * T + T_0)),
    },
}


@pytest.mark.parametrize("module", TABLES, ids=lambda m: m.__name__)
def test_formulas_are_those_of_the_tables(module):
    found = {rule.name: rule for rule in module.rules()}
    assert set(found) == set(TABLES[module])
    for name, (K, Ti, Td) in TABLES[module].items():
        rule = found[name]
        assert sp.simplify(rule.K - K) == 0 and sp.simplify(rule.Td - Td) == 0
        assert (rule.Ti == Ti) or sp.simplify(rule.Ti - Ti) == 0


def test_gains_by_damping_place_the_poles():
    d, s = by_damping, by_damping.s
    pair = s**2 + 2 * d.zeta * d.omega_0 * s + d.omega_0**2
    first = (s * (d.a_1 * s + d.a_0) + d.b * (d.P * s + d.I)).subs(d.pi())
    assert sp.expand(first - d.a_1 * pair) == 0
    second = (s * (d.a_2 * s**2 + d.a_1 * s + d.a_0) + d.b * (d.D * s**2 + d.P * s + d.I)).subs(d.pid())
    assert sp.expand(second - d.a_2 * (s + d.alpha * d.omega_0) * pair) == 0
    values = {d.b: 1, d.a_1: 1, d.a_0: 1, d.omega_0: 2, d.zeta: R(7, 10)}
    P, I = (d.pi()[x].subs(values) for x in (d.P, d.I))
    assert (P, P / I) == (R(9, 5), R(9, 20))


def test_gains_by_margin_turn_the_process_to_its_margin():
    m = pi_by_margin
    P, I = (m.gains()[x] for x in (m.P, m.I))
    loop = (P - sp.I * I / m.w) * m.g * sp.exp(sp.I * m.phase)
    assert sp.simplify((loop - sp.exp(sp.I * (m.margin - sp.pi))).rewrite(sp.exp)) == 0
