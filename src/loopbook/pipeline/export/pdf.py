"""The PDF exporter: ``jupyter nbconvert --to loopbook_pdf any.ipynb``.

A notebook is read into a report, the template ``loopbook_pdf`` writes it as Typst source, and the typst package
compiles that in this process to PDF/A-2a and PDF/UA-1. Nothing outside Python is needed.
"""

import functools
from pathlib import Path
from typing import Any

from nbconvert.exporters.templateexporter import TemplateExporter
from traitlets import Bool, Unicode, default

from loopbook.pipeline.export.errors import ExportError, Problem
from loopbook.pipeline.export.maths import problems
from loopbook.pipeline.export.model import Report
from loopbook.pipeline.export.report import read
from loopbook.pipeline.export.typst_engine import TypstFailed, cell_finder, compile_turning, explain
from loopbook.pipeline.export.typst_text import literal
from loopbook.pipeline.export.typst_writer import IMPORT, TypstWriter

TEMPLATES = Path(__file__).parent / "templates"
CONTENTS_FROM = 3
"""Headings from which on a report has a table of contents."""


class ReportExporter(TemplateExporter):
    """What the PDF and the HTML exporter share: the notebook read into a report, and its particulars.

    `resources["loopbook"]` may hold name, title, document, chapter, language and author; the traits are the defaults.
    """

    document = Unicode("", help="The document a notebook belongs to; equation anchors carry it.").tag(config=True)
    chapter = Unicode("", help="The chapter named in the title block and the running head.").tag(config=True)
    language = Unicode("en", help="Language of the text, for readers and hyphenation.").tag(config=True)
    author = Unicode("loopbook", help="Author in the metadata.").tag(config=True)
    strict_alt = Bool(False, help="Fail where a picture has no alternative text.").tag(config=True)

    export_from_notebook = None

    @default("extra_template_basedirs")
    def _own_templates(self):
        return [str(TEMPLATES)]

    def report(self, nb: Any, resources: dict[str, Any]) -> Report:
        """Read the notebook. Raises ExportError."""
        told = {key: value for key, value in resources.get("loopbook", {}).items() if value != ""}
        metadata = resources.get("metadata") or {}
        particulars = {
            "name": metadata.get("name") or "notebook",
            "document": self.document,
            "chapter": self.chapter,
            "language": self.language,
            "author": self.author,
            "folder": Path(metadata["path"]) if metadata.get("path") is not None else None,
            "strict_alt": self.strict_alt,
        }
        return read(nb, **{**particulars, **told})


@functools.cache
def support_files() -> dict[str, bytes]:
    """The file beside main.typ that is the same for every report."""
    return {"report.typ": (TEMPLATES / "loopbook_pdf" / "report.typ").read_bytes()}


def contents_depth(report: Report) -> int:
    """How many levels of headings the table of contents shows; 0 for none."""
    levels = [heading.level for heading in report.headings]
    if len(levels) < CONTENTS_FROM:
        return 0
    return 2 if sum(level <= 2 for level in levels) <= 30 else 1


class PdfExporter(ReportExporter):
    """Notebook to PDF. Raises ExportError where the notebook holds what the page cannot show."""

    export_from_notebook = "PDF report (loopbook)"
    output_mimetype = "application/pdf"

    @default("file_extension")
    def _file_extension_default(self):
        return ".pdf"

    @default("template_extension")
    def _template_extension_default(self):
        return ".typ.j2"

    @default("template_name")
    def _template_name_default(self):
        return "loopbook_pdf"

    def report(self, nb: Any, resources: dict[str, Any]) -> Report:
        """The notebook read, its formulas known to be understood. Raises ExportError."""
        report = super().report(nb, resources)
        found = problems(report, "typst")
        if found:
            raise ExportError(report.name, found)
        return report

    def source(self, report: Report, turned: frozenset[str] = frozenset()) -> tuple[str, dict[str, bytes]]:
        """The Typst source of a report and the files beside it. turned: tables that get a landscape page."""
        writer = TypstWriter(report.name, turned=turned)
        told = {"report": report, "depth": contents_depth(report), "writer": writer, "literal": literal}
        text = self.template.render(**told, functions=IMPORT)
        return text, {**support_files(), **writer.files}

    def from_notebook_node(self, nb, resources=None, **kw):
        """The PDF's bytes, and the resources."""
        resources = self._init_resources(resources)
        report = self.report(nb, resources)
        try:
            pdf = compile_turning(lambda turned: self.source(report, turned))
        except TypstFailed as error:
            raise as_export_error(error, report.name) from None
        resources["output_extension"] = self.file_extension
        return pdf, resources


def as_export_error(error: TypstFailed, name: str) -> ExportError:
    """The engine's complaints as problems of cells, each once."""
    find = cell_finder(error.source, error.files)
    explained = dict.fromkeys(explain(diagnostic, find) for diagnostic in error.diagnostics)
    return ExportError(name, [Problem(cell, text) for cell, text in explained])
