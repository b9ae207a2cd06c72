"""reports/loopbook.pdf: every executed notebook as a chapter, the solutions of the exercises after all of them, the
ledger and the glossary as the appendix."""

from collections.abc import Sequence
from dataclasses import replace

from notebook_reports.export.book import Chapter, export_book
from notebook_reports.export.page import Page
from notebook_reports.export.read.solutions import ALONE, HEADING, LEFT_OUT, has_solutions
from notebook_reports.memory import stamps
from notebook_reports.project.outline import Outline
from notebook_reports.project.project import Project


def volume(
    project: Project, outline: Outline, front: Sequence[Page], appendix: Sequence[Page], lines: Sequence[str], code: str
) -> bytes:
    """The book. front: before the first chapter. lines: at the foot of the cover. code: where that of each chapter
    stands. Raises ExportError."""
    notebooks = {n.id: n for n in project.notebooks()}
    chapters: list[Chapter] = []
    solved: list[Chapter] = []
    for part in outline.parts:
        for entry in part.entries:
            notebook = notebooks[entry["id"]]
            executed = stamps.executed(project, notebook)
            chapter = Chapter(
                notebook.id,
                executed,
                title=entry["title"],
                part=part.title,
                about=part.about,
                document=part.folder.replace("_", "-"),
                assets=notebook.path.parent,
                root=project.root,
                solutions=LEFT_OUT,
            )
            chapters.append(chapter)
            if has_solutions(executed):
                name, title = f"{notebook.id}/solutions", f"Solutions: {entry['title']}"
                solved.append(replace(chapter, name=name, title=title, part=HEADING, about="", solutions=ALONE))
    return export_book(
        [*chapters, *solved],
        title=outline.title,
        subtitle=outline.subtitle,
        lines=lines,
        front=front,
        appendix=appendix,
        code=code,
        appendix_title="Ledger, glossary, index",
    )
