"""Formulas of the site as MathML, by the press's converter: no script, no network."""

from collections.abc import Callable

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.errors import ExtensionError
from sphinx.writers.html5 import HTML5Translator

from notebook_reports.mathematics import latex_to_mathml
from notebook_reports.mathematics.errors import MathError


def _visit(display: bool) -> Callable[[HTML5Translator, nodes.Element], None]:
    def visit(translator: HTML5Translator, node: nodes.Element) -> None:
        try:
            formula = latex_to_mathml(node.astext().strip(), display=display)
        except MathError as error:
            raise ExtensionError(f"{node.source}:{node.line}: {error}") from error
        translator.body.append(f'<div class="math">{formula}</div>' if display else formula)
        raise nodes.SkipNode

    return visit


def setup(app: Sphinx) -> dict[str, bool]:
    """Sphinx's entry."""
    app.add_html_math_renderer("mathml", (_visit(False), None), (_visit(True), None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
