"""One of several options, and the reason for it."""

from collections.abc import Sequence
from dataclasses import dataclass
from hashlib import sha256
from typing import Any

from loopbook.course.errors import SheetError, Unreadable

YES_NO = ("yes", "no")
Chosen = tuple[str, str]


@dataclass(frozen=True)
class Choice:
    """An option and, where `reasons` are given, the letter of one of them. reason: the right one."""

    options: tuple[str, ...] = YES_NO
    reasons: tuple[str, ...] = ()
    reason: str = ""
    unit: str = ""

    def __post_init__(self) -> None:
        if len(self.options) < 2 or len({_plain(o) for o in self.options}) < len(self.options):
            raise SheetError("a choice has two or more different options")
        if bool(self.reasons) != bool(self.reason) or (self.reason and self.reason not in self.reasons):
            raise SheetError("the right reason is one of the reasons")
        object.__setattr__(self, "reasons", tuple(sorted(self.reasons, key=lambda r: sha256(r.encode()).digest())))

    @property
    def letters(self) -> dict[str, str]:
        """The reasons by letter, in an order that says nothing."""
        return {chr(ord("a") + i): reason for i, reason in enumerate(self.reasons)}

    def key(self, value: Any) -> Chosen:
        value = YES_NO[not value] if type(value).__name__ in ("bool", "bool_", "BooleanTrue", "BooleanFalse") else value
        if value not in self.options:
            raise SheetError(f"{value!r} is none of {', '.join(self.options)}")
        letter = next((a for a, reason in self.letters.items() if reason == self.reason), "")
        return value, letter

    def read(self, raw: Any) -> Chosen:
        if raw is None or raw in ("", [], ["", ""]):
            raise Unreadable("nothing was written")
        if isinstance(raw, bool):
            raw = YES_NO[not raw]
        parts = [p.strip() for p in raw.split(",")] if isinstance(raw, str) else raw
        if isinstance(raw, str) and len(parts) > 2:
            parts = [raw]
        if not isinstance(parts, list) or not all(isinstance(p, str) for p in parts) or not 1 <= len(parts) <= 2:
            raise Unreadable(f"a choice is asked for: {self.wants()}")
        option = next((o for o in self.options if _plain(o) == _plain(parts[0])), None)
        if option is None:
            raise Unreadable(f'"{parts[0][:40]}" is none of {", ".join(self.options)}')
        letter = _plain(parts[1]).strip("().") if len(parts) == 2 else ""
        if letter and letter not in self.letters:
            raise Unreadable(f'"{parts[1][:40]}" is none of the reasons {", ".join(self.letters)}')
        return option, letter

    def same(self, given: Chosen, key: Chosen, widths: float = 1.0) -> bool:
        return given == key if self.reasons else given[0] == key[0]

    def right_without_reason(self, given: Chosen, key: Chosen) -> bool:
        """The right option for another reason, or for none."""
        return given[0] == key[0] and given != key

    def handed(self, given: Chosen, value: Any) -> Any:
        return given[0] == "yes" if self.options == YES_NO and not isinstance(value, str) else given[0]

    def plain(self, key: Chosen) -> Any:
        return list(key) if self.reasons else key[0]

    def text(self, key: Chosen) -> str:
        reason = self.letters.get(key[1], "")
        return f"{key[0]}, {key[1]}) {reason}" if reason else key[0]

    def wants(self) -> str:
        named = ", ".join(f'"{o}"' for o in self.options)
        return (
            f'one of {named}, and the letter of the reason: ["{self.options[0]}", "a"]'
            if self.reasons
            else f"one of {named}"
        )

    def blank(self) -> str:
        return '["", ""]' if self.reasons else '""'

    def numbers(self, key: Chosen) -> list[float]:
        return []


def _plain(text: str) -> str:
    return " ".join(text.split()).casefold()


def as_options(options: Sequence[str] | None) -> tuple[str, ...]:
    """The options as written, by default yes and no."""
    return tuple(options) if options else YES_NO
