"""One thing that a sheet asks for: its kind, its key, what it is worth, what wrong methods give."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from loopbook.course.errors import Redraw, SheetError
from loopbook.course.kinds.choice import Choice
from loopbook.course.kinds.function import Conditions
from loopbook.course.kinds.kind import Kind

APART = 3.0
"""Tolerances that the value of a named wrong method lies from the key at least."""


@dataclass(frozen=True)
class Asked:
    """One answer that is asked for, with these numbers.

    value: as the author gave it; key: in the form that is compared. wrong: by the name of the method, as keys.
    holds: where any answer is right that fulfils conditions. cell: where in the sheet. says: what it is.
    """

    name: str
    kind: Kind
    value: Any
    key: Any
    points: float
    wrong: Mapping[str, Any] = field(default_factory=dict)
    holds: Conditions | None = None
    cell: int = 0
    says: str = ""

    def conditions(self, given: Any) -> dict[str, bool]:
        """What has to hold of an answer, and whether it does; none where there is a key to compare with."""
        if self.holds is None:
            return {}
        values = given if isinstance(given, tuple | list) else (given,)
        return {text: bool(holds) for text, holds in self.holds(*values).items()}

    def right(self, given: Any, widths: float = 1.0) -> bool:
        """Is an answer right, within so many tolerances?"""
        if self.holds is not None:
            return all(self.conditions(given).values())
        return self.kind.same(given, self.key, widths)

    def sees_to_itself(self) -> None:
        """Raise Redraw where the key does not fulfil its own conditions or a wrong method gives nearly the key."""
        if unmet := [text for text, holds in self.conditions(self.key).items() if not holds]:
            raise Redraw(f"{self.name}: the key itself fails: {unmet[0]}")
        numbers = self.kind.numbers(self.key)
        tolerance = getattr(self.kind, "tolerance", None)
        if tolerance is not None and tolerance.relative and numbers and not any(numbers):
            raise Redraw(f"{self.name} is 0, of which no relative tolerance is known")
        for method, key in self.wrong.items():
            widths = 1.0 if isinstance(self.kind, Choice) else APART
            if self.kind.same(key, self.key, widths):
                raise Redraw(f'{self.name}: "{method}" gives nearly the right value')

    def refuse_bad_names(self) -> None:
        """Raises SheetError."""
        if not self.name.isidentifier():
            raise SheetError(f"answer({self.name!r}, ...): a name of letters, digits and _ is needed")
        if not (self.points > 0 and self.points == self.points and self.points < 1000):
            raise SheetError(f"{self.name}: points are above 0, got {self.points!r}")
