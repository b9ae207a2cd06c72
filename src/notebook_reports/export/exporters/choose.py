"""Executed notebooks to reports: PDF through Typst, HTML that needs no network.

    pdf = export(notebook, "pdf", name="double_tank/03_pole_placement", document="double-tank")

What a report cannot show is an `ExportError` that names the notebook and the cell. The heavy modules are imported
when the first report is made.
"""

import functools
from pathlib import Path
from typing import Any

from notebook_reports.export.around import Around
from notebook_reports.export.errors import ExportError, Problem

FORMATS = ("pdf", "html")

__all__ = ["FORMATS", "ExportError", "Problem", "export"]


def export(
    nb: Any,
    format: str,
    *,
    name: str,
    title: str = "",
    document: str = "",
    chapter: str = "",
    language: str = "en",
    assets: Path | None = None,
    strict_alt: bool = True,
    mode: str = "strict",
    root: Path | None = None,
    code: str = "inline",
    folded: bool = False,
    around: Around | None = None,
) -> bytes:
    """The report of one executed notebook.

    nb: a notebook node of nbformat 4. format: "pdf" or "html". name: "folder/notebook", as errors and links call it.
    title: default the first top heading. document, chapter: for the title block and the running head. assets: the
    folder where relative images are looked up; root: the folder below which they have to lie, default the same.
    strict_alt: a picture without alternative text is an error. mode: "strict", or "mend", which shows a numbered box in
    place of what a page cannot show and lists all of them at its end. code: "inline", "end" or "none". On the screen,
    folded: code is shown to who opens it; around: the ways to the other pages.
    Equal input gives equal bytes. Raises ExportError; ValueError for an unknown format.
    """
    if format not in FORMATS:
        raise ValueError(f"format is one of {', '.join(FORMATS)}, got {format!r}")
    told = {
        "name": name,
        "title": title,
        "document": document,
        "chapter": chapter,
        "language": language,
        "strict_alt": strict_alt,
        "mode": mode,
        "root": root,
        "code": code,
        "folded": folded,
        "around": around,
    }
    metadata = {"name": name.rpartition("/")[2], **({} if assets is None else {"path": str(assets)})}
    output, _ = _exporter(format).from_notebook_node(nb, {"metadata": metadata, "loopbook": told})
    return output.encode() if isinstance(output, str) else output


@functools.cache
def _exporter(format: str) -> Any:
    """One exporter of each format for the whole process: making one costs more than a report."""
    if format == "pdf":
        from notebook_reports.export.exporters.pdf import PdfExporter

        return PdfExporter()
    from notebook_reports.export.exporters.html import HtmlExporter

    return HtmlExporter()
