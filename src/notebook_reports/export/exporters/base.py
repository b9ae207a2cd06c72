"""What the exporters share."""

import copy
import functools
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from nbconvert.exporters.templateexporter import TemplateExporter
from traitlets import Bool, Unicode, default

from notebook_reports.export.code_cells import CODE, place_code
from notebook_reports.export.errors import ExportError, Problem
from notebook_reports.export.formulas import as_mathml, as_text, as_typst
from notebook_reports.export.mends import MODES, mend_lines
from notebook_reports.export.model import Display, Math, Report, walk
from notebook_reports.export.read.notebook import PARTS, read
from notebook_reports.export.write.typst_engine import TypstFailed, cell_finder, explain
from notebook_reports.mathematics import MathError

TEMPLATES = Path(__file__).parent / "templates"

CONTENTS_FROM = 3
"""Headings from which on a report has a table of contents."""


class ReportExporter(TemplateExporter):
    """What the PDF and the HTML exporter share: the notebook read into a report, and its particulars.

    `resources["loopbook"]` may hold name, title, document, chapter, language, author, mode, code, folded and, for the
    screen, around; the traits are the defaults. nbconvert's own options hold as well: what it leaves out
    (``--no-input``) and the preprocessors that its user switches on (``--execute``, tags to be removed).
    """

    document = Unicode("", help="The document a notebook belongs to; equation anchors carry it.").tag(config=True)
    chapter = Unicode("", help="The chapter named in the title block and the running head.").tag(config=True)
    language = Unicode("en", help="Language of the text, for readers and hyphenation.").tag(config=True)
    author = Unicode("loopbook", help="Author in the metadata.").tag(config=True)
    strict_alt = Bool(False, help="Fail where a picture has no alternative text.").tag(config=True)
    mode = Unicode(
        "mend",
        help="What cannot be shown: a numbered box in its place and a list at the end (mend), or an error (strict).",
    ).tag(config=True)

    code = Unicode(
        "inline", help="Where the code stands: in its place (inline), after the last section (end), nowhere (none)."
    ).tag(config=True)
    folded = Bool(False, help="On the screen, code is shown to who opens it.").tag(config=True)

    @default("extra_template_basedirs")
    def _own_templates(self) -> list[str]:
        return [str(TEMPLATES)]

    def report(self, nb: Any, resources: dict[str, Any]) -> Report:
        """Read the notebook. Raises ExportError."""
        nb = self._prepared(nb, resources)
        told = {key: value for key, value in resources.get("loopbook", {}).items() if value not in ("", None)}
        metadata = resources.get("metadata") or {}
        particulars = {
            "name": metadata.get("name") or "notebook",
            "document": self.document,
            "chapter": self.chapter,
            "language": self.language,
            "author": self.author,
            "folder": Path(metadata["path"]) if metadata.get("path") is not None else None,
            "strict_alt": self.strict_alt,
            "mode": self.mode,
        }
        wanted = {**particulars, "code": self.code, **told}
        for trait, known in (("mode", MODES), ("code", CODE)):
            if wanted[trait] not in known:
                problem = f"the {trait} is one of {', '.join(known)}, got {wanted[trait]!r}"
                raise ExportError(wanted["name"], [Problem(None, problem)])
        code, _, _ = (wanted.pop(name, None) for name in ("code", "folded", "around"))
        report = read(nb, **wanted, leave_out=self._left_out())
        place_code(report, code)
        return report

    def _left_out(self) -> frozenset[str]:
        """The parts that nbconvert is told to leave out."""
        names = dict(zip(PARTS, ("markdown", "raw", "code_cell", "input", "output"), strict=True))
        return frozenset(part for part, name in names.items() if getattr(self, f"exclude_{name}"))

    def _prepared(self, nb: Any, resources: dict[str, Any]) -> Any:
        """The notebook after the preprocessors that have something to do."""
        active = [p for p in self._preprocessors if _has_work(p)]
        if active:
            nb = copy.deepcopy(nb)
        for preprocessor in active:
            nb, _ = preprocessor(nb, resources)
        return nb

    def mended(self, resources: dict[str, Any]) -> bool:
        """Is this export one that mends what it cannot show?"""
        return resources.get("loopbook", {}).get("mode", self.mode) == "mend"

    def tell(self, report: Report, resources: dict[str, Any]) -> None:
        """Say what was mended, on the standard error of the nbconvert command, and in the resources."""
        resources["loopbook_mends"] = report.mends
        resources["loopbook_report"] = report
        for line in mend_lines(report):
            self.log.warning(line)

    def from_filename(self, filename: str, resources: Any = None, **kw: Any) -> tuple[Any, Any]:
        """What nbconvert's command calls; a notebook that cannot be exported is one message there, not a traceback."""
        with one_message():
            return super().from_filename(filename, resources=resources, **kw)

    def from_file(self, file_stream: Any, resources: Any = None, **kw: Any) -> tuple[Any, Any]:
        """The same for a stream."""
        with one_message():
            return super().from_file(file_stream, resources=resources, **kw)


def _has_work(preprocessor: Any) -> bool:
    """Is it switched on, and, of those that always are, told what to remove?"""
    if not getattr(preprocessor, "enabled", True):
        return False
    match type(preprocessor).__name__:
        case "TagRemovePreprocessor":
            kinds = ("cell", "all_outputs", "single_output", "input")
            return any(getattr(preprocessor, f"remove_{kind}_tags") for kind in kinds)
        case "RegexRemovePreprocessor":
            return bool(preprocessor.patterns)
    return True


@contextmanager
def one_message() -> Iterator[None]:
    """Inside nbconvert's command, end it with the message of an error that its user can mend, and exit code 1."""
    from nbformat import ValidationError
    from nbformat.reader import NotJSONError

    try:
        yield
    except (ExportError, NotJSONError, ValidationError, OSError, UnicodeDecodeError) as error:
        if not any(cls.__name__ == "NbConvertApp" for cls in type(_application()).__mro__):
            raise
        first = str(error) if isinstance(error, ExportError) else f"this is no notebook that can be read: {error}"
        raise SystemExit(first) from None


def _application() -> Any:
    from traitlets.config import Application

    return Application.instance() if Application.initialized() else None


@functools.cache
def support_files() -> dict[str, bytes]:
    """The file beside main.typ that is the same for every report."""
    return {"report.typ": (TEMPLATES / "loopbook_pdf" / "report.typ").read_bytes()}


def contents_depth(report: Report) -> int:
    """How many levels of headings the table of contents shows; 0 for none."""
    levels = [heading.level for heading in report.headings]
    if len(levels) < CONTENTS_FROM or not report.contents:
        return 0
    return 2 if sum(level <= 2 for level in levels) <= 30 else 1


def as_export_error(error: TypstFailed, name: str) -> ExportError:
    """The engine's complaints as problems of cells, each once."""
    find = cell_finder(error.source, error.files)
    explained = dict.fromkeys(explain(diagnostic, find) for diagnostic in error.diagnostics)
    return ExportError(name, [Problem(cell, text) for cell, text in explained])


def problems(report: Report, form: str) -> list[Problem]:
    """Every formula of a report that the converter to "typst" or "mathml" refuses."""
    convert = as_typst if form == "typst" else as_mathml
    found = []
    for cell in report.cells:
        for node in walk(cell):
            if isinstance(node, Math | Display):
                try:
                    convert(node.latex, isinstance(node, Display))
                    as_text(node.latex)
                except MathError as error:
                    found.append(Problem(cell.number, f"a formula: {error}"))
    return found
