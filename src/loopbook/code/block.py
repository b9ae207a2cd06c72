"""One controller about to be written out: a program, its numbers, and what its signals are called."""

import keyword
import math
import re
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from sympy import Rational, Symbol

from derivations.errors import LoopbookError
from derivations.programs import scaling
from derivations.programs.form import BOOL, BlockProgram, Operation, Variable
from loopbook.code.writing import spoken

UNLIMITED = 3.0e38
"""Stands for infinity where a language has no word for it; a little below the largest single-precision number."""


class CodeError(LoopbookError):
    """What was asked for cannot be written; the message says what is expected."""


def harmless(text: str) -> str:
    """Text from data as it may stand in a comment of any language: it cannot end the comment, nor begin another line.

    >>> harmless("valve */ 2")
    'valve * / 2'
    """
    words = " ".join("".join(c if c.isprintable() else " " for c in text).split()).replace("\\", "/")
    for mark in ("*/", "/*", "*)", "(*"):
        words = words.replace(mark, f"{mark[0]} {mark[1]}")
    return words.replace('"', "'")


@dataclass(frozen=True)
class BlockSignal:
    """A measured or a set quantity. span: its two ends in that unit; raw: the same as the converter's numbers."""

    name: str = ""
    unit: str = ""
    span: tuple[float, float] | None = None
    raw: tuple[float, float] | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "name", harmless(self.name))
        object.__setattr__(self, "unit", harmless(self.unit))
        for what, ends in (("span", self.span), ("raw", self.raw)):
            if ends is not None and (not all(map(math.isfinite, ends)) or ends[0] == ends[1]):
                raise CodeError(
                    f"{self.name or 'signal'}: {what} = {list(ends)} must be two finite numbers that differ"
                )

    def __str__(self) -> str:
        return f"{self.name} [{self.unit}]" if self.name and self.unit else self.name or self.unit


@dataclass(frozen=True)
class Block:
    """program with numbers: settings by name, u and y at rest where they are known.

    name: an identifier of lower-case words (heater_pid). notes: lines for the head of the file.
    """

    program: BlockProgram
    name: str
    numbers: Mapping[str, float]
    y: BlockSignal = BlockSignal()
    u: BlockSignal = BlockSignal()
    rest: tuple[float, float] | None = None
    notes: tuple[str, ...] = field(default=())

    def __post_init__(self) -> None:
        if not re.fullmatch(r"[a-z]\w*", self.name, re.ASCII) or "__" in self.name or keyword.iskeyword(self.name):
            raise CodeError(f"name = {self.name!r}: lower-case words joined by single underscores are expected")
        known = {s.name for s in self.program.settings}
        if strange := sorted(set(self.numbers) - known):
            raise CodeError(
                f"{', '.join(strange)}: no setting of the {self.program.law}; it has {', '.join(sorted(known))}"
            )
        if missing := sorted(known - set(self.numbers) - set(self.program.defaults)):
            raise CodeError(f"{self.program.law}: no number for {', '.join(missing)}")

        object.__setattr__(self, "notes", tuple(harmless(note) for note in self.notes))
        more = (
            _scaling("measurement", "raw", self.y, (self.y.raw, self.y.span)),
            _scaling("actuator", "u_set", self.u, (self.u.span, self.u.raw)),
        )
        new = tuple(o for o in more if o and not self.program.has(o.name))
        object.__setattr__(self, "program", replace(self.program, operations=(*self.program.operations, *new)))

    @property
    def title(self) -> str:
        """HeaterPid of heater_pid."""
        return "".join(word[:1].upper() + word[1:] for word in self.name.split("_"))

    def number(self, setting: Variable) -> float | bool:
        """The value of a setting."""
        name = setting.name
        value: Any = self.numbers[name] if name in self.numbers else self.program.defaults[name]
        return bool(value) if setting.type == BOOL else float(value)

    def settings(self) -> dict[str, float | bool]:
        """All settings by their spoken names, in order."""
        return {spoken(s.name): self.number(s) for s in self.program.settings}

    def arguments(self, operation: str, **words: str) -> str:
        """The arguments of a call: a word for each name, y and y_sp as they are, 0 for the rest."""
        known = {"y": "y", "y_sp": "y_sp", "u_0": "u"} | words
        return ", ".join(known.get(a.name, "0") for a in self.program.operation(operation).arguments)

    def named(self, name: str) -> "Block":
        return replace(self, name=name)


def _scaling(name: str, argument: str, signal: BlockSignal, ends: tuple) -> Operation | None:
    """The line between a converter's number and a quantity, where both ends are known."""
    if None in ends:
        return None
    (a, b), (c, d) = ends
    what = str(signal) or name
    about = f"{what}: {a:.6g}..{b:.6g} is {c:.6g}..{d:.6g}."
    exact = tuple((Rational(low), Rational(high)) for low, high in ends)
    return scaling.operation(name, about, Variable(Symbol(argument)), exact)


def identifier(text: str) -> str:
    """A name for a program from any text.

    >>> identifier("Heater 2, PID"), identifier("3rd"), identifier("")
    ('heater_2_pid', 'pid_3rd', 'pid')
    """
    words = re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")
    name = words if words[:1].isalpha() else f"pid_{words}" if words else "pid"
    return f"{name}_pid" if keyword.iskeyword(name) else name


def checked_finite(value: float, infinite: float = UNLIMITED) -> float:
    """The number that stands for a setting where there is no infinity."""
    return math.copysign(infinite, value) if math.isinf(value) else value
