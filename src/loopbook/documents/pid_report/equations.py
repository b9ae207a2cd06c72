"""The numbered equations 4.1 to 4.20 of pid-report, each as derived.

Samples are written y(t_k); equations 4.14 to 4.20 stand in the document as program text and use variables.
"""

from sympy import Eq, Expr, Symbol

from derivations.algebra.differences import at
from derivations.algebra.equality import equality
from derivations.pid import pid_updates as term
from derivations.programs import pid_code as code
from derivations.programs.bumpless import keep_p_plus_i
from loopbook.documents.labels import Labels
from notebook_reports.formula.read import read_formula
from notebook_reports.ledger.printed_data import Claim

EQUATIONS = Labels("pid-report")


def said(claim: Claim, field: str) -> Expr:
    """The formula in a field of a statement, with a symbol for each of its names.

    >>> said(Claim("", "", "", "", {"filter": "T_d/N"}), "filter")
    T_d/N
    """
    return read_formula(claim.text(field), where=claim.where)


def _gain(program: code.Program, symbol: Symbol) -> Eq:
    return equality(symbol, program.gain_values()[symbol])


def _assigned(program: code.Program, symbol: Symbol) -> Eq:
    return equality(symbol, program.assigned(symbol))


@EQUATIONS("4.1")
def proportional() -> Eq:
    return term.proportional().equation


@EQUATIONS("4.2")
def saturation() -> Eq:
    return equality(at("u"), term.saturated_by_cases(at("v")))


@EQUATIONS("4.3")
def integral_gain() -> Eq:
    return equality(term.p3, term.integral_tracking().gains[term.p3])


@EQUATIONS("4.4")
def tracking_gain() -> Eq:
    return equality(term.p4, term.integral_tracking().gains[term.p4])


@EQUATIONS("4.5")
def integral() -> Eq:
    return term.integral_tracking().equation


@EQUATIONS("4.6")
def derivative_gain() -> Eq:
    return equality(term.p5, term.derivative().gains[term.p5])


@EQUATIONS("4.7")
def derivative() -> Eq:
    return term.derivative().equation


@EQUATIONS("4.8")
def filter_gain() -> Eq:
    return equality(term.p1, term.low_pass().gains[term.p1])


@EQUATIONS("4.9")
def low_pass() -> Eq:
    return term.low_pass().equation


@EQUATIONS("4.10")
def bumpless_change() -> Eq:
    return keep_p_plus_i()


@EQUATIONS("4.11")
def merged_filter_gain() -> Eq:
    return equality(term.p3, term.filtered_derivative().gains[term.p3])


@EQUATIONS("4.12")
def merged_derivative_gain() -> Eq:
    return equality(term.p24, term.filtered_derivative().gains[term.p24])


@EQUATIONS("4.13")
def filtered_derivative() -> Eq:
    return term.filtered_derivative().equation


@EQUATIONS("4.14")
def derivative_from_state() -> Eq:
    return _assigned(code.merged_state(), code.Df)


@EQUATIONS("4.15")
def state_from_derivative() -> Eq:
    """Written before the output is set: with the values of the sample before."""
    _, known = code.split(code.merged().before[1].value, code.y)
    return equality(code.x, known)


@EQUATIONS("4.16")
def state() -> Eq:
    return _assigned(code.minimal(), code.x)


@EQUATIONS("4.17")
def state_gain() -> Eq:
    return _gain(code.minimal(), code.p4)


@EQUATIONS("4.18")
def setpoint_gain() -> Eq:
    return _gain(code.minimal(), code.p1)


@EQUATIONS("4.19")
def measurement_gain() -> Eq:
    return _gain(code.minimal(), code.p2)


@EQUATIONS("4.20")
def nominal_output() -> Eq:
    return _assigned(code.minimal(), code.v)
