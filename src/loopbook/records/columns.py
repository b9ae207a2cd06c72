"""Which column of a table is the time, the input and the output, and what the others are."""

import re
from dataclasses import dataclass
from itertools import product

import numpy as np

from loopbook.records.names import Name, Role
from loopbook.records.record import RecordError
from loopbook.records.steps import noise_level

FEW_LEVELS = 20


@dataclass(frozen=True)
class Columns:
    """A table's columns by number. time: None where there is none. others: further inputs and disturbances that move.
    setpoint: of a regulator, None where there is none.

    notes: what was assumed, one sentence each.
    """

    time: int | None
    input: int
    output: int
    others: tuple[int, ...]
    setpoint: int | None
    notes: tuple[str, ...]


def levels(column: np.ndarray) -> int:
    return len(np.unique(column[np.isfinite(column)]))


def counts_up(column: np.ndarray) -> bool:
    """Whole numbers, each one more than the last."""
    known = column[np.isfinite(column)]
    return len(known) > 2 and bool((np.diff(known) == 1).all() and (known == np.round(known)).all())


def grows(column: np.ndarray) -> bool:
    known = column[np.isfinite(column)]
    return len(known) > 1 and bool((np.diff(known) >= 0).all()) and levels(column) > 2


def named(names: list[Name], wanted: str, role: str) -> int:
    """The column that the user named. Raises RecordError with the names there are."""
    for same in (lambda n: n.text == wanted, lambda n: n.text.lower() == wanted.lower()):
        found = [i for i, n in enumerate(names) if same(n)]
        if found:
            return found[0]
    there = ", ".join(n.text for n in names)
    raise RecordError(f"there is no column {wanted!r} for the {role}; the columns are {there}")


def find_time(names: list[Name], data: list[np.ndarray], stamped: set[int], wanted: str | None) -> int | None:
    """The column of the time; None where none is: a counter is no time."""
    if wanted:
        return named(names, wanted, "time")
    numeric = [i for i in range(len(names)) if np.isfinite(data[i]).sum() > 1]
    called = [i for i in numeric if names[i].says(Role.TIME) and not names[i].says(Role.SETPOINT)]
    called = [i for i in called if levels(data[i]) > 2]
    called.sort(key=lambda i: (not grows(data[i]), i))
    if called:
        return called[0]
    if dated := [i for i in numeric if i in stamped]:
        return dated[0]
    spoken_for = [i for i in numeric if any(names[i].says(r) for r in Role if r is not Role.TIME)]
    growing = [i for i in numeric if grows(data[i]) and i not in spoken_for and not counts_up(data[i])]
    return next((i for i in growing if names[i].text), growing[0] if growing else None)


def choose(
    names: list[Name],
    data: list[np.ndarray],
    time: int | None,
    aside: set[int],
    input: str | None,
    output: str | None,
) -> Columns:
    """Input and output: those that the user named, or the pair whose names say it loudest, in the order of the file.

    aside: columns that are no signals (dates). Raises RecordError where one is missing.
    """
    usable = [i for i, column in enumerate(data) if np.isfinite(column).sum() > 1 and i != time and i not in aside]
    signals = [i for i in usable if not _is_counter(names[i], data[i])]
    view = _library_view(names, signals)
    u_fixed = [named(names, input, "input")] if input else view[:1]
    y_fixed = [named(names, output, "output")] if output else view[1:]
    loud_u = {i: _loudness(names[i], data[i], Role.INPUT) for i in signals}
    loud_y = {i: _loudness(names[i], data[i], Role.OUTPUT) for i in signals}
    us = u_fixed or [i for i in signals if i not in y_fixed and loud_u[i] > 0]
    ys = y_fixed or [i for i in signals if i not in u_fixed and loud_y[i] > 0]
    if not us:
        us = _unnamed_input(names, data, signals, set(y_fixed) | (set(ys) if len(ys) == 1 else set()))
    if not us:
        raise RecordError(f"no input column found among {_all(names)}; name it with --input")
    if not ys or (len(us) == 1 and not set(ys) - set(us)):
        quiet = [i for i in signals if i not in us and _plain(names[i])]
        ys = [i for i in quiet if levels(data[i]) > 1] or quiet
    pairs = [(u, y) for u, y in product(us, ys) if u != y]
    if not pairs and len(us) > 1 and not input:  # "valve opening" beside "valve flow": the quieter input is the output
        quieter = [i for i in us if names[i].strength(Role.OUTPUT) > 0 and loud_u[i] == min(loud_u[j] for j in us)]
        pairs = [(u, y) for u, y in product(us, quieter) if u != y]
    if not pairs:
        raise RecordError(f"no output column found among {_all(names)}; name it with --output")

    def score(pair: tuple[int, int]) -> tuple[float, float, int, int]:
        u, y = pair
        loud = loud_u.get(u, 9) + loud_y.get(y, 9) + _moves(data, pair)
        return loud, _belong(names[u], names[y]) + _speaks(data[y]), -u, -y

    u, y = max(pairs, key=score)
    notes = []
    if view and not input and not output:
        notes.append(
            "A set-point stands beside Input and Output: they were taken as a PID library names them, Input being the "
            "measurement and Output what the process gets."
        )
    for role, chosen, found, option in (("Input", u, us, "--input"), ("Output", y, ys, "--output")):
        rest = [names[i].text for i in found if i not in (u, y)]
        more = f"; {', '.join(rest)} could be it too ({option})" if rest else ""
        notes.append(f"{role}: column '{names[chosen].text}'{more}.")
    others = [i for i in signals if i not in (u, y) and levels(data[i]) > 1]
    others = [i for i in others if names[i].says(Role.AMBIENT) or loud_u[i] > max(loud_y[i], 0)]
    wanted = [i for i in usable if i not in (u, y) and names[i].says(Role.SETPOINT) and not names[i].says(Role.TIME)]
    wanted.sort(key=lambda i: levels(data[i]) == 1)
    return Columns(time, u, y, tuple(others), wanted[0] if wanted else None, tuple(notes))


def _all(names: list[Name]) -> str:
    return ", ".join(n.text for n in names if n.text)


def _plain(name: Name) -> bool:
    """May the column be a signal at all, if nothing else is?"""
    return not any(name.says(r) for r in (Role.COUNTER, Role.SETPOINT, Role.AMBIENT, Role.OTHER, Role.DATE, Role.TIME))


def _is_counter(name: Name, column: np.ndarray) -> bool:
    return name.says(Role.COUNTER) or ((name.blank or len(name.text) == 0) and counts_up(column))


def _loudness(name: Name, column: np.ndarray, role: Role) -> float:
    """What the name says of the role, less what it says of the other one."""
    if name.says(Role.TIME) or name.says(Role.DATE):
        return 0.0
    other = Role.OUTPUT if role is Role.INPUT else Role.INPUT
    loud = name.strength(role)
    return loud - name.strength(other) / 2 if loud else 0.0


def _moves(data: list[np.ndarray], pair: tuple[int, int]) -> float:
    """A column that stands still is a poor input and a poor output."""
    return sum(0.0 if levels(data[i]) > 1 else -3.0 for i in pair)


def _belong(u: Name, y: Name) -> float:
    """Do both names end in the same number, as "Heater 1" and "Temperature 1" do?"""
    numbers = [re.findall(r"\d+$", n.words[-1]) if n.words else [] for n in (u, y)]
    return 1.0 if numbers[0] and numbers[0] == numbers[1] else 0.0


def _speaks(column: np.ndarray) -> float:
    """From 0 for nothing but noise to 1 for a smooth signal."""
    known = column[np.isfinite(column)]
    spread = float(np.std(known)) if len(known) > 3 else 0.0
    return max(0.0, 1 - noise_level(known) / spread) if spread else 0.0


def _library_view(names: list[Name], signals: list[int]) -> list[int]:
    """[input, output] of the process in a log of Setpoint, Input, Output: a library's names are those of its PID."""
    words = {names[i].words: i for i in signals}
    if any(names[i].says(Role.SETPOINT) for i in signals) and ("input",) in words and ("output",) in words:
        return [words[("output",)], words[("input",)]]
    return []


def _unnamed_input(names: list[Name], data: list[np.ndarray], signals: list[int], taken: set[int]) -> list[int]:
    """The column of fewest levels, where no name says input: few for its length, or at least not all different."""
    free = [i for i in signals if i not in taken and _plain(names[i])]
    free = [i for i in free if 1 < levels(data[i]) <= max(FEW_LEVELS, len(data[i]) // 20)]
    return sorted(free, key=lambda i: levels(data[i]))[:1]
