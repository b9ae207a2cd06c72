"""The mathematics of a report through the converters, once each; what they refuse names its formula."""

import functools

from loopbook.pipeline.export.errors import Problem
from loopbook.pipeline.export.model import Display, Math, Report, walk


@functools.lru_cache(maxsize=20_000)
def as_typst(latex: str, display: bool) -> str:
    """Typst mathematics without delimiters."""
    from loopbook.pipeline.mathematics import latex_to_typst

    return latex_to_typst(latex, display)


@functools.lru_cache(maxsize=20_000)
def as_mathml(latex: str, display: bool) -> str:
    """A MathML element."""
    from loopbook.pipeline.mathematics import latex_to_mathml

    return latex_to_mathml(latex, display)


@functools.lru_cache(maxsize=20_000)
def as_text(latex: str) -> str:
    """The formula in characters, as alternative text."""
    from loopbook.pipeline.mathematics import latex_to_text

    return latex_to_text(latex) or "formula"


def problems(report: Report, form: str) -> list[Problem]:
    """Every formula of a report that the converter to "typst" or "mathml" refuses."""
    from loopbook.pipeline.mathematics import MathError

    convert = as_typst if form == "typst" else as_mathml
    found = []
    for cell in report.cells:
        for node in walk(cell):
            if isinstance(node, Math | Display):
                try:
                    convert(node.latex, isinstance(node, Display))
                    as_text(node.latex)
                except MathError as error:
                    found.append(Problem(cell.number, f"a formula: {error}"))
    return found
