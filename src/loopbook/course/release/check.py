"""A sheet looked at as its author would: what it is, how many variants it has, and what draws fall to."""

from collections import Counter
from pathlib import Path

from loopbook.course.errors import SheetError
from loopbook.course.release.draw import number_of
from loopbook.course.release.one import runner
from loopbook.course.release.release import why_not
from loopbook.course.release.variants import Variants

ANY = b"variants to look at"


def check(path: Path, draws: int) -> tuple[bool, list[str]]:
    """(is it good, what there is to say). Raises SheetError for a file that is no sheet."""
    ran = runner(path.stem, path.read_bytes())
    variants = Variants(ran.sheet)
    own = ran.solve({}, show="texts")
    lines = [f"{path.stem}: {ran.sheet.title}"]
    if own.redraw:
        lines.append(f"  its own numbers make no exercise: {own.redraw}")
    else:
        lines += [f"  {name} = {asked.kind.text(asked.key)}" for name, asked in own.asked.items()]
    count = min(draws, variants.count)
    whole = count == variants.count
    places = range(count) if whole else [number_of(ANY, path.stem, str(i)) % variants.count for i in range(count)]
    reasons: Counter[str] = Counter()
    for place in places:
        numbers = variants.at(place)
        try:
            reasons[why_not(ran, numbers)] += 1
        except SheetError as error:
            reasons[f"an error with {numbers}: {error}"] += 1
    good = reasons.pop("", 0)
    about = good if whole else round(variants.count * good / count)
    lines.append(
        f"  {variants.count} combinations; {good} of {count} looked at make an exercise, so some {about} variants"
    )
    lines += [f"  {times:5} fall to: {reason}" for reason, times in reasons.most_common(8)]
    broken = any(reason.startswith("an error") for reason in reasons)
    return bool(good) and not own.redraw and not broken, lines
