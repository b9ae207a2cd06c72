"""Where the code of a report stands: in its place, at the end, or nowhere."""

from notebook_reports.export.model import Block, Heading, Link, Paragraph, Report, ReportCell, Text, Verbatim, plain

INLINE, END, NONE = CODE = ("inline", "end", "none")
TITLE = "The code"


def place_code(report: Report, where: str, level: int = 1, number: str = "") -> None:
    """Leave the code in its place, gather it in a last section with a line for each section it comes from, or drop it.

    level, number: of the heading of the last section.
    """
    if where == INLINE:
        return
    gathered: list[Block] = []
    section: Heading | None = None
    told: Heading | None = None
    for cell in report.cells:
        for block in cell.blocks:
            section = block if isinstance(block, Heading) else section
            if isinstance(block, Verbatim) and block.role == "input":
                if section is not told and section is not None:
                    gathered.append(_of(section))
                    told = section
                gathered.append(block)
        _keep(report, cell, [b for b in cell.blocks if not (isinstance(b, Verbatim) and b.role == "input")])
    if where == END and gathered:
        heading = Heading(level, [Text(TITLE)], _free(report), number)
        report.anchors.add(heading.anchor)
        report.cells.append(ReportCell(0, [heading, *gathered]))


def for_paper(report: Report) -> None:
    """Drop the code that is shown only to who asks for it."""
    for cell in report.cells:
        _keep(report, cell, [b for b in cell.blocks if not (isinstance(b, Verbatim) and b.folded)])


def _keep(report: Report, cell: ReportCell, blocks: list[Block]) -> None:
    """A cell of which nothing is left is no place to link to."""
    if not blocks and cell.anchor:
        report.anchors.discard(cell.anchor)
        cell.anchor = ""
    cell.blocks = blocks


def _of(section: Heading) -> Paragraph:
    words = f"{section.number} {plain(section.children)}".strip()
    return Paragraph([Link(f"#{section.anchor}", [Text(words)], "internal", section.anchor)], leads=True)


def _free(report: Report) -> str:
    """An anchor that the report does not have."""
    name = "the-code"
    while name in report.anchors:
        name += "-"
    return name
