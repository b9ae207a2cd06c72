"""The PID blocks of controllers as numbers need them: printed once from their equations, run without SymPy."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from typing import Any

from loopbook.lazy import late
from loopbook.printed.store import kept_for, lambda_text, run_text

symbols, catalogue = late("derivations.vendors.block"), late("derivations.vendors.catalogue")

Formula = Callable[..., float]
"""(K, Ti, Td, Tf, b, Sy, Su) -> a number; times in s, Sy and Su the spans of measurement and output."""


@dataclass(frozen=True)
class BlockEntry:
    """One number to type in: see `derivations.vendors.block.Entry`.

    per_span: does it depend on the measuring range? inverse: is it divided by its span?
    """

    name: str
    unit: str
    value: Formula
    derivative: bool
    low: float | None
    high: float | None
    per_span: bool
    inverse: bool


@dataclass(frozen=True)
class BlockNeed:
    """What a setting must keep: expression >= 0."""

    expression: Formula
    reason: str


@dataclass(frozen=True)
class VendorBlock:
    """A block: see `derivations.vendors.block.PidBlock`.

    manual: title, edition and pages in a line. in_percent: does an entry depend on the measuring range? of_output: on
    that of the output? out_in_percent: does the gain count percent of the output per unit of the measurement?
    """

    name: str
    title: str
    manual: str
    entries: tuple[BlockEntry, ...]
    filter: Formula
    needs: tuple[BlockNeed, ...]
    weights: Mapping[int, str]
    on_error: bool
    in_percent: bool
    of_output: bool
    out_in_percent: bool
    derivative: str
    upwards: str
    downwards: str
    selections: tuple[str, ...]
    does: tuple[str, ...]


@cache
def vendor_blocks() -> dict[str, VendorBlock]:
    """Every block by name: the forms of textbooks first, then the vendors by the alphabet."""
    return {data["name"]: _block(data) for data in _printed_blocks()}


def _block(data: dict[str, Any]) -> VendorBlock:
    entries = tuple(BlockEntry(**{**entry, "value": run_text(entry["value"], "math")}) for entry in data["entries"])
    needs = tuple(BlockNeed(run_text(text, "math"), reason) for text, reason in data["needs"])
    read = {
        "entries": entries,
        "needs": needs,
        "filter": run_text(data["filter"], "math"),
        "weights": {int(weight): what for weight, what in data["weights"]},
        "selections": tuple(data["selections"]),
        "does": tuple(data["does"]),
    }
    return VendorBlock(**{**data, **read})


@kept_for()
def _printed_blocks() -> list[dict[str, Any]]:
    return [_printed(block) for block in catalogue.by_name().values()]


def _printed(block: Any) -> dict[str, Any]:
    manual = block.manual
    return {
        "name": block.name,
        "title": block.title,
        "manual": f"{manual.title}, {manual.edition}, {'p. ' if manual.pages[0].isdigit() else ''}{manual.pages}",
        "entries": [_printed_entry(entry) for entry in block.entries],
        "filter": _text(block.filter),
        "needs": [(_text(need.expression), need.reason) for need in block.needs],
        "weights": list(block.weights.items()),
        "on_error": block.on_error,
        "in_percent": block.in_percent,
        "of_output": any(symbols.Su in entry.value.free_symbols for entry in block.entries),
        "out_in_percent": block.signals == symbols.PERCENT_OUT,
        "derivative": block.derivative,
        "upwards": block.upwards,
        "downwards": block.downwards,
        "selections": list(block.selections),
        "does": list(block.does),
    }


def _printed_entry(entry: Any) -> dict[str, Any]:
    once, twice = (entry.value.subs(symbols.Sy, span) for span in (1, 2))
    low, high = (None if end is None else float(end) for end in (entry.low, entry.high))
    return {
        "name": entry.name,
        "unit": entry.unit,
        "value": _text(entry.value),
        "derivative": entry.derivative,
        "low": low,
        "high": high,
        "per_span": symbols.Sy in entry.value.free_symbols,
        "inverse": twice != 2 * once,
    }


def _text(expression: Any) -> str:
    names = (symbols.K, symbols.Ti, symbols.Td, symbols.Tf, symbols.b, symbols.Sy, symbols.Su)
    return lambda_text(names, expression, "math")
