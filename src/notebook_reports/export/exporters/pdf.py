"""The PDF exporter: ``jupyter nbconvert --to loopbook_pdf any.ipynb``.

A notebook is read into a report, the template ``loopbook_pdf`` writes it as Typst source, and the typst package
compiles that in this process to PDF/A-2a and PDF/UA-1. Nothing outside Python is needed.
"""

from typing import Any

from traitlets import default

from notebook_reports.export.code_cells import for_paper
from notebook_reports.export.errors import ExportError
from notebook_reports.export.exporters.base import (
    ReportExporter,
    as_export_error,
    contents_depth,
    problems,
    support_files,
)
from notebook_reports.export.mends import number_mends
from notebook_reports.export.model import Report
from notebook_reports.export.write.arrangement import AS_IT_COMES, Arrangement
from notebook_reports.export.write.mending import Written, compile_mending, mend_formulas
from notebook_reports.export.write.typst import IMPORT, TypstWriter
from notebook_reports.export.write.typst_engine import TypstFailed, compile_settled
from notebook_reports.export.write.typst_text import typst_string


class PdfExporter(ReportExporter):
    """Notebook to PDF. Raises ExportError where the notebook holds what the page cannot show."""

    export_from_notebook = "PDF report (loopbook)"
    output_mimetype = "application/pdf"

    @default("file_extension")
    def _file_extension_default(self) -> str:
        return ".pdf"

    @default("template_extension")
    def _template_extension_default(self) -> str:
        return ".typ.j2"

    @default("template_name")
    def _template_name_default(self) -> str:
        return "loopbook_pdf"

    def report(self, nb: Any, resources: dict[str, Any]) -> Report:
        """The notebook read, its formulas known to be understood. Raises ExportError."""
        report = super().report(nb, resources)
        for_paper(report)
        if self.mended(resources):
            mend_formulas(report, "typst")
            number_mends(report)
        elif found := problems(report, "typst"):
            raise ExportError(report.name, found)
        return report

    def source(self, report: Report, layout: Arrangement = AS_IT_COMES) -> tuple[str, dict[str, bytes]]:
        """The Typst source of a report and the files beside it."""
        text, files, _ = self.written(report, layout)
        return text, files

    def written(self, report: Report, layout: Arrangement = AS_IT_COMES) -> Written:
        """The same, and the tables written, by the names that the engine calls them."""
        writer = TypstWriter(report.name, layout=layout, naming=report.mended)
        told = {"report": report, "depth": contents_depth(report), "writer": writer, "literal": typst_string}
        text = self.template.render(**told, functions=IMPORT)
        return text, {**support_files(), **writer.files}, writer.grids

    def from_notebook_node(self, nb: Any, resources: Any = None, **kw: Any) -> tuple[Any, Any]:
        """The PDF's bytes, and the resources."""
        resources = self._init_resources(resources)
        report = self.report(nb, resources)
        try:
            if self.mended(resources):
                pdf = compile_mending(report, lambda layout: self.written(report, layout))
                self.tell(report, resources)
            else:
                pdf = compile_settled(lambda layout: self.source(report, layout))
        except TypstFailed as error:
            raise as_export_error(error, report.name) from None
        resources["output_extension"] = self.file_extension
        return pdf, resources
