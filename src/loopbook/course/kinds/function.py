"""A small function, such as a controller: judged by what it does."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from loopbook.course.errors import SheetError, Unreadable

Conditions = Callable[..., dict[str, Any]]


@dataclass(frozen=True)
class Function:
    """A function of numbers that gives a number; what `holds` says of it decides. takes: its arguments, in words."""

    takes: str = ""
    unit: str = ""

    def key(self, value: Any) -> Callable[..., float]:
        if not callable(value):
            raise SheetError(f"a function is the value, got {value!r}")
        return value

    def read(self, raw: Any) -> Callable[..., float]:
        if raw is None:
            raise Unreadable("nothing was written")
        if not callable(raw):
            raise Unreadable("a function is asked for, by its name and without brackets or quotes")
        return raw

    def same(self, given: Any, key: Any, widths: float = 1.0) -> bool:
        return given is key

    def handed(self, given: Any, value: Any) -> Any:
        return given

    def plain(self, key: Any) -> str:
        return getattr(key, "__name__", "a function")

    def text(self, key: Any) -> str:
        return f"`{self.plain(key)}`"

    def wants(self) -> str:
        return f"a function of ({self.takes}), by its name" if self.takes else "a function, by its name"

    def blank(self) -> str:
        return "None"

    def numbers(self, key: Any) -> list[float]:
        return []
