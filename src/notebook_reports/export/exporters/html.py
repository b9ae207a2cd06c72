"""The HTML exporter: ``jupyter nbconvert --to loopbook_html any.ipynb``.

One file, complete in itself: mathematics as MathML, drawings and styles inside, no script, nothing fetched; light or
dark as the reader's system asks, and as narrow as a phone.
"""

import functools
from html import escape
from typing import Any

from traitlets import default

from notebook_reports.export.errors import ExportError
from notebook_reports.export.exporters.base import CONTENTS_FROM, TEMPLATES, ReportExporter, problems
from notebook_reports.export.mends import number_mends
from notebook_reports.export.model import Heading, Report, words_only
from notebook_reports.export.write.html import HtmlWriter
from notebook_reports.export.write.html_sections import sections
from notebook_reports.export.write.mathematics_font import font_face
from notebook_reports.export.write.mending import mend_formulas


@functools.cache
def style_sheet() -> str:
    """The styles of every report."""
    return (TEMPLATES / "loopbook_html" / "style.css").read_text(encoding="utf-8")


def contents(report: Report, writer: HtmlWriter) -> str:
    """The table of contents as nested lists, or nothing for a short report."""
    headings = [heading for heading in report.headings if heading.level <= 2]
    if len(report.headings) < CONTENTS_FROM:
        return ""

    def entry(heading: Heading) -> str:
        number = f'<span class="number">{heading.number}</span> ' if heading.number else ""
        return f'<a href="#{escape(heading.anchor)}">{number}{writer.inline(words_only(heading.children))}</a>'

    parts, depth = [], 0
    for heading in headings:
        while depth < heading.level:
            parts.append("<ul><li>")
            depth += 1
            fresh = True
        if not fresh:
            parts.append("</li></ul>" * (depth - heading.level) + "</li><li>")
            depth = heading.level
        parts.append(entry(heading))
        fresh = False
    return "".join(parts) + "</li></ul>" * depth


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
        text = self.render(report)
        resources["output_extension"] = self.file_extension
        return text, resources

    def render(self, report: Report) -> str:
        """A report that is read, as one page. Raises ExportError."""
        found = problems(report, "mathml")
        if found:
            raise ExportError(report.name, found)
        writer = HtmlWriter(report.name)
        page: dict[str, Any] = {
            "report": report,
            "writer": writer,
            "style": style_sheet(),
            "contents": contents(report, HtmlWriter(report.name)),
            "escape": escape,
            "sections": sections,
        }
        text = self.template.render(**page)
        return text.replace("<style>\n", f"<style>\n{face}\n", 1) if (face := font_face(text)) else text
