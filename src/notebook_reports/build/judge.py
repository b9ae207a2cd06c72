"""After the notebooks: is everything printed checked once, does nothing fail, and what moved in the ledger's files?"""

from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field

from notebook_reports.ledger import files as ledger_files
from notebook_reports.ledger import harvest
from notebook_reports.ledger.files import FILES
from notebook_reports.ledger.printed_data import PrintedDataError
from notebook_reports.ledger.row import LedgerRow, of_table
from notebook_reports.ledger.transcribed import printed_documents
from notebook_reports.memory import sealed, stamps
from notebook_reports.memory.hashes import digest, hash_now
from notebook_reports.project import atomic
from notebook_reports.project.failures import Failure
from notebook_reports.project.project import Notebook, Project

MEMORY = "verdict.json"


@dataclass
class Judgement:
    """failures: what fails the build. changes: lines that say what is new or different in the ledger's files."""

    failures: list[Failure] = field(default_factory=list)
    changes: list[str] = field(default_factory=list)


def remembered(project: Project, notebooks: Sequence[Notebook], how: str) -> Judgement | None:
    """The judgement of an earlier build on the very same records, printed data and files; None where there is none."""
    try:
        memory = sealed.read(project.cache / MEMORY)
    except sealed.Damaged:
        return None
    if memory is None or memory.get("key") != _key(project, notebooks, how):
        return None
    return Judgement([Failure(**{**f, "more": tuple(f["more"])}) for f in memory["failures"]])


def judge(
    project: Project,
    notebooks: Sequence[Notebook],
    complete: bool,
    accept: bool = False,
    frozen: bool = False,
) -> Judgement:
    """Judge the records of the notebooks built and bring the ledger's files up to date.

    complete: all notebooks of the project, and all ran; only then can something be missing or gone. accept: write
    moved rows. frozen: write nothing; any difference fails. A failing check leaves its row in the file as it was.
    """
    found = [LedgerRow(**r) for n in notebooks for r in stamps.records(project, n)]
    verdict = Judgement(harvest.failing(found) + harvest.repeated(found))
    if complete:
        verdict.failures += _missing(project, found)
    moved: list[ledger_files.Change] = []
    changes: list[ledger_files.Change] = []
    for table, name in ledger_files.FILES.items():
        path = project.reports / name
        old, rows = ledger_files.read(path, table), of_table(found, table)
        new = ledger_files.keep(old, [r for r in rows if not r.fails], [r for r in rows if r.fails])
        if not complete:
            new = ledger_files.merge(old, new, [n.id for n in notebooks])
        kept, changed = ledger_files.compare(table, old, new)
        stops = [c for c in changed if c.moved or frozen]
        changes += changed
        moved += [] if accept else stops
        if not frozen and (accept or not stops) and (path.exists() or kept):
            content = ledger_files.render(table, kept)
            if not path.exists() or path.read_bytes() != content:
                atomic.write(path, content)
    verdict.changes = [c.line for c in changes if c not in moved]
    verdict.failures += [_moved(c, frozen) for c in moved]
    how = f"{complete} {frozen}"
    remember = {"key": _key(project, notebooks, how), "failures": [asdict(f) for f in verdict.failures]}
    sealed.write(project.cache / MEMORY, remember)
    return verdict


def _missing(project: Project, found: Iterable[LedgerRow]) -> list[Failure]:
    try:
        return harvest.missing(found, printed_documents(project))
    except PrintedDataError as error:
        return [Failure("", f"{project.documents.relative_to(project.root).as_posix()}: {error}", kind="check")]


def _moved(change: "ledger_files.Change", frozen: bool) -> Failure:
    notebook = change.row.notebook
    cure = "commit the file that `loopbook build` writes" if frozen else "if that is right: loopbook build --accept"
    repeat = f"loopbook build {notebook}" if notebook else ""
    return Failure(notebook, f"reports/{FILES[change.table]}: {change.line}", 0, (cure,), repeat, "ledger")


def _key(project: Project, notebooks: Sequence[Notebook], how: str) -> str:
    found = [(n.id, s.records) for n in notebooks if (s := stamps.load(project, n))]
    printed = [hash_now(p) for p in sorted(project.documents.rglob("*.toml"))]
    files = [hash_now(project.reports / name) for name in FILES.values()]
    return digest([how, found, printed, files])
