"""Eq. 4.10 and what a change of a setting does to each program; manual mode by tracking."""

import pytest
from sympy import Rational, simplify

from derivations.algebra.differences import h
from derivations.pid import tracking
from derivations.pid.pid_laws import K, Td, Ti, Tt, b
from derivations.pid.rc_filter import Tf
from derivations.programs import pid_code as code
from derivations.programs.bumpless import (
    NEW,
    SETTINGS,
    jump,
    jump_after,
    keep_both_parts,
    keep_derivative,
    keep_p_plus_i,
    late_correction,
)

y = code.y
FIGURES = list(code.programs())
# one table of verdicts, by hand: which settings jump in steady state, and by how much
STEADY = {
    ("4.10", "K"): -(NEW[K] - K) * Td / h * y,
    ("4.10", "Td"): -K * (NEW[Td] - Td) / h * y,
    ("4.10", "Tf"): K * Td * y * (1 / (Tf + h) - 1 / (NEW[Tf] + h)),
    ("4.12", "K"): -(NEW[K] - K) * Td / (Tf + h) * y,
    ("4.12", "Td"): -K * (NEW[Td] - Td) / (Tf + h) * y,
    ("4.12", "Tf"): K * Td * y * (1 / (Tf + h) - 1 / (NEW[Tf] + h)),
}


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("figure", FIGURES)
def test_jump_in_steady_state(figure, setting):
    expected = STEADY.get(("4.12" if figure == "4.13" else figure, setting), 0)
    assert simplify(jump(figure, setting, steady=True) - expected) == 0, f"eq. 4.10 in figure {figure}"


@pytest.mark.parametrize("setting", SETTINGS)
@pytest.mark.parametrize("figure", FIGURES)
def test_jump_in_motion(figure, setting):
    """b and T_i never jump; K, T_d and T_f do in every program while the measurement moves."""
    assert (jump(figure, setting, steady=False) == 0) == (setting in ("b", "Ti"))


def test_without_the_correction_p_jumps():
    assert simplify(jump("4.9", "b", True, correct=False) - K * (NEW[b] - b) * code.ysp) == 0, "eq. 4.10"
    assert simplify(jump("4.9", "K", True, correct=False) - (NEW[K] - K) * (b * code.ysp - y)) == 0, "eq. 4.10"


@pytest.mark.parametrize("figure", FIGURES)
def test_nothing_jumps_with_the_derived_update(figure):
    assert jump_after(figure) == 0, f"figure {figure}"


def test_update_of_x_keeps_a_steady_state_steady():
    """x = p24 y before means x = p24' y after: no transient follows either."""
    (update,) = keep_derivative("4.13").values()
    old, new = sorted((s for s in update.free_symbols if s.name.startswith("p_24")), key=str, reverse=True)
    assert simplify(update.subs(code.x, old * y) - new * y) == 0


def test_late_measurement_adds_the_step_of_p():
    assert simplify(late_correction() + (NEW[K] - K) * (y - code.y_old)) == 0, "eq. 4.10"


def test_equation_4_10_solves_its_own_condition():
    solution = keep_p_plus_i()
    assert solution.lhs.name == "I_new"
    assert {s.name for s in solution.rhs.free_symbols} == {"I_old", "K_old", "K_new", "b_old", "b_new", "y_sp", "y"}


def test_tracking():
    """Pole 1 - h/Tt; v settles K Tt/Ti e from the imposed output; one bad sample takes h s/Tt."""
    assert simplify(tracking.pole() - (1 - h / Tt)) == 0, "eq. 4.5"
    assert simplify(tracking.bump() - K * Tt / Ti * tracking.error) == 0, "eq. 4.5"
    assert simplify(tracking.spike_effect() + h * tracking.spike / Tt) == 0, "eq. 4.5"
    assert tracking.rule(Rational(4), Rational(9)) == 6


def test_both_parts_are_kept_with_a_weight_on_the_derivative():
    """D = x - p24 (y - c y_sp) is the same before and after; with c = 0 it is the update of figure 4.13."""
    new = keep_both_parts()
    named = {s.name: s for s in new[code.x].free_symbols}
    old_d = code.x - named["p_24old"] * (y - named["c_old"] * code.ysp)
    new_d = new[code.x] - named["p_24new"] * (y - named["c_new"] * code.ysp)
    assert simplify(new_d - old_d) == 0, "figure 4.13"
    without = new[code.x].subs({named["c_old"]: 0, named["c_new"]: 0})
    assert simplify(without - keep_derivative("4.13")[code.x]) == 0
    (before,) = (s for s in keep_p_plus_i().rhs.free_symbols if s.name == "I_old")
    assert new[code.I] == keep_p_plus_i().rhs.subs(before, code.I), "eq. 4.10"
