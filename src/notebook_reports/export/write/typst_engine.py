"""Typst source to PDF bytes, in this process: our fonts only, no network, the same bytes each time."""

import functools
import importlib.util
import json
import os
import re
import shutil
import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from notebook_reports.errors import PressError
from notebook_reports.export.write.arrangement import Arrangement, Place, to_float
from notebook_reports.export.write.more_fonts import more_fonts
from notebook_reports.project import runtime
from notebook_reports.run.surroundings import EPOCH

STANDARDS: Final = ("a-2a", "ua-1")


@dataclass(frozen=True)
class Diagnostic:
    """One complaint of the engine. line: 1-based line of the source, or None where it lies in no line of it."""

    message: str
    line: int | None


@dataclass(frozen=True)
class TooWide:
    """What fits the page only at less than the least size: a table or a formula of a cell, by the writer's name for it.
    share: of its size at which it would fit."""

    cell: int
    what: str
    id: str
    share: float


class TypstFailed(PressError, RuntimeError):
    """The source does not compile; `diagnostics` say why, `wide` what is too wide."""

    def __init__(self, diagnostics: list[Diagnostic], wide: list[TooWide] | None = None):
        self.diagnostics = diagnostics
        self.wide = wide or []
        self.source = ""
        self.files: dict[str, bytes] = {}
        super().__init__("; ".join(d.message for d in diagnostics))


@functools.cache
def fonts() -> Any:
    """The wheel's fonts and matplotlib's (which is not imported), those of `more_fonts`, and none of the system's.

    matplotlib's "last resort" font has a box for every character there is: with it no missing glyph would be noticed,
    so the others are linked into a folder without it.
    """
    import typst

    folder = runtime.make("fonts-")
    spec = importlib.util.find_spec("matplotlib")
    source = Path(spec.origin).parent / "mpl-data" / "fonts" / "ttf" if spec and spec.origin else None
    for file in [*sorted(source.glob("*.ttf") if source else ()), *more_fonts()]:
        if "LastResort" in file.name:
            continue
        try:
            os.symlink(file, folder / file.name)
        except OSError:
            shutil.copyfile(file, folder / file.name)
    return typst.Fonts(include_system_fonts=False, font_paths=[str(folder)])


@dataclass(frozen=True)
class Compiled:
    """pdf: PDF/A-2a and PDF/UA-1. places: of the figures that have a caption."""

    pdf: bytes
    places: tuple[Place, ...]


CHAPTER = "// chapter "
"""How the line before each chapter of a book begins; the first line of the source imports what all need."""


def in_files(source: str) -> list[tuple[str, str, int]]:
    """The source as files: (name, text, lines of the source before it), main.typ first.

    Each chapter is a file of its own: where one is set anew, the engine remembers the others.

    >>> in_files("import\\nshow\\n// chapter a\\nwords")[1:]
    [('chapter-1.typ', 'import // chapter a\\nwords', 2)]
    """
    main, *chapters = re.split(f"^(?={CHAPTER})", source, flags=re.MULTILINE)
    imports = source.partition("\n")[0]
    found, above = [], main.count("\n")
    for number, chapter in enumerate(chapters, start=1):
        found.append((f"chapter-{number}.typ", f"{imports} {chapter}", above))
        above += chapter.count("\n")
    return [("main.typ", main + "".join(f'#include "{name}"\n' for name, *_ in found), 0), *found]


def compile_pdf(source: str, files: dict[str, bytes]) -> Compiled:
    """Compile a source beside its files. Raises TypstFailed, with all that is too wide."""
    import typst

    with tempfile.TemporaryDirectory(prefix="pdf-", dir=runtime.folder()) as folder:
        root = Path(folder)
        for name, content in files.items():
            (root / name).write_bytes(content)
        above = {}
        for name, text, lines in in_files(source):
            (root / name).write_text(text, encoding="utf-8")
            above[name] = lines
        nowhere = str(root / "no-packages")
        try:
            compiler = typst.Compiler(
                str(root / "main.typ"),
                root=folder,
                font_paths=fonts(),
                package_path=nowhere,
                package_cache_path=nowhere,
            )
            pdf, warnings = compiler.compile_with_warnings(timestamp=int(EPOCH), pdf_standards=list(STANDARDS))
            noted = [note.split("|") for note in json.loads(compiler.query("<noted>", field="value"))]
        except typst.TypstError as error:
            raise TypstFailed(_diagnostics(error.diagnostic, error.message, above)) from None
    assert isinstance(pdf, bytes), "a PDF is one piece"
    wide = [TooWide(int(n[1]), n[2], n[3], int(n[4]) / 100) for n in noted if n[0] == "wide"]
    found = [d for w in warnings for d in _diagnostics(w.diagnostic, w.message, above)]
    found += [Diagnostic(f"loopbook|{w.cell}|{w.what}|{w.id}|{w.share * 100:.0f}", None) for w in dict.fromkeys(wide)]
    if found:
        raise TypstFailed(found, list(dict.fromkeys(wide)))
    return Compiled(pdf, tuple(Place(n[1], int(n[2]), float(n[3])) for n in noted if n[0] == "place"))


def _diagnostics(text: str, message: str, above: dict[str, int]) -> list[Diagnostic]:
    """above: by file the lines of the source before it."""
    found = []
    for part in re.split(r"^(?=(?:error|warning): )", text, flags=re.MULTILINE):
        head = re.match(r"(?:error|warning): (.*)", part)
        if head:
            place = re.search(r"┌─ \S*?(main|chapter-\d+)\.typ:(\d+):", part)
            line = above.get(f"{place[1]}.typ", 0) + int(place[2]) if place else None
            found.append(Diagnostic(head[1].strip(), line))
    return found or [Diagnostic(message, None)]


_MISSING = re.compile(r'the text `"(?P<text>.*)"` could not be displayed')
_PRIVATE = re.compile(r'contains the codepoint `"(?P<text>.*)"`')
_TOO_WIDE = re.compile(r"loopbook\|(?P<cell>\d+)\|(?P<what>[^|]*)\|(?P<table>[^|]*)\|(?P<share>\d+)")
LANDSCAPE_FROM = 40
"""The share, in percent, of its size at which a table fits a portrait page, from which on it fits a landscape one."""


MOST_PASSES = 8
"""So often is a report set to let its figures float; what then still begins a page stays there."""


_wide: set[str] = set()
"""The tables that this process found too wide; by content, so that a book need not find them again."""


def compile_settled(write: Callable[[Arrangement], tuple[str, dict[str, bytes]]]) -> bytes:
    """Compile what `write` gives for a layout, until nothing on the pages asks for another one.

    Raises TypstFailed, with the last source and files as its `source` and `files`.
    """
    layout = Arrangement(frozenset(_wide))
    passes = 0
    while True:
        source, files = write(layout)
        try:
            compiled = compile_pdf(source, files)
        except TypstFailed as error:
            more = {w.id for w in error.wide if " " in w.id and w.share >= LANDSCAPE_FROM / 100} - layout.turned
            if not more:
                error.source, error.files = source, files
                raise
            layout = Arrangement(layout.turned | more, layout.floating)
            _wide.update(more)
            continue
        passes += 1
        floating = to_float(compiled.places, layout.floating)
        if not floating or passes == MOST_PASSES:
            return compiled.pdf
        layout = Arrangement(layout.turned, layout.floating | floating)


def explain(diagnostic: Diagnostic, cell_at: Callable[[int | None, str], int | None]) -> tuple[int | None, str]:
    """What the engine's complaint means to the writer of the notebook, and the cell.

    cell_at: from a line of the source and the character in question, either may be unknown, to a cell.
    """
    message = diagnostic.message
    wide = _TOO_WIDE.search(message)
    if wide:
        what = f"{wide['what']} is too wide: it would fit the page only at {wide['share']} % of its size"
        return int(wide["cell"]) or None, f"{what} (60 % is the least); write it narrower"
    glyph = _MISSING.search(message) or _PRIVATE.search(message)
    if glyph:
        text = re.sub(r"\\u\{([0-9a-f]+)\}", lambda m: chr(int(m[1], 16)), glyph["text"])
        codes = " ".join(f"U+{ord(c):04X}" for c in text)
        told = f"no font of the report has {text!r} ({codes}); write it in another way, or as a picture"
        return cell_at(diagnostic.line, text), told
    return cell_at(diagnostic.line, ""), f"the PDF engine refuses it: {message}"


def too_wide_table(diagnostic: Diagnostic) -> str:
    """The name, count and content of the table that is too wide, or nothing."""
    wide = _TOO_WIDE.search(diagnostic.message)
    return wide["table"] if wide and " " in wide["table"] else ""


def cell_finder(source: str, pictures: dict[str, bytes]) -> Callable[[int | None, str], int | None]:
    """Find the cell a line of the source belongs to, or the one whose picture holds a character."""
    lines = source.split("\n")
    cells: list[int | None] = []
    current: int | None = None
    for line in lines:
        mark = re.fullmatch(r"// cell (\d+)", line)
        current = int(mark[1]) if mark else current
        cells.append(current)

    def find(line: int | None, text: str) -> int | None:
        if line is not None and line <= len(cells):
            return cells[line - 1]
        for name, data in pictures.items():
            if text and name.endswith(".svg") and text in data.decode():
                quoted = json.dumps(name)
                return next((cell for cell, row in zip(cells, lines, strict=True) if quoted in row), None)
        return None

    return find
