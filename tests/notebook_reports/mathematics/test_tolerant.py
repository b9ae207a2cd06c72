"""Formulas as browsers read them: the formula itself first, then the readings that mend it."""

import pytest

from notebook_reports.mathematics import MathError, latex_to_typst
from notebook_reports.mathematics.tolerant import readings


def first_that_reads(latex):
    for reading in readings(latex):
        try:
            latex_to_typst(reading, display=True)
        except MathError:
            continue
        return reading
    return None


@pytest.mark.parametrize(
    "latex", [r"\frac{a}{b}", r"x_1 + \alpha^2", r"\begin{aligned} a &= b \\ c &= d \end{aligned}"]
)
def test_valid_latex_is_read_as_it_is(latex):
    assert next(iter(readings(latex))) == latex == first_that_reads(latex)


@pytest.mark.parametrize(
    ("latex", "inside"),
    [(r"a \\ b", r"\begin{gathered}"), (r"a &= b \\ c &= d", r"\begin{aligned}"), (r"\frac{a}{b", "{b}")],
)
def test_what_is_no_valid_latex_gets_a_reading(latex, inside):
    with pytest.raises(MathError):
        latex_to_typst(latex, display=True)
    assert inside in first_that_reads(latex)
