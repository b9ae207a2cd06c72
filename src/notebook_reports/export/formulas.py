"""The mathematics of a report through the converters, once each; what they refuse names its formula."""

import functools

from notebook_reports.mathematics import MathError, latex_to_mathml, latex_to_text, latex_to_typst


@functools.lru_cache(maxsize=20_000)
def as_typst(latex: str, display: bool) -> str:
    """Typst mathematics without delimiters."""
    return latex_to_typst(latex, display)


@functools.lru_cache(maxsize=20_000)
def as_mathml(latex: str, display: bool) -> str:
    """A MathML element."""
    return latex_to_mathml(latex, display)


@functools.lru_cache(maxsize=20_000)
def as_text(latex: str) -> str:
    """The formula in characters, as alternative text."""
    return latex_to_text(latex) or "formula"


@functools.lru_cache(maxsize=20_000)
def understood(latex: str) -> bool:
    """Is this a formula by itself?"""
    try:
        as_typst(latex, True)
        as_text(latex)
    except MathError:
        return False
    return True
