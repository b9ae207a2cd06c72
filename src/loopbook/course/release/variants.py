"""The values that each parameter of a sheet takes, and the numbers that one variant has."""

import math
from collections.abc import Mapping
from decimal import Decimal
from functools import cached_property
from typing import Any

from loopbook.course.errors import SheetError
from loopbook.course.sheet import Sheet
from notebook_reports.project.parameters import NotebookParameter
from notebook_reports.project.ranges import Range

MOST = 100_000
"""Values of one parameter."""


def values(parameter: NotebookParameter) -> tuple[Any, ...]:
    """What a parameter may be drawn as; its own value alone where its comment says nothing or only a bound.

    A list in braces is taken as it is. Of an interval all whole numbers, or all numbers with three digits of its larger
    end. Raises SheetError for too many.

    >>> from notebook_reports.project.ranges import read_range
    >>> values(NotebookParameter("q", "float", 0.5, "", read_range("[0.4, 0.5)")))[:3]
    (0.4, 0.401, 0.402)
    """
    found = parameter.range
    if parameter.type == "bool":
        return (False, True)
    if found.choices:
        return tuple(parameter.check(v) for v in found.choices)
    if (
        parameter.type not in ("int", "float")
        or len(found.bounds) != 2
        or {r[0] for r, _ in found.bounds} != {">", "<"}
    ):
        return (parameter.default,)
    low, high = sorted(bound for _, bound in found.bounds)
    step = Decimal(1) if parameter.type == "int" else Decimal(10) ** (_decade(low, high) - 2)
    first, last = math.ceil(Decimal(repr(low)) / step), math.floor(Decimal(repr(high)) / step)
    if last - first > MOST:
        raise SheetError(f"{parameter.name} takes more than {MOST} values: {found.text}; list some in braces")
    kind = int if parameter.type == "int" else float
    return tuple(v for i in range(first, last + 1) if _inside(found, v := kind(i * step)))


def _decade(low: float, high: float) -> int:
    return math.floor(math.log10(max(abs(low), abs(high))))


def _inside(found: Range, value: float) -> bool:
    return found.holds(value)


class Variants:
    """All combinations of the values of a sheet's parameters, numbered from 0."""

    def __init__(self, sheet: Sheet):
        self.axes = {name: values(p) for name, p in sheet.parameters.items()}
        if empty := [name for name, axis in self.axes.items() if not axis]:
            raise SheetError(
                f"{sheet.id}: {empty[0]} has no value in its range {sheet.parameters[empty[0]].range.text}"
            )

    @cached_property
    def count(self) -> int:
        return math.prod(len(axis) for axis in self.axes.values())

    def at(self, index: int) -> dict[str, Any]:
        """The numbers of one variant.

        Raises IndexError beyond the last.
        """
        if not 0 <= index < self.count:
            raise IndexError(f"variant {index} of {self.count}")
        found = {}
        for name, axis in self.axes.items():
            index, place = divmod(index, len(axis))
            found[name] = axis[place]
        return found

    def index(self, numbers: Mapping[str, Any]) -> int | None:
        """The number of a variant; None where a value is not among the values of now."""
        index, width = 0, 1
        for name, axis in self.axes.items():
            if numbers.get(name) not in axis:
                return None
            index += width * axis.index(numbers[name])
            width *= len(axis)
        return index
