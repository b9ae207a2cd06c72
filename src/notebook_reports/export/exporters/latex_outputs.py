"""Outputs in forms that nbconvert's LaTeX template can show: tables as Markdown, drawings as PDF, captions as text."""

import base64
import re
from typing import Any

from nbconvert.preprocessors import Preprocessor
from nbconvert.preprocessors.convertfigures import ConvertFiguresPreprocessor
from nbformat.v4 import new_output
from traitlets import default

from notebook_reports.display import FIGURE_MIME, TABLE_MIME
from notebook_reports.export.write.svg_fonts import with_known_fonts
from notebook_reports.export.write.typst_engine import picture_pdf

WIDEST = 45
"""Characters of a column beyond which it gets no more of the page."""


class DrawingsToPdf(ConvertFiguresPreprocessor):
    """SVG outputs as PDF, which TeX can include; nbconvert would ask for Inkscape."""

    @default("from_format")
    def _from_format_default(self):
        return "image/svg+xml"

    @default("to_format")
    def _to_format_default(self):
        return "application/pdf"

    def convert_figure(self, data_format: str, data: str) -> str:
        """The drawing as PDF in base64."""
        return base64.b64encode(picture_pdf(with_known_fonts(data.encode()))).decode()


class TablesToMarkdown(Preprocessor):
    """Tables as pandoc's pipe tables, and the caption of a figure below it."""

    def preprocess_cell(self, cell: Any, resources: Any, index: int) -> tuple[Any, Any]:
        """A cell with what its outputs lack."""
        shown = []
        for output in cell.get("outputs", []):
            data = output.get("data", {})
            shown.append(output)
            if TABLE_MIME in data:
                output.data["text/markdown"] = pipe_table(data[TABLE_MIME])
            elif FIGURE_MIME in data:
                shown.append(new_output("display_data", {"text/markdown": data[FIGURE_MIME]["caption"]}))
        if shown:
            cell.outputs = shown
        return cell, resources


def pipe_table(data: dict[str, Any]) -> str:
    """A table as pandoc reads it; dashes say how columns share the page.

    >>> print(pipe_table({"columns": ["a", "b"], "rows": [["x", "1"]], "align": ["left", "right"]}))
    | a | b |
    |:---|---:|
    | x | 1 |
    <BLANKLINE>
    """
    rows = [[_cell(text) for text in row] for row in (data["columns"], *data["rows"])]
    rules = []
    for x, align in enumerate(data["align"]):
        word = max(len(word) for row in rows for word in row[x].split() or [""])
        dashes = "-" * max(word + 3, min(WIDEST, max(len(row[x]) for row in rows)))
        rules.append({"left": f":{dashes[1:]}", "right": f"{dashes[1:]}:", "center": f":{dashes[2:] or '-'}:"}[align])
    head, *body = (f"| {' | '.join(row)} |" for row in rows)
    caption = [f"\n: {data['caption']}"] if data.get("caption") else []
    notes = [f"\n{note}" for note in data.get("notes", ())]
    return "\n".join([head, f"|{'|'.join(rules)}|", *body, *caption, *notes, ""])


def _cell(text: str) -> str:
    """Inline text whose bars do not end the cell, in mathematics and elsewhere."""
    parts = re.split(r"(\$[^$]*\$)", text.replace("\n", " "))
    return "".join(p.replace("|", r"\vert ") if p.startswith("$") else p.replace("|", r"\|") for p in parts)
