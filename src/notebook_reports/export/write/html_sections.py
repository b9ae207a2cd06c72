"""The cells of a report as HTML, the sections folded that are to be opened when asked."""

from dataclasses import replace

from notebook_reports.export.model import Heading, ReportCell
from notebook_reports.export.write.html import HtmlWriter


def sections(writer: HtmlWriter, cells: list[ReportCell]) -> str:
    """The cells that hold something; a folded section, up to the next heading of its level, behind its heading.

    A link into a folded section opens it; on paper it stands open.
    """
    parts: list[str] = []
    levels: list[int] = []  # of the folded sections that are open here
    for cell in (cell for cell in cells if cell.blocks):
        highest = min((block.level for block in cell.blocks if isinstance(block, Heading)), default=7)
        while levels and highest <= levels[-1]:
            levels.pop()
            parts.append("</details>")
        first = cell.blocks[0]
        if cell.folded and isinstance(first, Heading):
            levels.append(first.level)
            parts.append(f'<details class="section"><summary>{writer.heading(first)}</summary>')
            cell = replace(cell, blocks=cell.blocks[1:])
        parts += [writer.report_cell(cell)] if cell.blocks else []
    return "\n".join([*parts, *("</details>" for _ in levels)])
