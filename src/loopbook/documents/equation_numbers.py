"""Numbered equations: the derived form under the document's number, and the printed form to compare it with.

``eq("pid-report", "4.9")`` shows the derived equation. Where the printed data holds a claim ``eq-4.9`` with the printed
formula between backticks, ``agrees`` says whether the two are the same mathematics.

Printed formulas are plain text: ``y[k-1]`` is a sample, names drop underscores, ``saturate(v, low, high)`` limits.
"""

import re
from importlib import import_module

from sympy import Eq, Expr
from sympy.core.function import AppliedUndef

from derivations.algebra.listing import written
from derivations.algebra.rational import vanishes
from derivations.errors import LoopbookError
from loopbook.documents import open as documents
from loopbook.documents.labels import Labels
from loopbook.documents.printed_formulas import saturate
from notebook_reports.display import Equation, equation
from notebook_reports.formula.read import FormulaError, UnknownName, read_equations


class EquationError(LoopbookError, LookupError):
    """No equation has the label that was asked for; the message names the document and the nearest labels."""


def _labels(document: str) -> Labels:
    if document not in documents.names():
        raise EquationError(f"unknown document {document!r}; one of {', '.join(documents.names())}")
    name = f"loopbook.documents.{document.replace('-', '_')}.equations"
    try:
        return import_module(name).EQUATIONS
    except ModuleNotFoundError as error:
        if error.name != name:
            raise
        raise EquationError(f"{document} has no numbered derived equations ({name} does not exist)") from None


def derived(document: str, label: str) -> Eq:
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


def printed(document: str, label: str) -> Eq:
    """The printed equation, read from the backticks of the claim ``eq-<label>``, in the derived one's symbols.

    Raises EquationError where there is no such claim, UnknownName where it uses a name that the derived equation has
    not.
    """
    claims = documents.printed(document).claims
    if f"eq-{label}" not in claims:
        raise EquationError(f"{document}: the printed data has no claim eq-{label}")
    claim = claims[f"eq-{label}"]
    return read(claim.formula, derived(document, label), claim.where)


def read(text: str, like: Eq, where: str = "") -> Eq:
    """Text ``left = right`` as an equality in the symbols and samples of another equality; FormulaError."""
    samples = {(f.func.__name__.replace("_", ""), str(f.args[0])): f for f in like.atoms(AppliedUndef)}
    names = {s.name.replace("_", ""): s for s in like.free_symbols if not s.name.startswith("t_")}

    def sample(name: str, shift: int) -> Expr:
        return samples[name, f"t_{{k{shift:+d}}}" if shift else "t_k"]

    (left, right), *more = read_equations(text, names, {"saturate": saturate}, samples=sample, where=where)
    if more or right is None:
        raise FormulaError("one equation left = right is expected", text, 0, where)
    return Eq(left, right, evaluate=False)


def agrees(document: str, label: str) -> bool:
    """Is the printed equation the derived one? Their difference must vanish."""
    one = derived(document, label)
    try:
        other = printed(document, label)
    except UnknownName:
        return False
    return bool(one.lhs == other.lhs and vanishes(one.rhs - other.rhs))


def plain(equality: Eq) -> str:
    """A derived equation in the notation of the printed ones.

    >>> plain(derived("pid-report", "4.9"))
    'yf[k] = (1 - p1)*y[k] + p1*yf[k-1]'
    """
    text = f"{written(equality.lhs)} = {written(equality.rhs)}"
    return re.sub(r"\(t\{?k([+-]\d)?\}?\)", lambda match: f"[k{match[1] or ''}]", text)


def comparisons(document: str, *labels: str) -> dict[str, tuple[bool, str]]:
    """For each number the claim ``eq-<number>``: does the print agree, and the derived form as evidence."""
    return {f"eq-{n}": (agrees(document, n), f"derived: `{plain(derived(document, n))}`") for n in labels}
