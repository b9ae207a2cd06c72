"""The programs of figures 4.9, 4.10, 4.11, 4.12 and 4.13 are one controller: proof by induction.

All states are written through two numbers, the filtered measurement y_fold and the measurement y_old of the sample
before. The proof has two steps for each program, both for free symbols as inputs and settings:

    the output   a pass gives the same v as figure 4.9, so the limited u is the same whatever the limits
    the states   after the pass the states are again the same functions of the new y_f and y

With the base case (start in such states) every sample is equal, with limits and anti-windup included.
Source: pid-report, sections 4.2.7 and 4.2.8.
"""

from collections.abc import Mapping
from functools import cache

from sympy import Expr, Symbol, simplify

from derivations.algebra.rational import factored
from derivations.pid.pid_laws import K, Td
from derivations.pid.rc_filter import Tf
from derivations.programs import pid_code as code


def states_from(figure: str, filtered: Expr, measured: Expr) -> dict[Symbol, Expr]:
    """States of one program before a pass, where y_f was ``filtered`` and y was ``measured`` at the sample before.

    Figure 4.11 needs T_f > 0 here; with T_f = 0 its D_fold is multiplied by zero and y_old = y_fold.
    Raises KeyError for another figure.
    """
    program = code.programs()[figure]
    gain = program.gain_values()
    slope = K * Td * (filtered - measured) / Tf
    return {
        "4.9": {code.yf_old: filtered},
        "4.10": {code.F_temp: gain.get(code.p11, 0) * filtered, code.D_temp: gain.get(code.p15, 0) * filtered},
        "4.11": {code.Df_old: slope, code.y_old: measured},
        "4.12": {code.x: gain.get(code.p24, 0) * filtered},
        "4.13": {code.x: code.derivative_gain() * filtered},
    }[figure]


def one_pass(program: code.Program, states: Mapping[Symbol, Expr]) -> dict[Symbol, Expr]:
    """One pass with free inputs, a free limited output u and a free I."""
    free = {s: s for s in (code.y, code.ysp, code.I)}
    gains = program.gain_values()
    values = program.run({**free, code.u: code.u, **{p: p for p in gains}, **states})
    return {name: value.xreplace(gains) for name, value in values.items() if hasattr(value, "xreplace")}


@cache
def residuals(figure: str) -> dict[str, Expr]:
    """What remains of "same output" and "same form of the states" for one program against figure 4.9: all zero.

    >>> residuals("4.13")
    {'v': 0, 'I': 0, 'x': 0}
    """
    filtered, measured = code.yf_old, code.y_old
    reference = one_pass(code.separate(), states_from("4.9", filtered, measured))
    program = code.programs()[figure]
    passed = one_pass(program, states_from(figure, filtered, measured))
    expected = {
        code.v: reference[code.v],
        code.I: reference[code.I].subs(code.v, reference[code.v]),
        **states_from(figure, reference[code.yf_now], code.y),
    }
    return {str(s): factored(passed[s] - value) for s, value in expected.items()}


@cache
def filter_order_residual() -> Expr:
    """Filtering y before D or filtering D gives the same D: the difference between figures 4.9 and 4.11, zero."""
    first = one_pass(code.separate(), states_from("4.9", code.yf_old, code.y_old))[code.D]
    second = one_pass(code.merged(), states_from("4.11", code.yf_old, code.y_old))[code.Df]
    return factored(first - second)


def steady_derivative(gain: Expr) -> Expr:
    """D_f of figure 4.13 at a constant y, for any expression that is put in for p4; zero with the right one."""
    filter_pole = code.minimal().gain_values()[code.p3]
    return simplify(gain * code.y / (1 - filter_pole) - code.derivative_gain() * code.y)
