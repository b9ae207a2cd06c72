"""The HTML exporter: ``jupyter nbconvert --to loopbook_html any.ipynb``.

One file, complete in itself: mathematics as MathML, drawings and styles inside, no script, nothing fetched; light or
dark as the reader's system asks, and as narrow as a phone.
"""

import functools
from html import escape
from typing import Any

from traitlets import default

from notebook_reports.export.around import Around, Tools
from notebook_reports.export.errors import ExportError
from notebook_reports.export.exporters.base import CONTENTS_FROM, TEMPLATES, ReportExporter, problems
from notebook_reports.export.mends import number_mends
from notebook_reports.export.model import Report
from notebook_reports.export.write.html import HtmlWriter
from notebook_reports.export.write.html_frame import bar, contents, onward
from notebook_reports.export.write.html_sections import sections
from notebook_reports.export.write.mathematics_font import font_face
from notebook_reports.export.write.mending import mend_formulas


@functools.cache
def page_script() -> str:
    """The script of every report: copy buttons, all code at once, where the reader is."""
    return (TEMPLATES / "loopbook_html" / "page.js").read_text(encoding="utf-8")


@functools.cache
def style_sheet() -> str:
    """The styles of every report."""
    return (TEMPLATES / "loopbook_html" / "style.css").read_text(encoding="utf-8")


class HtmlExporter(ReportExporter):
    """Notebook to one HTML file. Raises ExportError where the notebook holds what the page cannot show."""

    export_from_notebook = "HTML report (loopbook)"
    output_mimetype = "text/html"

    @default("file_extension")
    def _file_extension_default(self) -> str:
        return ".html"

    @default("template_name")
    def _template_name_default(self) -> str:
        return "loopbook_html"

    def from_notebook_node(self, nb: Any, resources: Any = None, **kw: Any) -> tuple[Any, Any]:
        """The HTML text, and the resources."""
        resources = self._init_resources(resources)
        report = self.report(nb, resources)
        if self.mended(resources):
            mend_formulas(report, "mathml")
            number_mends(report)
            self.tell(report, resources)
        told = resources.get("loopbook", {})
        text = self.render(report, told.get("around"), told.get("folded", self.folded))
        resources["output_extension"] = self.file_extension
        return text, resources

    def render(
        self, report: Report, around: Around | None = None, folded: bool = False, tools: Tools | None = None
    ) -> str:
        """A report that is read, as one page. tools: of this page alone. Raises ExportError."""
        found = problems(report, "mathml")
        if found:
            raise ExportError(report.name, found)
        writer = HtmlWriter(report.name, folded=folded)
        has_contents = len(report.headings) >= CONTENTS_FROM
        page: dict[str, Any] = {
            "report": report,
            "writer": writer,
            "style": style_sheet(),
            "bar": bar(around, has_contents),
            "contents": contents(report) if has_contents else "",
            "onward": onward(around),
            "tools": tools,
            "page_script": page_script(),
            "escape": escape,
            "sections": sections,
        }
        text = self.template.render(**page)
        return text.replace("<style>\n", f"<style>\n{face}\n", 1) if (face := font_face(text)) else text
