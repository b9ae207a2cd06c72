"""nbconvert's own LaTeX route, for those who have TeX and pandoc: mended where it breaks, and its log read.

The template ``loopbook_latex`` defines the counter that pandoc's tables ask for ("No counter 'none' defined" else) and
sets A4. Tables and drawings get forms that it can show (`latex_outputs`). After TeX has run, its log is read:
a missing character or a line that runs out of the page by more than `OVERFULL` points is an error, not a report with a
hole in it.
"""

import os
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from nbconvert.exporters.pdf import LatexFailed, PDFExporter
from traitlets import default
from traitlets.config import Config

from notebook_reports.export.errors import ExportError, Problem
from notebook_reports.export.exporters.base import TEMPLATES
from notebook_reports.export.exporters.latex_outputs import DrawingsToPdf, TablesToMarkdown
from notebook_reports.run.surroundings import EPOCH

OVERFULL = 10.0
"""Points by which a line may run into the margin before it is an error."""

_MISSING = re.compile(r"Missing character: There is no (?P<character>.+?) (?:\([^)]*\) )?in font (?P<font>[^!]+?)[:;!]")
_OVERFULL = re.compile(
    r"Overfull \\hbox \((?P<points>[\d.]+)pt too wide\) "
    r"(?P<where>in paragraph at lines \d+--\d+|detected at line \d+|in alignment at lines \d+--\d+|has occurred[^\n]*)"
)


def unwrapped(log: str) -> str:
    """A TeX log with the lines that TeX broke at 79 characters joined again."""
    joined, continues = [], False
    for line in log.split("\n"):
        if continues:
            joined[-1] += line
        else:
            joined.append(line)
        continues = len(line) == 79
    return "\n".join(joined)


def read_log(log: str) -> list[str]:
    r"""What a TeX log says was lost: missing characters and overfull lines, each once.

    >>> read_log("Missing character: There is no ✓ (U+2713) in font [lmroman10-regular]:mapping=tex-text;!")
    ["no ✓ in TeX's font [lmroman10-regular]; write it in another way, or use the engine typst"]
    """
    log = unwrapped(log)
    found = [
        f"no {m['character']} in TeX's font {m['font'].strip()}; write it in another way, or use the engine typst"
        for m in _MISSING.finditer(log)
    ]
    for m in _OVERFULL.finditer(log):
        if float(m["points"]) > OVERFULL:
            place = " ".join(m["where"].split())
            found.append(f"a line {m['points']} points too wide ({place} of the TeX source); write it narrower")
    return list(dict.fromkeys(found))


class LatexPdfExporter(PDFExporter):
    """Notebook to PDF through LaTeX. Raises ExportError without TeX or pandoc, and for what TeX's log says was lost."""

    export_from_notebook = None

    @default("default_preprocessors")
    def _with_our_drawings(self):
        usual = type(self).default_preprocessors.default_args[0]
        place = next(i for i, name in enumerate(usual) if name.endswith("SVG2PDFPreprocessor"))
        return [*usual[:place], TablesToMarkdown, DrawingsToPdf, *usual[place + 1 :]]

    @property
    def default_config(self):
        """nbconvert's, with the drawings made here."""
        config = super().default_config.copy()
        config.merge(Config({name: {"enabled": True} for name in ("DrawingsToPdf", "TablesToMarkdown")}))
        return config

    @default("template_name")
    def _template_name_default(self):
        return "loopbook_latex"

    @default("extra_template_basedirs")
    def _own_templates(self):
        return [str(TEMPLATES)]

    def from_notebook_node(self, nb, resources=None, **kw):
        """The PDF's bytes, and the resources."""
        resources = self._init_resources(resources)
        told = resources.get("loopbook", {})
        name = told.get("name") or (resources.get("metadata") or {}).get("name") or "notebook"
        require_tex(name, self.latex_command[0])
        if told.get("title"):
            nb = type(nb)({**nb, "metadata": {**nb["metadata"], "title": told["title"]}})
        self.lost: list[str] = []
        try:
            pdf, resources = super().from_notebook_node(nb, resources=resources, **kw)
        except LatexFailed as error:
            raise ExportError(name, [Problem(None, _first_error(str(error.output)))]) from None
        if self.lost:
            raise ExportError(name, [Problem(None, text) for text in self.lost])
        return pdf, resources

    def run_latex(self, filename: str, raise_on_failure: Any = LatexFailed) -> bool:
        """Run TeX, then read its log."""
        with _dated():
            done = super().run_latex(filename, raise_on_failure)
        log = os.path.splitext(filename)[0] + ".log"
        if os.path.isfile(log):
            with open(log, encoding="utf-8", errors="replace") as file:
                self.lost = read_log(file.read())
        return done


@contextmanager
def _dated() -> Iterator[None]:
    """TeX puts one date into all reports: nbconvert gives it this process's environment."""
    before = os.environ.get("SOURCE_DATE_EPOCH")
    os.environ["SOURCE_DATE_EPOCH"] = EPOCH
    try:
        yield
    finally:
        if before is None:
            del os.environ["SOURCE_DATE_EPOCH"]
        else:
            os.environ["SOURCE_DATE_EPOCH"] = before


def require_tex(name: str, command: str) -> None:
    """Raise ExportError unless TeX and pandoc can be run."""
    missing = [program for program in (command, "pandoc") if shutil.which(program) is None]
    if missing:
        programs = " and ".join(missing)
        raise ExportError(
            name,
            [
                Problem(
                    None,
                    f"the LaTeX engine needs {programs} on the PATH; install TeX Live (texlive-xetex) and pandoc, "
                    "or use the engine typst, which needs neither",
                )
            ],
        )


def _first_error(output: str) -> str:
    found = re.search(r"^! (.*)$", output, re.MULTILINE)
    return f"TeX stopped: {found[1]}" if found else f"TeX failed: {output.strip()[-300:]}"
