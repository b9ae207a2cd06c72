"""All answers of one student: the sheet runs with their numbers, and again with their own answers in the place of ours.

What follows from a student's own earlier value is so known from the same cells that made the key. What of the earlier
values decides is found by taking them one at a time.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from derivations.errors import LoopbookError
from loopbook.course.errors import SheetError, Unreadable
from loopbook.course.grade.verdicts import OWN, Given, Judged, judge_answer
from loopbook.course.kinds.number import OneNumber
from loopbook.course.question import Asked
from loopbook.course.running import SheetRunner, Solved
from loopbook.course.time_limit import time_limit

SECONDS = 30.0
"""For one run of a sheet with a student's values."""
SAME = 0.01
"""Tolerances that two keys may differ by and count as one."""
FARTHEST = 1e4
"""How many times larger or smaller than the key a student's own number may be and still be gone on with."""


@dataclass
class Consequences:
    """Runs of one sheet with some of a student's answers. own: those that can be gone on with."""

    ran: SheetRunner
    numbers: Mapping[str, Any]
    own: dict[str, Any]

    def asked(self, own: Mapping[str, Any]) -> dict[str, Asked] | None:
        """What the sheet asks for when it goes on with these values; None where it cannot."""
        try:
            with time_limit(SECONDS):
                return self.ran.solve(self.numbers, own, strict=False).asked
        except (SheetError, TimeoutError, MemoryError):
            return None


def judge_all(ran: SheetRunner, numbers: Mapping[str, Any], given: Mapping[str, Given]) -> tuple[Solved, list[Judged]]:
    """(the sheet solved, the verdict on each answer in order)."""
    solved = ran.solve(numbers, strict=False)
    right = solved.asked
    runs = Consequences(ran, numbers, _usable(right, given))
    chained = _chained(runs, right)
    found: dict[str, Judged] = {}
    for name, asked in right.items():
        earlier = {n: v for n, v in runs.own.items() if n in found}
        own = chained.get(name) if chained and earlier else None
        if own is not None and own.holds is None and _equal(own, asked):
            own = None
        names = _decisive(runs, right, earlier, name, found) if own is not None else []
        try:
            with time_limit(SECONDS):
                found[name] = judge_answer(asked, given.get(name, Given()), own if names else None, names)
        except TimeoutError:
            found[name] = judge_answer(asked, Given(refused="comparing it takes too long; write it shorter"))
    return solved, list(found.values())


def _usable(right: Mapping[str, Asked], given: Mapping[str, Given]) -> dict[str, Any]:
    """The student's answers that a sheet may go on with: readable, and of a size that no computation runs away with."""
    found = {}
    for name, asked in right.items():
        one = given.get(name, Given())
        if one.refused or one.raw is None:
            continue
        try:
            value = asked.kind.read(one.raw)
        except Unreadable:
            continue
        if isinstance(asked.kind, OneNumber) and asked.key:
            ratio = abs(value / asked.key)
            if not 1 / FARTHEST <= ratio <= FARTHEST:
                continue
        found[name] = one.raw
    return found


def _chained(runs: Consequences, right: Mapping[str, Asked]) -> dict[str, Asked] | None:
    """The sheet with all of the student's own values; those that it cannot go on with are left out, of the wrong ones
    one alone where that will do."""
    while runs.own:
        found = runs.asked(runs.own)
        if found is not None and set(found) == set(right):
            return found
        wrong = [n for n in runs.own if not _is_right(right[n], runs.own[n])] or list(runs.own)
        without = [{k: v for k, v in runs.own.items() if k != n} for n in wrong]
        runs.own = next((own for own in without if runs.asked(own) is not None), without[-1])
    return None


def _is_right(asked: Asked, raw: Any) -> bool:
    try:
        return asked.right(asked.kind.read(raw))
    except LoopbookError:
        return False


def _decisive(
    runs: Consequences,
    right: Mapping[str, Asked],
    earlier: Mapping[str, Any],
    name: str,
    judged: Mapping[str, Judged],
) -> list[str]:
    """Of the earlier values those that make this answer what it is: without one of them it would be another.

    Where values follow from each other none is alone decisive: then the first causes, each of which moves the answer.
    Right values that were only rounded are named where no wrong one is.
    """

    def key(own: Mapping[str, Any]) -> Asked | None:
        return (runs.asked(own) or {}).get(name)

    def moves(one: Asked | None, other: Asked | None) -> bool:
        return one is None or other is None or not _equal(one, other)

    whole = key(earlier)
    moving = [n for n in earlier if moves(key({k: v for k, v in earlier.items() if k != n}), whole)]
    if not moving:
        moving = [n for n in earlier if judged[n].verdict != OWN and moves(key({n: earlier[n]}), right[name])]
    wrong = [n for n in moving if not _is_right(right[n], earlier[n])]
    return wrong if wrong or right[name].holds is not None else moving


def _equal(one: Asked, other: Asked) -> bool:
    """Is it the same key, as far as it can matter?"""
    if one.holds is not None or (callable(one.key) and not hasattr(one.key, "free_symbols")):
        return False
    return one.kind.same(one.key, other.key, SAME)
