"""What every export begins with: some variants of a sheet, solved, and what of each can be asked for elsewhere."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from loopbook.course.errors import SheetError
from loopbook.course.kinds.choice import Choice
from loopbook.course.kinds.curve import PlottedData
from loopbook.course.kinds.number import OneNumber, SeveralNumbers
from loopbook.course.kinds.polynomial import Polynomial
from loopbook.course.notebooks import Cell, source_of
from loopbook.course.question import Asked
from loopbook.course.release.draw import Draw
from loopbook.course.release.one import runner
from loopbook.course.release.release import why_not
from loopbook.course.release.student import screen_sheet
from loopbook.course.release.variants import Variants
from loopbook.course.running import SheetRunner, Solved
from notebook_reports.export.read.solutions import QUESTION

WEAKER = (
    "Made by loopbook from the sheet {sheet}. This is a weaker check than loopbook's own: each answer is compared with "
    "its key alone, what follows from a student's own earlier value counts as wrong, and no mistake is named."
)
MOST_PARTS = 12


@dataclass(frozen=True)
class AnswerNumber:
    """One number of an answer: label, key, the largest error that is none; wrong: what named wrong methods give."""

    label: str
    key: float
    width: float
    wrong: tuple[tuple[str, float], ...] = ()


@dataclass(frozen=True)
class Variant:
    """One variant. number: from 1; cells: as a student reads them."""

    number: int
    ran: SheetRunner
    solved: Solved
    cells: list[Cell]

    def questions(self) -> Iterator[tuple[int, Cell, list[Asked]]]:
        """(number from 1, its text, what it asks for) of each question."""
        numbers = {c.id: c.number for c in self.ran.sheet.cells}
        found = [c for c in self.cells if QUESTION in c["metadata"].get("tags", ())]
        for place, cell in enumerate(found, 1):
            asked = self.solved.asked.values()
            yield place, cell, [a for a in asked if self.ran.sheet.question_of(a.cell) == numbers[cell["id"]]]

    @property
    def intro(self) -> list[Cell]:
        """The cells of prose before the first question, without the line that says whose the sheet is."""
        found: list[Cell] = []
        for cell in self.cells:
            if QUESTION in cell["metadata"].get("tags", ()):
                break
            found += [cell] if cell["cell_type"] == "markdown" and cell["id"] != "whose" else []
        return found


def variants_of(path: Path, count: int, secret: bytes) -> list[Variant]:
    """So many variants of a sheet, or as many as there are. Raises SheetError where there is none."""
    ran = runner(path.stem, path.read_bytes())
    draw = Draw(path.stem, Variants(ran.sheet), secret, lambda numbers: why_not(ran, dict(numbers)))
    found: list[Variant] = []
    for number in range(1, count + 1):
        try:
            numbers = draw.of(f"variant {number}", count)[1]
        except ValueError:
            break
        solved = ran.solve(numbers, show="all")
        found.append(Variant(number, ran, solved, screen_sheet(ran.sheet, solved, "")["cells"]))
    if not found:
        raise SheetError(f"{path.stem}: no variant makes an exercise")
    return found


def parts(asked: Asked) -> list[AnswerNumber]:
    """The numbers of an answer; none where it is no number, or too many of them."""
    kind, key = asked.kind, asked.key
    if asked.holds is not None:
        return []
    if isinstance(kind, OneNumber):
        wrong = tuple((method, value) for method, value in asked.wrong.items())
        return [AnswerNumber(asked.name, key, kind.tolerance.width(key) or 0.5, wrong)]
    if isinstance(kind, SeveralNumbers) and not kind.any_order:
        labels = kind.names or tuple(f"{asked.name} {i}" for i in range(1, kind.count + 1))
        return [
            AnswerNumber(n, k, kind.tolerance.width(k, 1e-3 * max(map(abs, key))))
            for n, k in zip(labels, key, strict=True)
        ]
    if isinstance(kind, Polynomial):
        scale = 1e-2 * max(map(abs, key))
        powers = range(len(key) - 1, -1, -1)
        return [
            AnswerNumber(f"{kind.symbol}^{p}", k, kind.tolerance.width(k, scale))
            for p, k in zip(powers, key, strict=True)
        ]
    if isinstance(kind, PlottedData) and len(key) <= MOST_PARTS:
        width = kind.tolerance.absolute + kind.tolerance.relative * ((max(key) - min(key)) or abs(key[0]))
        return [AnswerNumber(f"{kind.of} = {x:g}", k, width) for x, k in zip(kind.x, key, strict=True)]
    return []


def left_out(variant: Variant) -> list[str]:
    """The answers that another system cannot judge: formulas, functions, conditions."""
    return [a.name for a in variant.solved.asked.values() if not parts(a) and not isinstance(a.kind, Choice)]


def plain_text(cells: list[Cell]) -> str:
    """The prose of several cells as one Markdown text."""
    return "\n\n".join(source_of(cell) for cell in cells)


def asking(cell: Cell) -> str:
    """The text of a question without the lines that say how a notebook is answered."""
    return re.sub(r"\n+(?:→ |- [a-z]\) ).*", "", source_of(cell))


def stands_alone(variant: Variant, asked: Asked) -> bool:
    """Does a key not depend on earlier answers: would another value of any of them leave it as it is?"""
    for other, one in variant.solved.asked.items():
        if other == asked.name:
            return True
        moved: Any = _moved(one)
        if moved is None:
            continue
        try:
            found = variant.ran.solve(variant.solved.parameters, {other: moved}, strict=False).asked
        except SheetError:
            return False
        if not asked.kind.same(found[asked.name].key, asked.key, 0.01):
            return False
    return True


def _moved(asked: Asked) -> Any:
    """Another plain value of an answer."""
    plain = asked.kind.plain(asked.key)
    if isinstance(plain, float):
        return plain * 1.07
    if isinstance(plain, list) and all(isinstance(v, float) for v in plain):
        return [v * 1.07 for v in plain]
    if isinstance(asked.kind, Choice):
        other = next(o for o in asked.kind.options if o != asked.key[0])
        return [other, asked.key[1]] if asked.kind.reasons else other
    return None
