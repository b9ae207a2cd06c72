"""After the notebooks: the map, the ledger to be read, and the book, where something they show has changed.

``notebooks/book.toml`` says that a project has them and in which order; without it there are none. Light: what takes
time is imported when there is something to write.
"""

import platform
import time
from dataclasses import replace
from importlib.metadata import PackageNotFoundError, version
from typing import Any

from notebook_reports.export.errors import ExportError
from notebook_reports.ledger import files as ledger_files
from notebook_reports.ledger.coverage import coverage
from notebook_reports.ledger.glossary import terms
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.ledger.transcribed import printed_documents
from notebook_reports.memory import fingerprint, sealed, stamps
from notebook_reports.memory.hashes import hash_file, hash_now, of_bytes
from notebook_reports.memory.manifest import manifest
from notebook_reports.pages import ledger_page as ledger
from notebook_reports.pages import offered
from notebook_reports.pages.links import dead_links
from notebook_reports.pages.medium import PAPER, SCREEN
from notebook_reports.pages.preface import preface
from notebook_reports.project import atomic
from notebook_reports.project.console import Console, because
from notebook_reports.project.failures import Failure
from notebook_reports.project.outline import FILE, pages_of, read_outline
from notebook_reports.project.project import FORMATS, Notebook, Project, UsageError
from notebook_reports.run.quick_imports import import_nbformat

BOOK, LEDGER, INDEX = NAMES = ("loopbook.pdf", "ledger.html", "index.html")
STAMP = "pages.json"
VERSIONS = ("loopbook", "papermill", "nbconvert", "typst", "sympy", "numpy", "scipy", "control", "matplotlib")


def publishes(project: Project, complete: bool, formats: tuple[str, ...]) -> bool:
    """Does this build write the pages: one of all notebooks, in all formats, of a project that has a book."""
    return complete and set(FORMATS) <= set(formats) and (project.notebooks_folder / FILE).exists()


def reasons(project: Project, code: str = "") -> list[str]:
    """Why the pages have to be written; none where they are as they should be. code: see `publish`."""
    stamp = _stamp(project)
    gone = [n for n in (*NAMES, *pages_of(project)) if stamp and hash_now(project.reports / n) != stamp["files"].get(n)]
    if gone:
        return [f"reports/{name} is not as it was written" for name in gone]
    return fingerprint.differences(stamp["prints"] if stamp else None, _prints(project, code))


def publish(project: Project, console: Console, code: str = "") -> list[Failure]:
    """Write the pages, all or none. What fails is returned by the name of the notebook or the link, and then the old
    pages are gone too: they would show another build. code: where the book has its code, "" for what book.toml says.
    """
    try:
        why = reasons(project, code)
    except UsageError as error:
        withdraw(project)
        return [Failure("", str(error), kind="export", repeat="loopbook build")]
    if not why:
        return []
    began = time.monotonic()
    prints = _prints(project, code)
    missing = [n.id for n in project.notebooks() if not _built(project, n)]
    if missing:
        withdraw(project)
        console.line(f"no {', '.join(NAMES)}: not built {', '.join(missing)}")
        return []
    try:
        made, failures = _make(project, code)
    except (UsageError, ValueError) as error:
        made, failures = {}, [Failure("", str(error), kind="export", repeat="loopbook build")]
    if failures:
        withdraw(project)
        return failures
    before = _stamp(project)
    for name in set(before["files"] if before else ()) - set(made):
        atomic.remove(project.reports / name)
    for name, content in made.items():
        atomic.write(project.reports / name, content)
    files = {name: of_bytes(content) for name, content in made.items()}
    sealed.write(project.cache / STAMP, {"prints": prints, "files": files})
    words = ["ok  ", f"reports/{', '.join(made)}", f"{time.monotonic() - began:.1f} s", because(why, True)]
    console.line("  ".join(w for w in words if w))
    return []


def withdraw(project: Project) -> None:
    """Remove the pages."""
    stamp = _stamp(project)
    atomic.clear(project.cache / STAMP, also_files=True)
    for name in dict.fromkeys((*NAMES, *(stamp["files"] if stamp else ()))):
        atomic.remove(project.reports / name)


def versions() -> dict[str, str]:
    """What wrote the pages."""
    found = {"Python": platform.python_version()}
    for name in VERSIONS:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def _make(project: Project, code: str) -> tuple[dict[str, bytes], list[Failure]]:
    """The content of the three files, or why there is none. Raises UsageError for an outline that does not fit."""
    import_nbformat()
    from notebook_reports.pages import screen
    from notebook_reports.pages.volume import volume

    entries = manifest(project)
    outline = read_outline(project, entries)
    found = [LedgerRow(**record) for entry in outline.entries for record in entry["records"]]
    counts = coverage(printed_documents(project), found)
    glossary = project.documents / "glossary.toml"
    words = terms(glossary) if glossary.exists() else ()
    tools = versions()
    made: dict[str, bytes] = {}
    try:
        titles = {entry["id"]: entry["title"] for entry in outline.entries}
        numbered = {id: f"{number}  {title}" for number, (id, title) in enumerate(titles.items(), start=1)}
        names = {part.folder.replace("_", "-"): part.title for part in outline.parts}
        paper, on_the_screen = replace(PAPER, names=names), replace(SCREEN, names=names)
        front = [preface(paper, counts)]
        appendix = ledger.pages(paper, counts, found, words, numbered)
        built = "Made with " + ", ".join(f"{name} {number}" for name, number in tools.items())
        lines = [*ledger.sentences(counts), ledger.errors(found), built]
        made[BOOK] = volume(project, outline, front, appendix, lines, code or outline.code)
        on_screen = ledger.pages(on_the_screen, counts, found, words, titles)
        extra = offered.made(outline.pages, NAMES)
        made |= {page.name: page.text.encode() for page in extra}
        made[LEDGER] = screen.ledger_page(on_screen, outline.title)
    except ExportError as error:
        repeat = f"loopbook build {error.notebook}" if "/" in error.notebook else "loopbook build"
        return {}, [
            Failure(error.notebook, f"the book: {p.text}", p.cell or 0, repeat=repeat, kind="export")
            for p in error.problems
        ]
    executed = {n.id: stamps.executed(project, n) for n in project.notebooks()}
    sizes = {name: len(content) for name, content in made.items()}
    files = [*(n for entry in entries for n in entry["reports"].values()), *ledger_files.FILES.values()]
    sizes |= {name: (project.reports / name).stat().st_size for name in files if (project.reports / name).exists()}
    made[INDEX] = screen.index_page(outline, counts, found, executed, [p.title for p in on_screen], tools, sizes, extra)
    dead = [(name, line) for name in (LEDGER, INDEX) for line in dead_links(name, project.reports, made)]
    return made, [Failure("", f"reports/{name}: {line}", kind="export", repeat="loopbook build") for name, line in dead]


def _built(project: Project, notebook: Notebook) -> bool:
    reports = (project.reports / f"{notebook.id}.{format}" for format in FORMATS)
    return stamps.load(project, notebook) is not None and all(path.exists() for path in reports)


def _stamp(project: Project) -> dict[str, Any] | None:
    try:
        stamp = sealed.read(project.cache / STAMP)
    except sealed.Damaged:
        return None
    return stamp if stamp and {"prints", "files"} <= set(stamp) else None


def _prints(project: Project, code: str) -> fingerprint.Prints:
    """What the pages depend on: executed notebooks, what stands beside them, printed data, the code, the versions."""
    prints = {"--code": code}
    for notebook in project.notebooks():
        prints[notebook.id] = hash_now(stamps.executed_path(project, notebook))
    beside = (p for p in project.notebooks_folder.rglob("*") if p.is_file() and p.suffix != ".ipynb")
    for path in sorted((*beside, *project.documents.rglob("*.toml"))):
        prints[path.relative_to(project.root).as_posix()] = hash_file(path)
    prints |= offered.print_of(pages_of(project))
    return {**prints, **fingerprint.of_pages(), **fingerprint.environment(project)}
