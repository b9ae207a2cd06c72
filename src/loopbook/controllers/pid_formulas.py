"""The law of a PID controller with its numbers, in LaTeX, as each form writes it."""

import math

from loopbook.numerics import polynomial_text


def _error(weight: float) -> str:
    """weight r - y."""
    if weight == 0:
        return "(-y)"
    return "(r - y)" if weight == 1 else rf"({polynomial_text.number(weight)} r - y)"


def _factor(value: float) -> str:
    return "" if value == 1 else f"{polynomial_text.number(value)} "


def _rate(D: float, Tf: float) -> str:
    """D s/(1 + s Tf)."""
    above = f"{_factor(D)}s"
    return rf"\frac{{{above}}}{{1 + {_factor(Tf)}s}}" if Tf else above


def _joined(terms: list[str]) -> str:
    text = terms[0] if terms else "0"
    for term in terms[1:]:
        text += f" - {term[1:]}" if term.startswith("-") else f" + {term}"
    return text


def parallel_formula(P: float, I: float, D: float, Tf: float, b: float, c: float) -> str:
    """P (b r - y) + I/s (r - y) + D s/(1 + s Tf) (c r - y), without the parts that are zero.

    >>> parallel_formula(2.0, 0.5, 0.0, 0.0, 1.0, 0.0)
    'u = 2 (r - y) + \\\\frac{0.5}{s} (r - y)'
    """
    terms = [f"{_factor(P)}{_error(b)}"] if P else []
    terms += [rf"\frac{{{polynomial_text.number(I)}}}{{s}} (r - y)"] if I else []
    terms += [f"{_rate(D, Tf)} {_error(c)}"] if D else []
    return f"u = {_joined(terms)}"


def standard_formula(K: float, Ti: float, Td: float, Tf: float, b: float, c: float) -> str:
    """K (b r - y + (r - y)/(s Ti) + s Td/(1 + s Tf) (c r - y)), without the parts that are switched off.

    >>> standard_formula(2.0, 4.0, 0.0, 0.0, 0.5, 0.0)
    'u = 2 \\\\left[(0.5 r - y) + \\\\frac{1}{4 s} (r - y)\\\\right]'
    """
    terms = [_error(b)]
    terms += [] if math.isinf(Ti) else [rf"\frac{{1}}{{{_factor(Ti)}s}} (r - y)"]
    terms += [f"{_rate(Td, Tf)} {_error(c)}"] if Td else []
    if len(terms) == 1:
        return f"u = {_factor(K)}{terms[0]}"
    return rf"u = {_factor(K)}\left[{_joined(terms)}\right]"


def series_formula(K: float, Ti: float, Td: float, Tf: float) -> str:
    """K (1 + 1/(s Ti)) (1 + s Td/(1 + s Tf)) (r - y).

    >>> series_formula(2.0, 4.0, 1.0, 0.1)
    'u = 2 \\\\left(1 + \\\\frac{1}{4 s}\\\\right) \\\\left(1 + \\\\frac{s}{1 + 0.1 s}\\\\right) (r - y)'
    """
    parts = [] if math.isinf(Ti) else [rf"\left(1 + \frac{{1}}{{{_factor(Ti)}s}}\right)"]
    parts += [rf"\left(1 + {_rate(Td, Tf)}\right)"] if Td else []
    return f"u = {_factor(K)}{' '.join([*parts, '(r - y)'])}"
