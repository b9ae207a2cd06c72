"""After the notebooks: is everything printed checked once, does nothing fail, and what moved in the ledger's files?"""

import json
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass, field

from notebook_reports.ledger.transcribed import printed_documents
from notebook_reports.memory import fingerprint, stamps
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
        memory = json.loads((project.cache / MEMORY).read_bytes())
    except (OSError, ValueError):
        return None
    if memory.get("key") != _key(project, notebooks, how):
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
    from notebook_reports.ledger import files as ledger_files
    from notebook_reports.ledger import harvest

    found = [harvest.Found(**r) for n in notebooks for r in stamps.load_records(project, n)]
    verdict = Judgement(harvest.failing(found) + harvest.repeated(found))
    if complete:
        verdict.failures += _missing(project, found)
    moved: list[ledger_files.Change] = []
    changes: list[ledger_files.Change] = []
    for table, name in ledger_files.FILES.items():
        path = project.reports / name
        old = ledger_files.read(path)
        new = ledger_files.rows([r for r in found if not r.fails], table)
        new = ledger_files.keep(old, new, [r for r in found if r.fails])
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
    atomic.write(project.cache / MEMORY, json.dumps(remember, ensure_ascii=False).encode())
    return verdict


def _missing(project: Project, found: Iterable) -> list[Failure]:
    from notebook_reports.ledger import harvest
    from notebook_reports.ledger.printed_data import PrintedDataError

    try:
        return harvest.missing(found, printed_documents(project))
    except PrintedDataError as error:
        return [Failure("", f"{project.documents.relative_to(project.root).as_posix()}: {error}", kind="check")]


def _moved(change, frozen: bool) -> Failure:
    from notebook_reports.ledger.files import FILES

    notebook = change.row["notebook"]
    cure = "commit the file that `loopbook build` writes" if frozen else "if that is right: loopbook build --accept"
    repeat = f"loopbook build {notebook}" if notebook else ""
    return Failure(notebook, f"reports/{FILES[change.table]}: {change.line}", 0, (cure,), repeat, "ledger")


def _key(project: Project, notebooks: Sequence[Notebook], how: str) -> str:
    from notebook_reports.ledger.files import FILES

    found = [(n.id, s.records) for n in notebooks if (s := stamps.load(project, n))]
    printed = [fingerprint.hash_file(p) for p in sorted(project.documents.rglob("*.toml"))]
    files = [fingerprint.hash_file(project.reports / name) for name in FILES.values()]
    return fingerprint.digest([how, found, printed, files])
