"""Every sheet at many draws: is each solved, are keys as by hand, does rounding the inputs move nothing?

    python tests/loopbook/course/proof/prove_course.py [DRAWS] [SHEET...]

Per sheet: draws that raised (unsolved), draws that make an exercise, how many variants that makes, and of a share of
them: keys and wrong methods that another route does not confirm, answers that half a digit of an input moves by a third
of their tolerance or more.
"""

import math
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from decimal import Decimal
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from class_of import by_hand

from loopbook.course.errors import SheetError
from loopbook.course.kinds.function import Function
from loopbook.course.question import APART
from loopbook.course.release.draw import number_of
from loopbook.course.release.one import runner
from loopbook.course.release.release import why_not
from loopbook.course.release.variants import Variants
from notebook_reports.run.filled import written

ROOT = Path(__file__).parents[4]
SHEETS = sorted((ROOT / "notebooks" / "exercises").glob("*.ipynb"))
THIRD = 1 / 3
CLASS = 240
SECRET = b"prove the sheets"


@dataclass
class Proof:
    """What was found of one sheet. draws: looked at; good: that make an exercise; looked: closely."""

    sheet: str
    draws: int = 0
    good: int = 0
    looked: int = 0
    variants: int = 0
    wrong: Counter = field(default_factory=Counter)
    faults: list[str] = field(default_factory=list)

    def line(self) -> str:
        counts = f"{self.draws:6} draws, {self.good:6} good: {self.variants:6} variants; {self.looked:4} looked at"
        return f"{self.sheet:22} {counts}, {len(self.faults)} faults {'; '.join(self.faults[:3])}"


def raw(one, value):
    """What a student would write for a value found by hand."""
    if isinstance(value, tuple):
        option, reason = value
        letters = {text: letter for letter, text in getattr(one.kind, "letters", {}).items()}
        return [option, letters[reason]]
    return (
        value
        if isinstance(value, str | int)
        else [float(v) for v in value]
        if hasattr(value, "__len__")
        else float(value)
    )


def against_hand(sheet: str, solved) -> Iterator[str]:
    """Where the sheet and the solution by hand do not agree."""
    found = by_hand(sheet)(dict(solved.parameters), {})
    if set(found) != set(solved.asked):
        yield f"by hand {sorted(found)}, in the sheet {sorted(solved.asked)}"
        return
    for name, one in solved.asked.items():
        value, wrong = found[name]
        if isinstance(one.kind, Function):
            continue  # judged in its loop by the tests of grading
        mine = one.kind.read(raw(one, value))
        if not (one.right(mine) if one.holds else one.kind.same(mine, one.key, THIRD)):
            yield f"{name}: by hand {one.kind.text(mine)}, in the sheet {one.kind.text(one.key)}"
        for method, bad in wrong.items():
            if method not in one.wrong:
                yield f"{name}: the sheet has no wrong method {method!r}"
            elif not one.kind.same(one.kind.read(raw(one, bad)), one.wrong[method], 0.9):
                yield f"{name}: {method}: by hand {bad}, in the sheet {one.kind.text(one.wrong[method])}"
            elif one.kind.same(one.kind.read(raw(one, bad)), one.key, APART * 0.9):
                yield f"{name}: {method} lies at the key"


def half_a_digit(value: float) -> float:
    """Half of the last digit with which a text shows a number."""
    return 0.5 * 10.0 ** int(Decimal(written(value)).as_tuple().exponent)


def sensitive(ran, solved) -> Iterator[str]:
    """Answers that half a digit of an input moves by a third of their tolerance or more."""
    for name in ran.sheet.shown_parameters:
        value = solved.parameters[name]
        if not isinstance(value, float):
            continue
        for sign in (-1, 1):
            moved = ran.solve({**solved.parameters, name: value + sign * half_a_digit(value)}, strict=False)
            for key, one in solved.asked.items():
                other = moved.asked[key]
                if one.holds is None and not one.kind.same(other.key, one.key, THIRD):
                    texts = one.kind.text(one.key), one.kind.text(other.key)
                    yield f"{key}: half a digit of {name} moves it from {texts[0]} to {texts[1]}"


def prove(path: Path, draws: int, close: int, whole: bool = True) -> Proof:
    """Look at so many draws of a sheet, at so many closely; not whole: no further than that takes."""
    ran = runner(path.stem, path.read_bytes())
    variants = Variants(ran.sheet)
    proof = Proof(path.stem)
    known: dict[int, str] = {}
    for i in range(draws):
        place = number_of(SECRET, path.stem, str(i)) % variants.count
        numbers = variants.at(place)
        proof.draws += 1
        if place not in known:
            try:
                known[place] = why_not(ran, numbers)
            except SheetError as error:
                known[place] = "an error"
                proof.faults.append(f"unsolved with {numbers}: {error}")
            if not known[place] and proof.looked < close:
                proof.looked += 1
                solved = ran.solve(numbers)
                proof.faults += [
                    f"{numbers}: {what}" for what in (*against_hand(path.stem, solved), *sensitive(ran, solved))
                ]
        proof.good += not known[place]
        if not whole and proof.looked == close:
            break
    proof.variants = round(variants.count * proof.good / proof.draws)
    if whole and draws >= 1000 and proof.variants < CLASS:
        proof.faults.append(f"{proof.variants} variants for a class of {CLASS}")
    return proof


def main(words: list[str]) -> int:
    draws = int(words[0]) if words and words[0].isdigit() else 10_000
    chosen = [p for p in SHEETS if p.stem in words] or SHEETS
    proofs = [prove(path, draws, max(1, math.isqrt(draws))) for path in chosen]
    for proof in proofs:
        print(proof.line(), flush=True)
    print(f"{sum(p.draws for p in proofs)} draws of {len(proofs)} sheets, {sum(len(p.faults) for p in proofs)} faults")
    return 1 if any(p.faults for p in proofs) else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
