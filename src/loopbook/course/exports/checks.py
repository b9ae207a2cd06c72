"""The lines of Python with which nbgrader and otter compare one answer with its key."""

from loopbook.course.exports.variants import parts
from loopbook.course.kinds.choice import Choice
from loopbook.course.kinds.number import OneNumber
from loopbook.course.question import Asked


def key_of(asked: Asked) -> str:
    """The key as Python writes it."""
    return repr(asked.kind.plain(asked.key))


def check_of(asked: Asked) -> list[str]:
    """Assertions about ``answers[name]``; none where the answer cannot be compared by a line of Python."""
    given = f"answers[{asked.name!r}]"
    if isinstance(asked.kind, Choice):
        return [f"assert {given} == {asked.kind.plain(asked.key)!r}, 'this is not the choice'"]
    found = parts(asked)
    if isinstance(asked.kind, OneNumber):
        found = found[:1]
        return [f"assert abs(float({given}) - {p.key!r}) <= {p.width:.6g}, 'this is not the value'" for p in found]
    if not found:
        return []
    lines = [f"assert len({given}) == {len(found)}, '{len(found)} numbers are asked for'"]
    return lines + [
        f"assert abs(float({given}[{i}]) - {p.key!r}) <= {p.width:.6g}, 'number {i + 1} is not the value'"
        for i, p in enumerate(found)
    ]
