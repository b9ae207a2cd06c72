"""The state in which the program starts at rest, and its lines: from the derived program, as text and as functions."""

from collections.abc import Callable
from functools import cache
from typing import Any

from loopbook.lazy import late
from loopbook.printed.store import kept_for, lambda_text, run_text

listing, laws = late("derivations.algebra.listing"), late("derivations.pid.pid_laws")
start, code = late("derivations.programs.start"), late("derivations.programs.pid_code")


@cache
def rest_state() -> Callable[..., tuple[float, float]]:
    """(p_1, p_2, p_3, p_4, y, u) -> (x, I) at rest with the set-point at y, from the derived start state."""
    return run_text(_rest_text(), "math")


@kept_for()
def _rest_text() -> str:
    import sympy

    x, I = _start_expressions()
    letters = sympy.symbols("p_1 p_2 p_3 p_4 y u_0")
    return lambda_text(letters, [x, I.subs({"x": x, "y_sp": sympy.Symbol("y")})], "math")


def _start_expressions() -> list[Any]:
    """x and I (in x) at rest, with the set-point at the measurement, as SymPy expressions in plain symbols."""
    import sympy

    found = []
    for expression in (start.derivative_state(), start.integral_from().subs(start.u_ff, 0)):
        plain = expression.subs({s: sympy.Symbol(s.name) for s in expression.free_symbols})
        found.append(plain.subs({sympy.Symbol(laws.c.name): 0, sympy.Symbol("feedforward"): 0}))
    return found


def start_formulas() -> tuple[str, str]:
    """x and I at rest as program text, for any u, y and set-point.

    >>> start_formulas()
    ('x = p4*y/(1 - p3)', 'I = u - p1*ysp - x + p2*y')
    """
    x, I = _start_texts()
    return x, I


@kept_for()
def _start_texts() -> list[str]:
    import sympy

    x, I = _start_expressions()
    top, below = sympy.fraction(x)
    if below.subs("p_3", 0) < 0:
        top, below = -top, -below
    order = ("u_0", "-p_1*y_sp", "-x", "p_2*y")
    written = listing.written
    terms = sorted(sympy.Add.make_args(I), key=lambda term: order.index(str(term)))
    text = " ".join(f"- {written(-t)}" if t.could_extract_minus_sign() else f"+ {written(t)}" for t in terms)
    return [f"x = {written(top)}/({written(below)})", f"I = {text.removeprefix('+ ').replace('u0', 'u')}"]


@kept_for()
def program_lines() -> list[str]:
    """The lines of pid-report's figure 4.13, with the gains and limits by their names."""
    return code.minimal().listing().splitlines()
