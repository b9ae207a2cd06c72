"""PID settings that follow the output, on the nonlinear plant y'' = -y' - sqrt(y) + u.

The plant, its linear models and the characteristic polynomials are those of `derivations.plants.gain_scheduling`. For y
< 0 the root is taken as zero: the plant's equation has no real value there, and a run that undershoots zero must not
become complex. Responses are integrated with an adaptive method (relative tolerance 1e-9), steps of the input or the
set-point are segment borders.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, cached_property, partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from derivations.errors import LoopbookError
from derivations.plants import gain_scheduling as g
from loopbook.experiments.data import StepData
from loopbook.experiments.two_points import PARTS, fit

if TYPE_CHECKING:
    from sympy import Expr

STRUCTURES = ("inside", "outside")
ACTS_ON = ("error", "measurement")
TOLERANCE = 1e-9
RUNAWAY = 1e3


class ScheduleError(LoopbookError):
    """A schedule or a run that cannot be: the message says what is wrong and where."""


@dataclass(frozen=True)
class Schedule:
    """K [u/y], Ti [s], Td [s] as SymPy expressions of the output `derivations.plants.gain_scheduling.y`, or numbers.

    >>> Schedule.fixed(2.88, 1.1, 0.275).at(4.0)
    (2.88, 1.1, 0.275)
    """

    K: "Expr | float"
    Ti: "Expr | float"
    Td: "Expr | float"

    @classmethod
    def fixed(cls, K: float, Ti: float, Td: float) -> "Schedule":
        """The same settings everywhere."""
        return cls(K, Ti, Td)

    @classmethod
    def parabolas(cls, outputs: Sequence[Any], settings: Sequence[Sequence[Any]]) -> "Schedule":
        """Parabolas through three settings (K, Ti, Td) at three outputs; exact for Fractions and integers.

        Raises ScheduleError unless there are three of each and the outputs differ.
        """
        import sympy

        if len(outputs) != 3 or len(settings) != 3 or len(set(outputs)) != 3:
            raise ScheduleError(f"a parabola needs three different outputs with settings, got {list(outputs)}")
        columns = zip(*settings, strict=True)
        rational = partial(sympy.nsimplify, rational=True)
        return cls(*(g.parabola(list(zip(map(rational, outputs), map(rational, c), strict=True))) for c in columns))

    @cached_property
    def _function(self) -> Callable[..., tuple[float, float, float]]:
        import sympy

        return sympy.lambdify(g.y, [sympy.sympify(e, strict=True) for e in (self.K, self.Ti, self.Td)], modules="math")

    def at(self, output: float) -> tuple[float, float, float]:
        """(K, Ti, Td) at one output."""
        K, Ti, Td = map(float, self._function(output))
        return K, Ti, Td

    def poles(self, output: float, structure: str = "inside") -> np.ndarray:
        """Poles of the loop linearised at the steady state with this output > 0 [rad/s], ideal derivative."""
        _known(structure, STRUCTURES, "structure")
        stiffness, coefficients = _linear_loop()
        slope = float(self._slope(output)) if structure == "outside" else 0.0
        return np.roots(coefficients(*self.at(output), stiffness(output), slope, output)).astype(complex)

    @cached_property
    def _slope(self) -> Callable[..., Any]:
        import sympy

        return sympy.lambdify(
            g.y,
            sympy.log(sympy.sympify(self.K, strict=True) / sympy.sympify(self.Ti, strict=True)).diff(g.y),
            modules="math",
        )

    def is_stable(self, output: float, structure: str = "inside") -> bool:
        """Is the loop linearised at this output asymptotically stable?"""
        return bool(np.all(self.poles(output, structure).real < 0))


@cache
def _linear_loop() -> tuple[Callable[..., Any], Callable[..., Any]]:
    import sympy

    rows = sympy.Poly(g.characteristic_outside(), g.s).all_coeffs()
    stiffness = sympy.lambdify(g.y0, g.stiffness(), modules="math")
    return stiffness, sympy.lambdify((g.K, g.Ti, g.Td, g.c, g.g, g.y0), rows, modules="math")


@cache
def _acceleration() -> Callable[..., Any]:
    import sympy

    compute = sympy.lambdify((g.y, g.v, g.u), g.acceleration(), modules="math")
    return lambda output, rate, control: compute(max(output, 0.0), rate, control)


@cache
def _static() -> Callable[..., Any]:
    import sympy

    return sympy.lambdify(g.u, g.static_output(), modules="math")


def static_output(control: float) -> float:
    """The output that a constant input >= 0 holds. Raises ScheduleError for a negative input, which holds none.

    >>> static_output(3.0)
    9.0
    """
    if control < 0:
        raise ScheduleError(f"u = {control:g}: the plant has no steady state for a negative input")
    return float(_static()(control))


def _known(value: str, names: tuple[str, ...], what: str) -> None:
    if value not in names:
        raise ScheduleError(f"{what} = {value!r}; one of {', '.join(names)}")


@dataclass(frozen=True)
class ScheduledRun:
    """Samples of one run: t [s], y, its rate v = y', u, and the step input or set-point w; all of one shape.

    diverged: |y| passed 1000 and the run stopped there.
    """

    t: np.ndarray
    y: np.ndarray
    v: np.ndarray
    u: np.ndarray
    w: np.ndarray
    diverged: bool

    def between(self, start: float, end: float) -> "ScheduledRun":
        """The samples with start <= t < end; an instant where a step acts appears with the values after it."""
        chosen = (self.t >= start) & (self.t < end)
        t, y, v, u, w = (row[chosen] for row in (self.t, self.y, self.v, self.u, self.w))
        return ScheduledRun(t, y, v, u, w, self.diverged)


def _segments(steps: Sequence[tuple[float, float]], horizon: float) -> list[tuple[float, float, float]]:
    if not steps or steps[0][0] != 0 or any(b[0] <= a[0] for a, b in pairwise(steps)):
        raise ScheduleError(f"steps are (time, level) with increasing times from 0, got {list(steps)}")
    if horizon <= steps[-1][0]:
        raise ScheduleError(f"horizon = {horizon:g} s must lie after the last step at {steps[-1][0]:g} s")
    ends = [t for t, _ in steps[1:]] + [horizon]
    return [(start, end, level) for (start, level), end in zip(steps, ends, strict=True)]


def _integrate(
    derivatives: Callable[..., Any],
    kick: Callable[..., Any],
    control: Callable[..., Any],
    steps: Sequence[tuple[float, float]],
    horizon: float,
    points: int,
) -> ScheduledRun:
    from scipy.integrate import solve_ivp

    def ran_away(t: float, state: np.ndarray, *_: Any) -> float:
        return abs(state[0]) - RUNAWAY

    ran_away.terminal = True  # type: ignore[attr-defined]  # how SciPy is told
    state, level, parts, diverged = np.zeros(3), 0.0, [], False
    for start, end, now in _segments(steps, horizon):
        state = kick(state, now - level)
        level = now
        grid = np.linspace(start, end, max(2, round(points * (end - start) / horizon)) + 1)
        options = {"rtol": TOLERANCE, "atol": 1e-11, "events": ran_away, "t_eval": grid, "method": "DOP853"}
        found = solve_ivp(derivatives, (start, end), state, args=(level,), **options)
        controls = [control(x, level) for x in found.y.T]
        parts.append(np.vstack([found.t, found.y[0], found.y[1], controls, np.full(found.t.size, level)]))
        if found.status != 0:
            diverged = True
            break
        state = found.y[:, -1]
        parts[-1] = parts[-1][:, :-1] if end < horizon else parts[-1]
    t, y, v, u, w = np.hstack(parts)
    return ScheduledRun(t, y, v, u, w, diverged)


def open_loop(steps: Sequence[tuple[float, float]], horizon: float, points: int = 4500) -> ScheduledRun:
    """The plant from rest at y = 0 under a staircase input.

    steps: (time [s], level of u), the first at 0. horizon [s]. points: samples over the whole horizon.

    >>> float(open_loop([(0, 1.0)], 60).y[-1].round(6))
    1.0
    """
    accelerate = _acceleration()
    return _integrate(
        lambda t, x, u: (x[1], accelerate(x[0], x[1], u), 0.0),
        lambda x, jump: x,
        lambda x, u: u,
        steps,
        horizon,
        points,
    )


def crossing(steps: Sequence[tuple[float, float]], level: float, after: float) -> float:
    """The first instant after `after` [s] at which the plant under a staircase input rises through `level`.

    Refined to rounding by integrating from the last grid point. Raises ScheduleError where it does not get there
    within 100 s.
    """
    from scipy.interpolate import CubicHermiteSpline
    from scipy.optimize import brentq

    run = open_loop(steps, after + 100.0, points=round(50 * (after + 100.0)))
    above = np.flatnonzero((run.t > after) & (run.y >= level))
    if not above.size:
        raise ScheduleError(f"the output does not reach {level:g} within 100 s after {after:g} s")
    i = int(above[0])
    curve = CubicHermiteSpline(run.t[i - 1 : i + 1], run.y[i - 1 : i + 1], run.v[i - 1 : i + 1])
    return float(brentq(lambda t: float(curve(t)) - level, run.t[i - 1], run.t[i], xtol=1e-12))


def closed_loop(
    schedule: Schedule,
    steps: Sequence[tuple[float, float]],
    horizon: float,
    structure: str = "inside",
    derivative: str = "error",
    points: int = 4500,
) -> ScheduledRun:
    """The plant from rest under a PID regulator with scheduled settings and an ideal derivative.

        inside    u = K (e + Td e') + z,  z' = K/Ti e          outside   u = K (e + Td e' + q/Ti),  q' = e

    steps: (time [s], set-point), the first at 0. derivative: "error", where each jump of the set-point by dw kicks y'
    by K Td dw at once (the area of the impulse in u), or "measurement", without it. u has no limits.
    Raises ScheduleError for unknown names, unordered steps, and where a schedule gives Ti = 0 on the way.
    """
    _known(structure, STRUCTURES, "structure")
    _known(derivative, ACTS_ON, "derivative")
    accelerate, at, inside = _acceleration(), schedule.at, structure == "inside"

    def control(x: np.ndarray, w: float) -> float:
        K, Ti, Td = at(x[0])
        return K * (w - x[0] - Td * x[1]) + (x[2] if inside else K / Ti * x[2])

    def derivatives(t: float, x: np.ndarray, w: float) -> tuple[float, float, float]:
        K, Ti, _ = at(x[0])
        error = w - x[0]
        return x[1], accelerate(x[0], x[1], control(x, w)), K / Ti * error if inside else error

    def kick(x: np.ndarray, jump: float) -> np.ndarray:
        K, _, Td = at(x[0])
        return x + np.array([0.0, K * Td * jump, 0.0]) if derivative == "error" else x

    return _integrate(derivatives, kick, control, steps, horizon, points)


def local_model(u_from: float, u_to: float, settle: float = 80.0) -> StepData:
    """The first-order model with dead time (`experiments.data.StepData`) of the plant for one step of its input.

    u_from >= 0, u_to > u_from [u]. settle [s]: how long the plant rests at u_from before the step.
    Raises ScheduleError for other inputs: the plant has no steady state for u < 0.
    """
    if not 0 <= u_from < u_to:
        raise ScheduleError(f"the step goes from u = {u_from:g} to {u_to:g}; it must rise and start at 0 or above")
    low, high = static_output(u_from), static_output(u_to)
    start = settle if u_from else 0.0
    steps = [(0, u_from), (settle, u_to)] if u_from else [(0, u_to)]
    t1, t2 = (crossing(steps, low + part * (high - low), start) - start for part in PARTS)
    return fit((high - low) / (u_to - u_from), t1, t2)


def overshoots(run: ScheduledRun, steps: Sequence[tuple[float, float]]) -> list[float]:
    """Overshoot of each step of the set-point in % of that step; infinite where the run diverged during it."""
    ends = [t for t, _ in steps[1:]] + [float("inf")]
    found, before = [], 0.0
    for (start, level), end in zip(steps, ends, strict=True):
        part = run.between(start, end)
        lost = run.diverged and run.t[-1] < end
        found.append(float("inf") if lost else float(max(0.0, 100 * (part.y.max() - level) / (level - before))))
        before = level
    return found
