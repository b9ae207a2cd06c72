"""A sampled controller against the exact continuous process: what runs on the plant, step by step.

At each instant kh the controller is called with the measurement and the reference and its output is held for h
seconds; the process moves on exactly (`sampling`), with a dead time of any fraction of h. The controller is any object
with

    u = controller.step(y, reference)

so it may switch, saturate, be reset or change its parameters. Between the samples the response is known too.
"""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from derivations.errors import LoopbookError
from loopbook.numerics.collocation import DEGREE, DelayEquation, cell_operator, graded_mesh, radau
from loopbook.numerics.signals import Signal
from loopbook.plots.curves import curves
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.plots.shown import shown_once
from loopbook.plots.stairs import stairs
from loopbook.process.sampled import SampledProcess, held, sample
from loopbook.process.transfer_function import Process

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Course = float | Sequence[float] | np.ndarray | Callable[[float], float]


class SimulationError(LoopbookError):
    """A simulation that cannot be run as asked; the message says what to change."""


class Controller(Protocol):
    """Called once per sampling instant with the measurement [y] and the reference [y]; returns the output [u]."""

    def step(self, y: float, reference: float) -> float: ...


@dataclass(frozen=True, repr=False)
class Simulation(ShortRepr, ShownAsTable):
    """What happened at the instants t = 0, h, 2h, ...; arrays of one length.

    t [s]. y: the process output. measured: what the controller saw (with noise). u: what the process got, after
    saturation. demanded: what the controller asked for. reference, load: as given.
    """

    t: np.ndarray
    y: np.ndarray
    measured: np.ndarray
    u: np.ndarray
    demanded: np.ndarray
    reference: np.ndarray
    load: np.ndarray
    sampled: SampledProcess
    states: np.ndarray
    delayed: np.ndarray
    output: np.ndarray

    @cached_property
    def between(self) -> Signal:
        """y in continuous time, also between the samples, up to the last instant."""
        plant, h, tau = self.sampled.plant, self.sampled.h, self.sampled.tau
        pieces = [(0.0, tau, 1), (tau, h - tau, 0)] if tau else [(0.0, h, 0)]
        early, older = held(plant, tau)
        steps = len(self.t) - 1
        edges, rows = [], []
        for start, length, age in pieces:
            # delayed[k] holds the inputs acting in [kh, kh + tau) and [kh + tau, kh + h)
            v = self.delayed[:steps, 0 if age else 1]
            x = self.states[:steps]
            if start:
                x = x @ early.T + np.outer(self.delayed[:steps, 0], older[:, 0])
            mesh = graded_mesh(plant.A, length)
            for a, d in zip(mesh[:-1], np.diff(mesh), strict=True):
                zero = np.zeros(len(plant.A))
                equation = DelayEquation(plant.A, zero, plant.B[:, 0], plant.C, np.zeros(1), np.zeros(1), 0.0)
                G = cell_operator(equation, float(d))
                n = len(plant.A)
                nodes = np.einsum("pij,kj->kpi", G[:, :, :n], x) + np.einsum("pi,k->kpi", G[:, :, -1], v)
                values = np.concatenate([x[:, None, :], nodes], axis=1) @ plant.C[0]
                values = values + (plant.D[0, 0] * v + self.output[:steps])[:, None]
                edges.append(self.t[:steps] + start + a)
                rows.append(values @ radau()[2].T)
                x = nodes[:, -1]
        order = np.argsort(np.concatenate(edges), kind="stable")
        all_edges = np.append(np.concatenate(edges)[order], self.t[-1])
        return Signal(all_edges, np.concatenate(rows)[order].reshape(-1, DEGREE + 1))

    def table(self) -> PlainTable:
        """Where the signals went: the last and the extreme values of y, u and the reference."""
        rows = []
        for name, row in (("reference", self.reference), ("output y", self.y), ("input u", self.u)):
            rows.append([name, float(row[-1]), float(row.min()), float(row.max())])
        said = f"{len(self.t)} instants, {self.sampled.h:g} s apart"
        return PlainTable(["signal", "at the end", "least", "largest"], rows, [said])

    def plot(self) -> "Figure":
        """Output and input as a matplotlib figure, u as the staircase that it is."""
        y = {"output": (self.t, self.y), "reference": stairs(self.t, self.reference)}
        return shown_once(curves({"output $y$": y, "input $u$": {"u": stairs(self.t, self.u)}}, "Simulation"))

    @property
    def held_input(self) -> Signal:
        """u in continuous time: a staircase."""
        return Signal(self.t, self.u[:-1, None])


def _course(name: str, value: Course, t: np.ndarray) -> np.ndarray:
    if callable(value):
        row = np.array([float(value(float(time))) for time in t])
    else:
        row = np.asarray(value, dtype=float)
        if row.ndim == 0:
            row = np.full(len(t), float(row))
    if row.shape != t.shape:
        raise SimulationError(f"{name} has {row.size} values, the simulation {len(t)} instants: give one for each")
    if not np.isfinite(row).all():
        raise SimulationError(f"{name} is not finite at instant {int(np.flatnonzero(~np.isfinite(row))[0])}")
    return row


def simulate(
    process: Process,
    controller: Controller,
    h: float,
    steps: int,
    *,
    reference: Course = 0.0,
    load: Course = 0.0,
    noise: Course = 0.0,
    output: Course = 0.0,
    limits: tuple[float, float] = (-math.inf, math.inf),
    u_before: float = 0.0,
) -> Simulation:
    """Run the controller for `steps` sampling intervals of h seconds; `steps` + 1 instants are returned.

    reference, load (added to the process input, held over h), noise (added to the measurement), output (added to the
    process output): each a number, one number per instant, or a function of the time [s]. limits: the actuator's range
    (low, high) [u], acting after the controller. u_before: the constant input before t = 0, with the process settled
    there; needs a finite static gain if not zero.
    Raises SimulationError for courses of another length or not finite, empty limits, a controller that returns no
    finite number, and a process that acts at once (no dead time, relative degree 0): its output would depend on the
    input that is computed from it.

    >>> class Half:
    ...     def step(self, y, reference):
    ...         return 0.5 * (reference - y)
    >>> run = simulate(Process([1], [1, 0], delay=1.5), Half(), h=1.0, steps=4, reference=1.0)
    >>> run.y
    array([0.    , 0.    , 0.25  , 0.75  , 1.1875])
    """
    if not (isinstance(steps, int | np.integer) and steps >= 1):
        raise SimulationError(f"steps = {steps!r}: a whole number of sampling intervals, 1 or more, is expected")
    if not limits[0] < limits[1]:
        raise SimulationError(f"limits = {limits!r}: the lower limit must be below the upper one")
    plant = sample(process, h)
    if _acts_at_once(plant):
        raise SimulationError("the process acts at once (no dead time, relative degree 0): an algebraic loop; delay it")
    t = h * np.arange(steps + 1)
    courses = (("reference", reference), ("load", load), ("noise", noise), ("output", output))
    signals = {name: _course(name, course, t) for name, course in courses}
    return _run(plant, controller, t, limits, u_before, _settled(process, plant, u_before), **signals)


def _acts_at_once(plant: SampledProcess) -> bool:
    return bool(plant.plant.D[0, 0]) and plant.whole == 0 and plant.tau == 0


def _run(
    plant: SampledProcess,
    controller: Controller,
    t: np.ndarray,
    limits: tuple[float, float],
    u_before: float,
    x: np.ndarray,
    reference: np.ndarray,
    load: np.ndarray,
    noise: np.ndarray,
    output: np.ndarray,
) -> Simulation:
    """Instant by instant: measure, ask the controller, limit, move on. x: the state at t = 0."""
    (low, high), steps, whole = limits, len(t), plant.whole
    C, D = plant.plant.C[0], float(plant.plant.D[0, 0])
    Phi, newer, older = plant.matrices
    history = np.full(steps + whole + 2, u_before)  # what enters the dead time, from (whole + 1) intervals before t = 0
    first = whole + 1
    newest = int(plant.tau == 0 and whole > 0)  # the place in the history, from k on, of the input that acts at once
    y, u, v = np.empty(steps), np.empty(steps), np.empty(steps)
    states, delayed = np.empty((steps, len(x))), np.empty((steps, 2))
    onwards, from_here = np.column_stack([Phi, older, newer]), np.empty(len(x) + 2)
    for k in range(steps):
        states[k] = x
        y[k] = C @ x + (D * history[k + newest] if D else 0.0) + output[k]
        v[k] = _asked(controller, y[k] + noise[k], reference[k], t[k])
        u[k] = min(max(v[k], low), high)
        history[first + k] = u[k] + load[k]
        delayed[k] = history[k], history[k + 1]
        from_here[: len(x)], from_here[len(x) :] = x, history[k : k + 2]
        x = onwards @ from_here
    return Simulation(t, y, y + noise, u, v, reference, load, plant, states, delayed, output)


def _settled(process: Process, plant: SampledProcess, u_before: float) -> np.ndarray:
    A, B = plant.plant.A, plant.plant.B[:, 0]
    if not u_before:
        return np.zeros(len(A))
    if not math.isfinite(process.static_gain):
        raise SimulationError(f"u_before = {u_before!r}: an integrating process has no rest there; start from 0")
    return np.linalg.solve(A, -B * u_before)


def _asked(controller: Controller, y: float, reference: float, t: float) -> float:
    value = controller.step(float(y), float(reference))
    try:
        number = float(value)
    except (TypeError, ValueError):
        number = math.nan
    if not math.isfinite(number):
        raise SimulationError(f"the controller returned {value!r} at t = {t:g} s: a finite number is expected")
    return number
