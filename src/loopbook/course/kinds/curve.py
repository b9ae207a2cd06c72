"""A plot, by its data: values at given places."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from loopbook.course.errors import SheetError, Unreadable
from loopbook.course.kinds.kind import finite_number, real_number, shown_number, with_unit
from loopbook.course.tolerance import Tolerance

LONGEST = 20_000


@dataclass(frozen=True)
class PlottedData:
    """The values y at the places x, within a tolerance relative to the curve's span; or [x, y] of the student's own."""

    tolerance: Tolerance
    x: tuple[float, ...]
    unit: str = ""
    of: str = "x"

    def key(self, value: Any) -> tuple[float, ...]:
        found = tuple(real_number(v, "a value of the curve") for v in value)
        if len(found) != len(self.x) or len(found) < 2:
            raise SheetError(f"the curve has {len(found)} values at {len(self.x)} places")
        if list(self.x) != sorted(set(self.x)):
            raise SheetError("the places of a curve grow")
        return found

    def read(self, raw: Any) -> tuple[float, ...]:
        if raw is None or raw == []:
            raise Unreadable("nothing was written")
        if not isinstance(raw, list) or len(raw) > LONGEST:
            raise Unreadable(f"{len(self.x)} values are asked for, in square brackets")
        if len(raw) == 2 and all(isinstance(part, list) for part in raw):
            return self._on_our_places(*raw)
        if len(raw) != len(self.x):
            raise Unreadable(f"{len(self.x)} values are asked for, {len(raw)} are given")
        return tuple(finite_number(v) for v in raw)

    def _on_our_places(self, x: list[Any], y: list[Any]) -> tuple[float, ...]:
        import numpy as np

        xs, ys = [finite_number(v) for v in x], [finite_number(v) for v in y]
        if len(xs) != len(ys) or len(xs) < 2:
            raise Unreadable(f"{len(xs)} places and {len(ys)} values are no curve")
        if xs != sorted(xs):
            raise Unreadable("the places of the curve do not grow")
        if xs[0] > self.x[0] or xs[-1] < self.x[-1]:
            raise Unreadable(
                f"the curve goes from {xs[0]:g} to {xs[-1]:g}; from {self.x[0]:g} to {self.x[-1]:g} is asked for"
            )
        return tuple(float(v) for v in np.interp(self.x, xs, ys))

    def same(self, given: Sequence[float], key: Sequence[float], widths: float = 1.0) -> bool:
        scale = max(key) - min(key) or max(map(abs, key))
        width = widths * (self.tolerance.absolute + self.tolerance.relative * scale) * (1 + 1e-9)
        return len(given) == len(key) and all(abs(g - k) <= width for g, k in zip(given, key, strict=True))

    def handed(self, given: Sequence[float], value: Any) -> Any:
        import numpy as np

        return np.array(given) if isinstance(value, np.ndarray) else type(value)(given)

    def plain(self, key: Sequence[float]) -> list[float]:
        return list(key)

    def text(self, key: Sequence[float]) -> str:
        ends = [with_unit(shown_number(key[i], self.tolerance.shown_digits), self.unit) for i in (0, -1)]
        return f"{len(key)} values from {ends[0]} to {ends[1]}"

    def wants(self) -> str:
        of = f" in {self.unit}" if self.unit else ""
        step = self.x[1] - self.x[0]
        regular = all(abs(b - a - step) < 1e-9 * abs(step) for a, b in zip(self.x, self.x[1:], strict=False))
        places = (
            f"{self.of} = {self.x[0]:g}, {self.x[1]:g} … {self.x[-1]:g}" if regular else f"the places {self.of} given"
        )
        return f"{len(self.x)} values{of} in square brackets, at {places}, {self.tolerance} of the span"

    def blank(self) -> str:
        return "[]"

    def numbers(self, key: Sequence[float]) -> list[float]:
        return []
