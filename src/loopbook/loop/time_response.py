"""Step, impulse and ramp responses of anything linear, as objects that are called, shown, drawn and compared."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from loopbook.loop.discrete import DiscreteLoop
from loopbook.loop.feedback import transfer_of
from loopbook.loop.roots import dcgain, poles
from loopbook.loop.sampled import SampledLoop
from loopbook.numerics.signals import Signal
from loopbook.plots.curves import curves
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.plots.shown import shown_once
from loopbook.plots.stairs import stairs
from loopbook.process.algebra import LAPLACE, TransferAlgebra
from loopbook.process.horizon import default_horizon
from loopbook.process.rows import ProcessError
from loopbook.response.closed_loop import ResponseError
from loopbook.response.simulation import simulate
from loopbook.response.step_metrics import StepMetrics, StepMetricsError, exact_metrics

KINDS = ("step", "impulse", "ramp")
POINTS = 1200
SAMPLES = 60


@dataclass(frozen=True, repr=False)
class Course(ShortRepr):
    """One response. signal: y in continuous time, None of a sampled system. t, y: as drawn. final: lim y or nan."""

    signal: Signal | None
    t: np.ndarray
    y: np.ndarray
    final: float

    def metrics(self) -> StepMetrics | None:
        """Of a step response in continuous time that settles; else None."""
        if self.signal is None or not np.isfinite(self.final):
            return None
        try:
            return exact_metrics(self.signal, self.final, self.signal.end)
        except StepMetricsError:
            return None


@dataclass(frozen=True, repr=False)
class Response(ShortRepr, ShownAsTable):
    """The response of one system, or of several by name, to one kind of input. Make it with `step_response` and others.

    Called with times [s] it gives y there, of several a mapping of names to y.
    """

    kind: str
    courses: Mapping[str, Course]

    def __call__(self, times: Any) -> Any:
        found = {name: _at(course, times) for name, course in self.courses.items()}
        return found if len(found) > 1 else next(iter(found.values()))

    def __getitem__(self, name: str) -> Course:
        return self.courses[name]

    def table(self) -> PlainTable:
        """Final value, largest magnitude and when, and of steps the metrics."""
        heads = ["final", "peak", "at [s]"]
        heads += ["rise [s]", "settling [s]", "overshoot [%]"] if self.kind == "step" else []
        rows = []
        for name, course in self.courses.items():
            i = int(np.argmax(np.abs(course.y)))
            final = course.final if np.isfinite(course.final) else ""
            row: list[Any] = [name, final, float(course.y[i]), float(course.t[i])]
            if self.kind == "step":
                m = course.metrics()
                row += ["", "", ""] if m is None else [m.rise, m.settling, m.overshoot]
            rows.append(row)
        return PlainTable([f"{self.kind} response", *heads], rows)

    def plot(self) -> Any:
        """All of them over time as a matplotlib figure."""
        unit = {"step": "unit step", "impulse": "unit impulse", "ramp": "ramp of slope 1"}[self.kind]
        return shown_once(
            curves({"output $y$": {name: (c.t, c.y) for name, c in self.courses.items()}}, f"Response to a {unit}")
        )


def step_response(system: Any, horizon: float | None = None) -> Response:
    """The response to a unit step from rest, exact dead time included.

    system: a transfer function, a loop (from the reference to y), a sampled process, or several by name. horizon [s]:
    up to when; by default until the slowest mode has died out.
    Raises ResponseError where the output would be an impulse.

    >>> from loopbook.process.transfer_function import Process
    >>> print(step_response({"lag": Process([2], [3, 1]), "with dead time": Process([2], [3, 1], 2)}))
    step response   final  peak   at [s]  rise [s]  settling [s]  overshoot [%]
    lag             2      1.997  20      6.592     11.74         0
    with dead time  2      1.995  20      6.592     13.74         0
    """
    return _response("step", system, horizon)


def impulse_response(system: Any, horizon: float | None = None) -> Response:
    """The response to a unit impulse from rest (of a sampled system: u = 1, 0, 0, ...); arguments as `step_response`.

    Raises ResponseError where the input acts at once, so that the response begins with an impulse.

    >>> from loopbook.process.transfer_function import Process
    >>> float(impulse_response(Process([1], [2, 1]))(2.0).round(9))
    0.183939721
    """
    return _response("impulse", system, horizon)


def ramp_response(system: Any, horizon: float | None = None) -> Response:
    """The response to u = t from rest; arguments as `step_response`.

    >>> from loopbook.process.transfer_function import Process
    >>> float(ramp_response(Process([1], [2, 1]))(4.0).round(9))
    2.270670566
    """
    return _response("ramp", system, horizon)


def _response(kind: str, system: Any, horizon: float | None) -> Response:
    named = dict(system) if isinstance(system, Mapping) else {"y": system}
    named = {name: one.closed() if isinstance(one, DiscreteLoop) else one for name, one in named.items()}
    if not named:
        raise ResponseError("no system is given")
    if horizon is not None and not (np.isfinite(horizon) and horizon > 0):
        raise ResponseError(f"horizon = {horizon!r} s: a positive number of seconds is expected")
    if horizon is None:
        continuous = [_transfer(one) for one in named.values() if not _is_sampled(one)]
        horizon = max((default_horizon(*one.fraction) for one in continuous), default=None)
    return Response(kind, {name: _course(kind, one, horizon) for name, one in named.items()})


def _is_sampled(system: Any) -> bool:
    return isinstance(system, SampledLoop) or (hasattr(system, "h") and hasattr(system, "response"))


def _transfer(system: Any) -> TransferAlgebra:
    try:
        return transfer_of(system)
    except ProcessError:
        raise ResponseError(f"{type(system).__name__} has no response: give a transfer function or a loop") from None


def _course(kind: str, system: Any, horizon: float | None) -> Course:
    if _is_sampled(system):
        return _of_sampled(kind, system, horizon)
    transfer = _transfer(system)
    num, den = transfer.fraction
    until = default_horizon(num, den) if horizon is None else horizon
    if kind == "impulse":
        if num.degree >= den.degree and not num.is_zero:
            raise ResponseError(
                "the input acts on the output at once: its impulse response begins with an impulse; take the step"
            )
        num = num * LAPLACE
    den = den * LAPLACE if kind == "ramp" else den
    seen = transfer if kind == "step" else transfer.simplest(num, den)
    y = seen.step_signal(until)
    t = np.unique(np.concatenate([np.linspace(0.0, y.end, POINTS), y.edges[y.edges >= 0]]))
    stable = not np.size(rooted := np.asarray(poles(transfer))) or float(rooted.real.max()) < 0
    final = seen.static_gain if stable else float("nan")
    return Course(y, t, y(t), final if np.isfinite(final) else float("nan"))


def _of_sampled(kind: str, system: Any, horizon: float | None) -> Course:
    between = isinstance(system, SampledLoop)
    h = float(system.regulator.h if between else system.h)
    if horizon is None and between:
        horizon = system.default_horizon() / 2
    steps = SAMPLES if horizon is None else max(int(np.ceil(horizon / h)), 1)
    k = np.arange(steps + 1)
    u = {"step": np.ones(len(k)), "impulse": (k == 0).astype(float), "ramp": h * k}[kind]
    settles = kind == "step" and (np.abs(np.asarray(poles(system))) < 1).all()
    if between:
        y = simulate(system.process, system.regulator.controller(), h, steps, reference=u).between
        t = np.unique(np.concatenate([np.linspace(0.0, y.end, POINTS), y.edges[y.edges >= 0]]))
        return Course(y, t, y(t), final=dcgain(system) if settles else float("nan"))
    return Course(None, *stairs(h * k, system.response(u)), final=dcgain(system) if settles else float("nan"))


def _at(course: Course, times: Any) -> np.ndarray:
    if course.signal is not None:
        return course.signal(times)
    at = np.asarray(times, dtype=float)
    found = np.searchsorted(course.t, at, side="right") - 1
    return np.where(at < 0, 0.0, course.y[np.clip(found, 0, len(course.y) - 1)])
