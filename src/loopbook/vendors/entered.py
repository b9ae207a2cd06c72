"""A PID setting as the numbers that are typed into a controller, and what that controller then does otherwise."""

import difflib
import math
from collections.abc import Sequence
from dataclasses import dataclass

from derivations.errors import LoopbookError
from loopbook.controllers.pid_forms import PidParallel, PidSeries, PidStandard
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.vendors.blocks import BlockEntry, VendorBlock, vendor_blocks

PERCENT = "%"
SAME = 1e-9


class VendorFormError(LoopbookError):
    """The block cannot express the setting, or is not known; the message says why and what to take instead."""


@dataclass(frozen=True)
class Typed:
    """One number to type in.

    value: None where it needs the measuring range, which was not given; `per_span` then times the span is the value
    (divided by it where `inverse`).
    """

    name: str
    unit: str
    value: float | None
    per_span: float = math.nan
    inverse: bool = False


@dataclass(frozen=True)
class Entered(ShownAsTable):
    """A setting in one block's form.

    typed: the numbers. selections: what else is selected. realised: what the block then does, in standard form. notes:
    where that differs from the setting that was asked for, and what the block does otherwise.
    """

    block: VendorBlock
    typed: tuple[Typed, ...]
    selections: tuple[str, ...]
    realised: PidStandard
    notes: tuple[str, ...]

    @property
    def values(self) -> dict[str, float | None]:
        """The numbers by the names that the controller gives them."""
        return {t.name: t.value for t in self.typed}

    def table(self) -> PlainTable:
        rows = [[t.name, shown(t), t.unit] for t in self.typed]
        return PlainTable(["entry", "value", "unit"], rows, (self.block.title, *self.selections, *self.notes))

    def data(self) -> dict[str, object]:
        """The same as plain data; a value that needs the measuring range has `per_span` instead."""
        entries = [
            {"name": t.name, "unit": t.unit, "value": t.value}
            | ({"per_span": t.per_span, "inverse": t.inverse} if t.value is None else {})
            for t in self.typed
        ]
        r = self.realised
        return {
            "form": self.block.name,
            "title": self.block.title,
            "manual": self.block.manual,
            "entries": entries,
            "selections": list(self.selections),
            "realised": {"K": r.K, "Ti": _number(r.Ti), "Td": r.Td, "Tf": r.Tf, "b": r.b, "c": r.c},
            "notes": list(self.notes),
        }


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None


def shown(t: Typed) -> str:
    """The value to four digits, or what it is per span of the measurement."""
    if t.value is not None:
        return f"{t.value:.4g}"
    return f"{t.per_span:.4g} / span of y" if t.inverse else f"{t.per_span:.4g} × span of y"


def enter(
    pid: PidStandard | PidParallel | PidSeries,
    form: str,
    y_range: Sequence[float] | None = None,
    u_range: Sequence[float] | None = None,
) -> Entered:
    """A setting in the form of one block.

    pid: any form; times in s. form: a name of `vendor_forms()`. y_range, u_range: (low, high) of the measuring range
    and of the output, in the units of K; a block that works in percent needs them. Without y_range its gain is given
    per span of the measurement; without u_range VendorFormError.
    Raises VendorFormError with the reason where the block cannot express the setting (a series form with Ti < 4 Td) or
    does not take such numbers.

    >>> enter(PidStandard(2.0, 300.0), "honeywell-udc-band", (0, 500), (0, 100)).values
    {'PROP BD': 10.0, 'RSET RPM': 0.2}
    """
    block = block_named(form)
    wanted = pid.standard()
    _refuse(block, wanted)
    Su = _span("u_range", u_range, block.title) if block.of_output else 1.0
    given = y_range is not None or not block.in_percent
    Sy = _span("y_range", y_range, block.title) if y_range is not None else 1.0
    weight = _weight(block, wanted.b)
    numbers = (abs(wanted.K), wanted.Ti, wanted.Td, wanted.Tf, weight, Sy, Su)
    for need in block.needs if wanted.Td else ():
        if need.expression(*numbers) < -SAME * wanted.Ti:
            raise VendorFormError(f"{block.title}: Ti = {wanted.Ti:.4g} s, Td = {wanted.Td:.4g} s. {need.reason}")
    entries = [e for e in block.entries if wanted.Td or not e.derivative]
    typed = tuple(_typed(e, numbers, given) for e in entries)
    for entry, one in zip(entries, typed, strict=True):
        _limits(block, entry, one)
    c = 1.0 if block.on_error else 0.0
    Tf = float(block.filter(*numbers)) if wanted.Td else 0.0
    realised = PidStandard(wanted.K, wanted.Ti, wanted.Td, b=weight, c=c, Tf=Tf)
    select = (block.weights[int(weight)],) if block.weights else ()
    way = block.upwards if wanted.K > 0 else block.downwards
    D = block.selections if wanted.Td else tuple(x for x in block.selections if "erivative" not in x)
    selections = tuple(text for text in (*D, *select, way) if text)
    return Entered(block, typed, selections, realised, (*_differs(block, wanted, realised), *block.does))


def block_named(form: str) -> VendorBlock:
    """The block of a name. Raises VendorFormError with the nearest names where there is none."""
    if form not in vendor_blocks():
        near = difflib.get_close_matches(form, vendor_blocks(), 3, 0.4)
        meant = " or ".join(near) if near else ", ".join(vendor_blocks())
        raise VendorFormError(f"form {form!r} is not known; {meant}")
    return vendor_blocks()[form]


def vendor_forms() -> list[str]:
    """The names of all blocks.

    >>> "siemens-pid-compact" in vendor_forms()
    True
    """
    return list(vendor_blocks())


def _span(name: str, ends: Sequence[float] | None, title: str) -> float:
    if ends is None:
        raise VendorFormError(
            f"{title} works in percent of ranges: give {name} = (low, high), the range that is 0 to 100 %"
        )
    low, high = map(float, ends)
    if not (math.isfinite(low) and math.isfinite(high) and low < high):
        raise VendorFormError(f"{name} = ({low:g}, {high:g}): finite ends are expected, the low one first")
    return high - low


def _refuse(block: VendorBlock, pid: PidStandard) -> None:
    if pid.K == 0:
        raise VendorFormError(f"{block.title}: K = 0 has no form")
    if math.isinf(pid.Ti):
        raise VendorFormError(f"{block.title}: Ti = inf; the forms here are for settings with integral action")
    if pid.Td and block.derivative:
        raise VendorFormError(f"{block.title}: {block.derivative}")


def _weight(block: VendorBlock, b: float) -> float:
    """The nearest set-point weight that the block has."""
    if not block.weights:
        return b
    return float(min(block.weights, key=lambda allowed: (abs(allowed - b), -allowed)))


def _typed(entry: BlockEntry, numbers: tuple[float, ...], given: bool) -> Typed:
    value = float(entry.value(*numbers))
    if given or not entry.per_span:
        return Typed(entry.name, entry.unit, value)
    return Typed(entry.name, entry.unit, None, value, entry.inverse)


def _limits(block: VendorBlock, entry: BlockEntry, one: Typed) -> None:
    """Raises where the controller does not take the number."""
    if one.value is None:
        return
    low, high = entry.low, entry.high
    if (low is not None and one.value < low) or (high is not None and one.value > high):
        ends = f"{'' if low is None else f'{low:g}'} to {'' if high is None else f'{high:g}'}"
        raise VendorFormError(
            f"{block.title}: {entry.name} = {one.value:.4g} {entry.unit}, and it takes {ends}; choose a setting of "
            "another speed, or for a gain other ranges"
        )


def _differs(block: VendorBlock, wanted: PidStandard, realised: PidStandard) -> list[str]:
    """In words, where what the block does is not what was asked for."""
    found = []
    if block.out_in_percent:
        found.append("The gain is in % of the output per unit of the measurement.")
    if abs(realised.b - wanted.b) > SAME:
        found.append(
            f"The set-point weight {wanted.b:.3g} cannot be entered; with {realised.b:.0f} a set-point step moves the "
            f"output {'more: a ramp or a filter of the set-point does the same' if realised.b > wanted.b else 'less'}."
        )
    if wanted.Td and realised.c != wanted.c:
        acts = "error: a set-point step kicks the output" if realised.c else "measurement"
        found.append(f"The derivative acts on the {acts}.")
    if wanted.Td and not math.isclose(realised.Tf, wanted.Tf, rel_tol=1e-6, abs_tol=SAME * wanted.Ti):
        filtered = f"a filter of {realised.Tf:.3g} s" if realised.Tf else "no filter"
        found.append(f"The derivative has {filtered} instead of {wanted.Tf:.3g} s.")
    return found
