"""The four sets of Chien, Hrones and Reswick, beside their tables of 1952: a K, Ti and Td in units of T or T0."""

import pytest
from sympy import Rational, oo

from derivations.tuning.chien_hrones_reswick import SETS, rules
from derivations.tuning.letters import T_0, T, a

TABLES = {
    (0, "set-point"): [("0.3", oo, 0), ("0.35", "1.2 T", 0), ("0.6", "1 T", "0.5 L")],
    (20, "set-point"): [("0.7", oo, 0), ("0.6", "1 T", 0), ("0.95", "1.4 T", "0.47 L")],
    (0, "load"): [("0.3", oo, 0), ("0.6", "4 L", 0), ("0.95", "2.4 L", "0.42 L")],
    (20, "load"): [("0.7", oo, 0), ("0.7", "2.3 L", 0), ("1.2", "2 L", "0.42 L")],
}


def time(text):
    if not isinstance(text, str):
        return text
    number, unit = text.split()
    return Rational(number) * {"T": T, "L": T_0}[unit]


@pytest.mark.parametrize("which", TABLES)
def test_the_sets_are_those_of_the_tables(which):
    for row, (gain, integral, derivative) in zip(SETS[which].values(), TABLES[which], strict=True):
        assert row[0] * a == Rational(gain) and row[1:] == (time(integral), time(derivative))


def test_the_rules_are_the_sets_for_the_set_point():
    printed = {rule.name for rule in rules() if not rule.variant_of}
    assert printed == {f"chr-{k}-{o}" for k in ("p", "pi", "pid") for o in (0, 20)}
