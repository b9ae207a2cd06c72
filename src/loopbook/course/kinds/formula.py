"""A formula in given letters, equal to the key where the difference vanishes, whatever its form."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from derivations.algebra.rational import vanishes
from loopbook.course.errors import SheetError, Unreadable
from notebook_reports.formula.names import sample_point
from notebook_reports.formula.read import FormulaError, read_formula

_SAMPLE = re.compile(r"(\w+)\[k([+-]\d+)?\]")


def _floats() -> Any:
    from sympy import Float

    return Float


class _Letters(dict[str, Any]):
    """Symbols by name; only those that the sheet names."""


@dataclass(frozen=True)
class Formula:
    """A formula in `symbols`, which may hold samples: ``K T_i h e[k] e[k-1]``. unit: of its value, for the reader.

    The letters stand for positive numbers, as times and gains are; samples for any.
    """

    symbols: str
    unit: str = ""

    @property
    def names(self) -> Mapping[str, Any]:
        import sympy

        return _Letters(
            {name: sympy.Symbol(name, positive=True) for name in self.symbols.split() if not _SAMPLE.fullmatch(name)}
        )

    @property
    def samples(self) -> dict[tuple[str, int], Any]:
        found = [_SAMPLE.fullmatch(name) for name in self.symbols.split()]
        pairs = [(m[1], int(m[2] or 0)) for m in found if m]
        return {pair: sample_point(*pair) for pair in pairs}

    def key(self, value: Any) -> Any:
        if isinstance(value, str):
            try:
                return self._read(value)
            except FormulaError as error:
                raise SheetError(str(error)) from None
        if not hasattr(value, "free_symbols"):
            raise SheetError(f"a formula of SymPy or its text is the value, got {value!r}")
        by_name = value.subs({s: self.names[s.name] for s in value.free_symbols if s.name in self.names})
        if by_name.atoms(_floats()):
            raise SheetError(f"a formula is exact: write Rational(1, 2) for 0.5 in {value}")
        unknown = sorted(s.name for s in by_name.free_symbols if s.name not in self.names and s.name != "k")
        if unknown:
            raise SheetError(f"the formula has {', '.join(unknown)}, which symbols= does not name")
        return by_name

    def _read(self, text: str) -> Any:
        known = self.samples

        def at(name: str, shift: int) -> Any:
            return known[name, shift]

        return read_formula(text, self.names, samples=at)

    def read(self, raw: Any) -> Any:
        if raw is None or raw == "":
            raise Unreadable("nothing was written")
        if not isinstance(raw, str):
            raise Unreadable(f"a formula is asked for, as a text in {self._letters()}")
        try:
            return self._read(raw.partition("=")[2] if raw.count("=") == 1 else raw)
        except FormulaError as error:
            raise Unreadable(f"this is no formula: at character {error.position + 1}: {error.reason}") from None

    def same(self, given: Any, key: Any, widths: float = 1.0) -> bool:
        return bool(vanishes(given - key))

    def handed(self, given: Any, value: Any) -> Any:
        return given

    def plain(self, key: Any) -> str:
        return re.sub(r"(\w+)\(k( [+-] \d+)?\)", lambda m: f"{m[1]}[k{(m[2] or '').replace(' ', '')}]", str(key))

    def text(self, key: Any) -> str:
        import sympy

        return f"${sympy.latex(key)}$"

    def _letters(self) -> str:
        return ", ".join(self.symbols.split())

    def wants(self) -> str:
        return f"a formula as a text, in {self._letters()}"

    def blank(self) -> str:
        return '""'

    def numbers(self, key: Any) -> list[float]:
        return []
