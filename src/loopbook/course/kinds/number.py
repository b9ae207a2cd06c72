"""One number, or several."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from loopbook.course.errors import SheetError, Unreadable
from loopbook.course.kinds.kind import finite_number, real_number, shown_number, with_unit
from loopbook.course.tolerance import Tolerance


@dataclass(frozen=True)
class OneNumber:
    """One real number in a unit. whole: the author's value is an integer; then it is not looked for in texts."""

    tolerance: Tolerance
    unit: str = ""
    whole: bool = False

    def key(self, value: Any) -> float:
        return real_number(value, "the value")

    def read(self, raw: Any) -> float:
        return finite_number(raw)

    def same(self, given: float, key: float, widths: float = 1.0) -> bool:
        return self.tolerance.within(given, key, widths)

    def handed(self, given: float, value: Any) -> float:
        return given

    def plain(self, key: float) -> float:
        return key

    def text(self, key: float) -> str:
        if self.whole and key == int(key):
            return with_unit(str(int(key)), self.unit)
        return with_unit(shown_number(key, self.tolerance.shown_digits), self.unit)

    def wants(self) -> str:
        if self.whole:
            return "a whole number" + (f" of {self.unit}" if self.unit else "")
        of = f" in {self.unit}" if self.unit else ""
        return f"a number{of}, {self.tolerance}"

    def blank(self) -> str:
        return "None"

    def numbers(self, key: float) -> list[float]:
        return [] if self.whole else [key]


@dataclass(frozen=True)
class SeveralNumbers:
    """Several real numbers, by name or in order. names: of each; any_order: as roots have none."""

    tolerance: Tolerance
    count: int
    unit: str = ""
    names: tuple[str, ...] = ()
    any_order: bool = False

    def key(self, value: Any) -> tuple[float, ...]:
        if len(list(value)) != self.count:
            raise SheetError(f"{self.count} numbers are asked for, the value has {len(list(value))}")
        return tuple(real_number(v, "a value") for v in value)

    def read(self, raw: Any) -> tuple[float, ...]:
        if raw is None or raw == []:
            raise Unreadable("nothing was written")
        if not isinstance(raw, list):
            raise Unreadable(f"{self.count} numbers are asked for, in square brackets")
        if len(raw) != self.count:
            raise Unreadable(f"{self.count} numbers are asked for, {len(raw)} are given")
        return tuple(finite_number(v) for v in raw)

    def same(self, given: Sequence[float], key: Sequence[float], widths: float = 1.0) -> bool:
        pairs = zip(sorted(given), sorted(key), strict=True) if self.any_order else zip(given, key, strict=True)
        scale = 1e-3 * max(map(abs, key), default=0.0)
        return all(self.tolerance.within(g, k, widths, scale) for g, k in pairs)

    def handed(self, given: Sequence[float], value: Any) -> Any:
        import numpy as np

        return np.array(given) if isinstance(value, np.ndarray) else type(value)(given)

    def plain(self, key: Sequence[float]) -> list[float]:
        return list(key)

    def text(self, key: Sequence[float]) -> str:
        parts = [shown_number(v, self.tolerance.shown_digits) for v in key]
        named = [f"{n} = {p}" for n, p in zip(self.names, parts, strict=True)] if self.names else parts
        return with_unit(", ".join(named), self.unit)

    def wants(self) -> str:
        what = ", ".join(self.names) if self.names else f"{self.count} numbers"
        order = " in any order" if self.any_order else ""
        of = f" in {self.unit}" if self.unit else ""
        return f"[{what}]{order}{of}, {self.tolerance}"

    def blank(self) -> str:
        return "[" + ", ".join(["None"] * self.count) + "]"

    def numbers(self, key: Sequence[float]) -> list[float]:
        return list(key)
