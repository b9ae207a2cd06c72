"""Long integer ratios in printed programs: which number a symbolic tool made of a floating-point one.

A symbolic tool that is given 1.526e-06 gets a binary fraction, not a decimal. MATLAB's `sym` tries a ratio of integers
of modest size that reads back as the same number and otherwise takes the stored binary fraction as it is. So -1.686
comes back as -843/500, while 1.526e-06 = 763/500000000 becomes 7206331252859079/2^72, and from there the ratios grow.
"""

from collections.abc import Mapping
from fractions import Fraction

MODEST = 10**6
"""Largest denominator taken for modest. The document fixes it between 10^4 (recovered) and 5 * 10^8 (not recovered)."""


def symbolic_number(value: float, modest: int = MODEST) -> Fraction:
    """The ratio that a symbolic tool takes for a stored number.

    >>> symbolic_number(-1.686)
    Fraction(-843, 500)
    >>> symbolic_number(1.526e-06) == Fraction(7206331252859079, 2**72)
    True
    """
    stored = Fraction(float(value))
    simple = stored.limit_denominator(modest)
    return simple if float(simple) == float(value) else stored


def as_printed(name: str, coefficients: Mapping[int, Fraction]) -> dict[str, int]:
    """Numerators and denominators in lowest terms by id, ``name-q2-numerator``; denominators of 1 are not printed.

    coefficients: power of q -> coefficient.

    >>> as_printed("c1", {1: Fraction(-3), 0: Fraction(1343, 500)})
    {'c1-q1-numerator': -3, 'c1-q0-numerator': 1343, 'c1-q0-denominator': 500}
    """
    found = {}
    for power, c in coefficients.items():
        found[f"{name}-q{power}-numerator"] = c.numerator
        if c.denominator != 1:
            found[f"{name}-q{power}-denominator"] = c.denominator
    return found


def read_back(printed: Mapping[str, Fraction], name: str) -> dict[int, Fraction]:
    """The polynomial in q that the printed numbers of one name give: power -> coefficient; inverse of `as_printed`.

    >>> read_back({"c1-q1-numerator": -3, "c1-q0-numerator": 1343, "c1-q0-denominator": 500}, "c1")
    {1: Fraction(-3, 1), 0: Fraction(1343, 500)}
    """
    powers = [int(i.split("-")[-2][1:]) for i in printed if i.startswith(f"{name}-q") and i.endswith("-numerator")]
    return {
        n: Fraction(printed[f"{name}-q{n}-numerator"]) / Fraction(printed.get(f"{name}-q{n}-denominator", 1))
        for n in powers
    }


def value_at(coefficients: Mapping[int, Fraction], q: Fraction) -> Fraction:
    """The value of the polynomial at q."""
    return sum((c * q**n for n, c in coefficients.items()), Fraction(0))
