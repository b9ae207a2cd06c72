"""Derived expressions with numbers put in."""

import pytest
import sympy as sp

from derivations.plants import heated_tanks as tanks
from loopbook.process.from_symbols import process_of
from loopbook.process.transfer_function import Process, ProcessError

VALUES = {"V_1": 0.010, "V_r": 0.004, "V_2": 0.014, "Q": 0.002, "c": 4180, "rho": 1000}


def test_the_double_tank_has_whole_time_constants():
    """0.014/0.002 is 7 and not 7.000000000000001: a float counts as the decimal that it is written as."""
    assert process_of(tanks.path(tanks.V), VALUES) == Process((1,), (35, 12, 1), 2)
    assert process_of(tanks.path(tanks.U), VALUES) == Process((1 / 8360,), (35, 12, 1), 2)


def test_symbols_may_be_keys_and_s_may_have_another_name():
    p, T = sp.symbols("p T")
    assert process_of((2 * p + 1) / (T * p), {T: 4}, p) == Process((0.5, 0.25), (1, 0), 0)


@pytest.mark.parametrize(
    ("expression", "says"),
    [
        ("k/(s + 1)", "no value for k"),
        ("exp(-2*s**2)/(s + 1)", "no rational function"),
        ("sqrt(s)/(s + 1)", "no rational function"),
        ("exp(2*s)/(s + 1)", "negative"),
        ("s**2/(s + 1)", "improper"),
    ],
)
def test_what_is_no_process_is_refused(expression, says):
    with pytest.raises(ProcessError, match=says):
        process_of(sp.sympify(expression), {})
