"""What an object says of itself in one short line: its fields, numbers in six digits, what is long only named."""

from collections.abc import Mapping
from dataclasses import MISSING, fields, is_dataclass
from typing import Any

LONGEST, PART, FEW = 240, 70, 6


class ShortRepr:
    """For a dataclass with repr=False: its name with the fields that differ from their defaults, some 240 characters.

    >>> from dataclasses import dataclass
    >>> @dataclass(repr=False)
    ... class Answer(ShortRepr):
    ...     value: float
    ...     grid: list
    ...     note: str = ""
    >>> Answer(1 / 3, list(range(100)))
    Answer(value=0.333333, grid=[100 items])
    """

    def __repr__(self) -> str:
        parts: list[str] = []
        length = len(type(self).__name__)
        for field in fields(self):  # type: ignore[arg-type]
            value = getattr(self, field.name)
            if not field.repr or (field.default is not MISSING and value is field.default):
                continue
            part = f"{field.name}={short(value)}"
            if length + len(part) > LONGEST:
                parts.append("...")
                break
            parts.append(part)
            length += len(part) + 2
        return f"{type(self).__name__}({', '.join(parts)})"


def short(value: Any) -> str:
    """One value: a number in six digits, a short row as it is, a long one by its length, an object by its own repr.

    >>> short(0.1 + 0.2), short((1.0, 2.0)), short({"a": 1, "b": 2})
    ('0.3', '(1, 2)', '{2 names}')
    """
    if isinstance(value, float):
        return f"{value:.6g}"
    if isinstance(value, Mapping):
        return f"{{{len(value)} names}}"
    if type(value) in (list, tuple) or hasattr(value, "shape"):
        if getattr(value, "shape", ()) == () and hasattr(value, "shape"):
            return f"{value}"
        plain = hasattr(value, "shape") or len(value) > FEW or not all(isinstance(x, int | float) for x in value)
        open_, close = "()" if isinstance(value, tuple) else "[]"
        if plain:
            return f"{open_}{len(value)} items{close}" if len(value) else f"{open_}{close}"
        return f"{open_}{', '.join(map(short, value))}{close}"
    text = repr(value)
    if len(text) <= PART:
        return text
    return f"{type(value).__name__}(...)" if is_dataclass(value) or not isinstance(value, str) else f"{text[:PART]}...'"
