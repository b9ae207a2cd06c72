"""The mathematics of a report through the converters, once each; what they refuse names its formula."""

import functools


@functools.lru_cache(maxsize=20_000)
def as_typst(latex: str, display: bool) -> str:
    """Typst mathematics without delimiters."""
    from notebook_reports.mathematics import latex_to_typst

    return latex_to_typst(latex, display)


@functools.lru_cache(maxsize=20_000)
def as_mathml(latex: str, display: bool) -> str:
    """A MathML element."""
    from notebook_reports.mathematics import latex_to_mathml

    return latex_to_mathml(latex, display)


@functools.lru_cache(maxsize=20_000)
def as_text(latex: str) -> str:
    """The formula in characters, as alternative text."""
    from notebook_reports.mathematics import latex_to_text

    return latex_to_text(latex) or "formula"


@functools.lru_cache(maxsize=20_000)
def understood(latex: str) -> bool:
    """Is this a formula by itself?"""
    from notebook_reports.mathematics import MathError

    try:
        as_typst(latex, True)
        as_text(latex)
    except MathError:
        return False
    return True
