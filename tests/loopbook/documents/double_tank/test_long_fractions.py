"""The long ratios of the appendix, digit by digit, and the digit that is lost."""

from fractions import Fraction as F

import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st

from derivations.algebra.delay_polynomials import Z
from derivations.pole_placement.diophantine import integrators, place_exactly
from loopbook.documents.double_tank.long_fractions import as_printed, read_back, symbolic_number, value_at
from loopbook.documents.open import printed as load
from notebook_reports.ledger.verdicts import MISPRINT, ROUNDED, Computed, rounds_to, value_verdict

DOCUMENT = load("double-tank")
PRINTED = {i: v for i, v in DOCUMENT.values.items() if i.startswith("d_iterativ-")}
LOST = "d_iterativ-d1-q2-numerator"
a1, a2, b3, b4, q = sp.symbols("a_1 a_2 b_3 b_4 q")


def ratios(numbers):
    design = place_exactly(1 + a1 / Z + a2 / Z**2, b3 / Z**3 + b4 / Z**4, (1 - q / Z) ** 3, integrators(1))
    found = {}
    for name, value in design.parameters.items():
        terms = sp.Poly(value.subs(numbers), q).terms()
        powers = {n: F(int(c.p), int(c.q)) for (n,), c in terms}
        found |= as_printed(f"d_iterativ-{name.replace('_', '')}", powers)
    return found


STORED = {a1: -1.686, a2: 0.7097, b3: 1.526e-06, b4: 1.361e-06}
COMPUTED = ratios({s: symbolic_number(x) for s, x in STORED.items()})


def test_the_print_has_48_integers_and_each_is_computed():
    assert len(PRINTED) == 48
    assert set(PRINTED) == set(COMPUTED)


@pytest.mark.parametrize("id", PRINTED)
def test_digit_by_digit(id):
    expected = MISPRINT if id == LOST else ROUNDED
    assert value_verdict(PRINTED[id], Computed(from_inputs=COMPUTED[id])) == expected
    assert str(COMPUTED[id]) == (PRINTED[id].corrected or PRINTED[id].printed)


def test_the_lost_digit_is_one_digit():
    print_, right = PRINTED[LOST].printed, PRINTED[LOST].corrected
    assert any(right[:i] + right[i + 1 :] == print_ for i in range(len(right)))


def test_decimals_would_give_other_integers():
    """The stored binary fractions are needed: with decimals d_0 is another ratio of the same value to 16 digits."""
    decimals = ratios({s: F(str(x)) for s, x in STORED.items()})
    id = "d_iterativ-d0-q3-numerator"
    assert decimals[id] != COMPUTED[id]


def test_the_printed_program_gives_the_table_but_for_d1():
    values = {i: v.fraction for i, v in PRINTED.items()}
    for name in ("Kr", "c1", "c2", "c3", "d0", "d1", "d2"):
        cubic = read_back(values, f"d_iterativ-{name}")
        for pole in ("0.3", "0.5", "0.7"):
            same = rounds_to(value_at(cubic, F(pole)), DOCUMENT.values[f"regulator-{name}-q{pole}"].printed)
            assert same == (name != "d1"), (name, pole)


def test_one_altered_digit_is_seen():
    value = PRINTED["d_iterativ-c3-q0-numerator"]
    digits = value.printed[:-1] + ("8" if value.printed[-1] != "8" else "7")
    assert not rounds_to(COMPUTED[value.id], digits)


@given(st.floats(min_value=1e-12, max_value=1e12))
def test_symbolic_number_reads_back(x):
    assert float(symbolic_number(x)) == x


@given(st.dictionaries(st.integers(0, 3), st.fractions(), min_size=1))
def test_there_and_back(cubic):
    assert read_back(as_printed("x", cubic), "x") == cubic
