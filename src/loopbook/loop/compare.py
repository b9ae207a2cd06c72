"""Regulators on one process, or runs of it, side by side in one table and one figure."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.loop.continuous import Loop
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.step_info import step_info
from loopbook.loop.transfer import LoopError
from loopbook.plots.curves import curves
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.plots.shown import shown_once
from loopbook.process.transfer_function import Process
from loopbook.response.simulation import Simulation

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LOOP = ("Ms", "phase margin [°]", "gain margin", "IAE, load", "overshoot [%]", "settling [s]", "peak |u|")
RUN = ("overshoot [%]", "IAE", "largest u", "smallest u", "variation of u")
UNSTABLE = ("unstable", *("",) * (len(LOOP) - 1))


@dataclass(frozen=True, repr=False)
class SideBySide(ShortRepr, ShownAsTable):
    """What `compare` makes. loops or runs: by name; values: a row of measures for each, by name."""

    items: Mapping[str, Any]
    heads: tuple[str, ...]
    values: Mapping[str, tuple[Any, ...]]

    def table(self) -> PlainTable:
        """One row each."""
        return PlainTable(["", *self.heads], [[name, *row] for name, row in self.values.items()])

    def column(self, head: str) -> dict[str, Any]:
        """One measure of all, by name."""
        return {name: row[self.heads.index(head)] for name, row in self.values.items()}

    def plot(self, horizon: float | None = None) -> "Figure":
        """Output and input: of loops after unit steps of reference and load, of runs as they went; a figure."""
        y, u = {}, {}
        if self.heads == RUN:
            for name, run in self.items.items():
                y[name], u[name] = (run.t, run.y), (run.t, run.u)
            return shown_once(curves({"output $y$": y, "input $u$": u}, "Runs side by side"))
        stable = {name: loop for name, loop in self.items.items() if loop.is_stable}
        if not stable:
            raise ValueError("no loop is stable: there is nothing to draw")
        horizon = horizon or max(3 * step_info(loop).settling for loop in stable.values())
        for name, loop in stable.items():
            y[name], u[name] = loop.reference_and_load(horizon)
        title = "Unit steps of the reference (at once) and of the load (half-way)"
        return shown_once(curves({"output $y$": y, "input $u$": u}, title))


def compare(first: Any, regulators: Mapping[str, Any] | None = None) -> SideBySide:
    """Regulators on a process, loops, or simulations by name: a table that shows itself, and `plot`.

    first: a `Process`, with the regulators by name (PID forms, what `tune` gives, `Tunings`); or a mapping of names to
    `Loop`, `SampledLoop`, or `Simulation`.
    Of loops: Ms, phase and gain margin, IAE of a load step, overshoot, settling time and largest |u| of a set-point
    step. Of runs: overshoot over the last reference, IAE, range and total variation of u.

    >>> from loopbook.tuning import tune
    >>> process = Process([2], [40, 14, 1], delay=3)
    >>> found = compare(process, tune(process, ["simc", "lambda"], "PI"))
    >>> {name: round(Ms, 2) for name, Ms in found.column("Ms").items()}
    {'simc-pi': 1.7, 'lambda-pi': 1.36}
    """
    if isinstance(first, Process):
        if not isinstance(regulators, Mapping) or not regulators:
            raise ValueError("compare takes a process and its regulators by name, such as {'SIMC': tune(...)}")
        first = {name: Loop(first, regulator) for name, regulator in regulators.items()}
    if not isinstance(first, Mapping) or not first:
        raise ValueError(f"compare takes a process or a mapping of names to loops or runs, got {type(first).__name__}")
    kinds = {isinstance(item, Simulation) for item in first.values()}
    if len(kinds) > 1:
        raise ValueError("loops and runs have different measures: compare them apart")
    if kinds == {True}:
        return SideBySide(dict(first), RUN, {name: _of_run(run) for name, run in first.items()})
    return SideBySide(dict(first), LOOP, {name: _of_loop(loop) for name, loop in first.items()})


def _of_loop(loop: Loop | SampledLoop) -> tuple[Any, ...]:
    if not loop.is_stable:
        return UNSTABLE
    m, info = loop.margins(), step_info(loop)
    if isinstance(loop, SampledLoop):
        steps = int(np.ceil(info.settling * 3 / loop.regulator.h)) + 50
        iae = loop.step("load", steps).between.integral_of_magnitude()
        peak = float(np.max(np.abs(loop.step("reference", steps).u)))
    else:
        iae, peak = _or_inf(loop.step("load").iae), abs(loop.step("reference").peak_input()[1])
    return m.Ms.value, m.phase, m.gain, iae, info.overshoot, info.settling, peak


def _or_inf(measure: Any) -> float:
    try:
        return float(measure())
    except LoopError:
        return float("inf")


def _of_run(run: Simulation) -> tuple[Any, ...]:
    h = run.t[1] - run.t[0]
    last = run.reference[-1]
    start = run.y[0]
    over = (
        100 * max(0.0, float(np.max((run.y - last) * np.sign(last - start)))) / abs(last - start)
        if last != start
        else 0.0
    )
    varied = abs(run.u[0]) + float(np.abs(np.diff(run.u)).sum())
    return over, float(h * np.sum(np.abs(run.reference - run.y))), float(run.u.max()), float(run.u.min()), varied
