"""reports/loopbook.pdf: every executed notebook as a chapter, the ledger and the glossary as the appendix."""

from collections.abc import Sequence

from notebook_reports.export.book import Chapter, export_book
from notebook_reports.export.page import Page
from notebook_reports.memory import stamps
from notebook_reports.project.outline import Outline
from notebook_reports.project.project import Project


def volume(
    project: Project, outline: Outline, front: Sequence[Page], appendix: Sequence[Page], lines: Sequence[str], code: str
) -> bytes:
    """The book. front: before the first chapter. lines: at the foot of the cover. code: where that of each chapter
    stands. Raises ExportError."""
    notebooks = {n.id: n for n in project.notebooks()}
    chapters = []
    for part in outline.parts:
        for entry in part.entries:
            notebook = notebooks[entry["id"]]
            chapters.append(
                Chapter(
                    notebook.id,
                    stamps.executed(project, notebook),
                    title=entry["title"],
                    part=part.title,
                    about=part.about,
                    document=part.folder.replace("_", "-"),
                    assets=notebook.path.parent,
                    root=project.root,
                )
            )
    return export_book(
        chapters,
        title=outline.title,
        subtitle=outline.subtitle,
        lines=lines,
        front=front,
        appendix=appendix,
        code=code,
        appendix_title="Ledger, glossary, index",
    )
