"""Numbered equations: the derived form under the document's number, and the printed form to compare it with.

``eq("pid-report", "4.9")`` shows the derived equation. Where the printed data holds a claim ``eq-4.9`` with the printed
formula between backticks, ``agrees`` says whether the two are the same mathematics.

Printed formulas are plain text: ``y[k-1]`` is a sample, names drop underscores, ``saturate(v, low, high)`` limits.
"""

import re
from importlib import import_module
from typing import Any

from loopbook.documents import open as documents
from notebook_reports.display import Equation, equation

_SAMPLE = re.compile(r"\b([A-Za-z]\w*)\[k([+-]\d)?\]")


class EquationError(LookupError):
    """No equation has the label that was asked for; the message names the document and the nearest labels."""


def _labels(document: str):
    if document not in documents.names():
        raise EquationError(f"unknown document {document!r}; one of {', '.join(documents.names())}")
    name = f"loopbook.documents.{document.replace('-', '_')}.equations"
    try:
        return import_module(name).EQUATIONS
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
        raise EquationError(f"{document} has no numbered derived equations ({name} does not exist)") from None


def derived(document: str, label: str) -> Any:
    """The derived equation (a SymPy equality) that carries a number; EquationError where there is none."""
    try:
        return _labels(document)[label]
    except KeyError as error:
        raise EquationError(error.args[0]) from None


def eq(document: str, label: str) -> Equation:
    """Show the derived equation under the document's number.

    >>> eq("pid-report", "4.8").latex
    'p_{1} = \\\\frac{T_{f}}{T_{f} + h}'
    """
    return equation(derived(document, label), label, document)


def printed(document: str, label: str) -> Any:
    """The printed equation, read from the backticks of the claim ``eq-<label>``, in the derived one's symbols.

    Raises EquationError where there is no such claim or the text uses a name that the derived equation has not.
    """
    claims = documents.printed(document).claims
    if f"eq-{label}" not in claims:
        raise EquationError(f"{document}: the printed data has no claim eq-{label}")
    return read(claims[f"eq-{label}"].says.split("`")[1], derived(document, label))


def read(text: str, like: Any) -> Any:
    """Text ``left = right`` as an equality in the symbols and samples of another equality."""
    import sympy
    from sympy.core.function import AppliedUndef

    samples = {(f.func.__name__.replace("_", ""), str(f.args[0])): f for f in like.atoms(AppliedUndef)}
    known = {s.name.replace("_", ""): s for s in like.free_symbols if not s.name.startswith("t_")}

    def sample(match: re.Match) -> str:
        name, shift = match[1], match[2] or ""
        instant = f"t_{{k{shift}}}" if shift else "t_k"
        if (name, instant) not in samples:
            raise EquationError(f"{text!r}: {match[0]} is not in the derived equation {like}")
        placeholder = f"sample_{len(known)}"
        known[placeholder] = samples[name, instant]
        return placeholder

    sides = [_SAMPLE.sub(sample, side) for side in text.split(" = ", 1)]
    known["saturate"] = lambda value, low, high: sympy.Piecewise(
        (high, value > high), (low, value < low), (value, True)
    )
    left, right = (sympy.sympify(side, locals=known, rational=True) for side in sides)
    strange = {s.name for s in (left.free_symbols | right.free_symbols)} - {
        s.name for s in like.free_symbols | {a for f in samples.values() for a in f.args}
    }
    if strange:
        raise EquationError(f"{text!r}: {', '.join(sorted(strange))} is not in the derived equation {like}")
    return sympy.Eq(left, right, evaluate=False)


def agrees(document: str, label: str) -> bool:
    """Is the printed equation the derived one? Their difference must vanish."""
    from derivations.algebra.rational import vanishes

    one = derived(document, label)
    try:
        other = printed(document, label)
    except EquationError as error:
        if "is not in the derived equation" in str(error):
            return False
        raise
    return one.lhs == other.lhs and vanishes(one.rhs - other.rhs)


def plain(equality: Any) -> str:
    """A derived equation in the notation of the printed ones.

    >>> plain(derived("pid-report", "4.9"))
    'yf[k] = (1 - p1)*y[k] + p1*yf[k-1]'
    """
    from derivations.algebra.listing import written

    text = f"{written(equality.lhs)} = {written(equality.rhs)}"
    return re.sub(r"\(t\{?k([+-]\d)?\}?\)", lambda match: f"[k{match[1] or ''}]", text)


def comparisons(document: str, *labels: str) -> dict[str, tuple[bool, str]]:
    """For each number the claim ``eq-<number>``: does the print agree, and the derived form as evidence."""
    return {f"eq-{n}": (agrees(document, n), f"derived: `{plain(derived(document, n))}`") for n in labels}
