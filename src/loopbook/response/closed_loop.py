"""Step responses of processes and closed loops with exact dead time.

The loop is

    u = T/R r - S/R (y + n)            y = B/A exp(-L s) (u + d) + w

r reference, n measurement noise, d load disturbance at the process input, w what a disturbance contributes that enters
elsewhere. All step at t = 0 from rest. What is solved is the loop in units of its own: time in its characteristic time,
u in the unit that makes the process's gain one.
"""

from dataclasses import dataclass

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.numerics import units
from loopbook.numerics.method_of_steps import DelayEquation, ResponseError, solve
from loopbook.numerics.signals import Signal
from loopbook.numerics.state_space import StateSpace, observer_form
from loopbook.process.transfer_function import DelayedSum, Process

SHARED = 1e-12
INPUTS = ("reference", "load", "noise", "disturbance")


def _in_seconds(signal: Signal, time: float, gain: float) -> Signal:
    return Signal(signal.edges * time, signal.coefficients * gain)


def _control(regulator: Regulator, smooth: bool) -> StateSpace:
    """State space of the regulator with inputs (r, n, y, dy/dt) and common poles.

    Where y is smooth (the process does not act at once), S = S(0) + s S' and the regulator takes S' of dy/dt, which the
    process's states give. That spares the difference of two large numbers which a fast derivative filter is otherwise,
    and lets S/R have one zero more than poles.
    """
    if len(regulator.T) > len(regulator.R):
        raise ResponseError(
            "the regulator differentiates the reference without a filter, and the derivative of a step is an impulse: "
            "give the derivative a filter or take it of the measurement only (c = 0)"
        )
    if regulator.excess > 1:
        raise ResponseError(
            f"S/R has {regulator.excess} zeros more than poles: a regulator may differentiate once at most; filter it"
        )
    if regulator.excess == 1 and not smooth:
        raise ResponseError("an unfiltered derivative of a process that acts at once: filter the derivative")
    S, none = regulator.S, (0.0,)
    noise = S if regulator.excess < 1 else none
    level, rate = ((S[-1],), S[:-1] or none) if smooth else (S, none)
    return observer_form(regulator.R, [regulator.T, noise, level, rate])


def _beside(process: Process, path: Process) -> tuple[StateSpace, bool]:
    """State space with inputs (u, w) for y = B/A u + G w; poles that both share stand once. True: all are shared."""
    quotient, remainder = np.polydiv(process.den, path.den)
    shared = len(path.den) <= len(process.den) and np.allclose(
        remainder, 0, rtol=0, atol=SHARED * np.abs(process.den).max()
    )
    if shared:
        return observer_form(process.den, [process.num, tuple(np.polymul(path.num, quotient))]), True
    a, b = observer_form(process.den, [process.num, (0.0,)]), observer_form(path.den, [(0.0,), path.num])
    n, k = len(a.A), len(b.A)
    A = np.block([[a.A, np.zeros((n, k))], [np.zeros((k, n)), b.A]])
    return StateSpace(A, np.vstack([a.B, b.B]), np.hstack([a.C, b.C]), a.D + b.D), False


def loop_equation(process: Process, regulator: Regulator, source: str, path: Process | None) -> DelayEquation:
    """The loop as a delay equation with outputs (u + d, u, y); the first is what passes the dead time."""
    plant, shared = _beside(process, path or Process((0.0,), (1.0,)))
    if path is not None and not shared and (path.poles.real >= -SHARED * abs(path.poles)).any():
        raise ResponseError(
            "the disturbance's path has poles that do not decay and are not the process's own: no regulator can hold it"
        )
    control = _control(regulator, smooth=not plant.D.any())
    if regulator.excess == 1 and source == "noise":
        raise ResponseError(
            "the regulator differentiates the measurement without a filter: a step of the noise gives an impulse"
        )
    r, d, n, w = (float(source == name) for name in INPUTS)
    (b_u, b_w), (d_u, d_w) = plant.B.T, plant.D[0]
    (b_r, b_n, b_y, b_dy), (d_r, d_n, d_y, d_dy) = control.B.T, control.D[0]
    n_p, n_c = len(plant.A), len(control.A)
    # y and dy/dt as (row of states, factor of v, constant)
    y = np.append(plant.C[0], np.zeros(n_c)), d_u, d_w * w
    dy = np.append(plant.C[0] @ plant.A, np.zeros(n_c)), float(plant.C[0] @ b_u), float(plant.C[0] @ b_w) * w
    A = np.block([[plant.A, np.zeros((n_p, n_c))], [np.zeros((n_c, n_p)), control.A]])
    A[n_p:] -= np.outer(b_y, y[0]) + np.outer(b_dy, dy[0])
    b = np.append(b_u, -b_y * y[1] - b_dy * dy[1])
    e = np.append(b_w * w, b_r * r - b_n * n - b_y * y[2] - b_dy * dy[2])
    row = np.append(np.zeros(n_p), control.C[0]) - d_y * y[0] - d_dy * dy[0]
    of_v = -d_y * y[1] - d_dy * dy[1]
    constant = d_r * r - d_n * n - d_y * y[2] - d_dy * dy[2]
    C = np.vstack([row, row, y[0]])
    return DelayEquation(
        A, b, e, C, np.array([of_v, of_v, y[1]]), np.array([constant + d, constant, y[2]]), process.delay
    )


def closed_loop_step(
    process: Process,
    regulator: Regulator,
    source: str,
    horizon: float,
    path: Process | DelayedSum | None = None,
) -> tuple[Signal, Signal]:
    """(y, u) after a unit step of one input at t = 0, on [0, horizon].

    source: "reference", "load", "noise" or "disturbance". path: for a disturbance, its own process to the output.
    Raises ResponseError where the response does not exist or cannot be computed; see `method_of_steps`.
    """
    if source not in INPUTS:
        raise ResponseError(f"source = {source!r}; one of {', '.join(INPUTS)}")
    if source != "disturbance":
        return _InOwnUnits.of(process, regulator).step(source, horizon)
    if path is None:
        raise ResponseError("a disturbance needs the path it takes to the output: Loop(process, regulator, path)")
    loop = _InOwnUnits.of(process, regulator)

    def through(term: Process) -> tuple[Signal, Signal]:
        y, u = loop.step(source, horizon, term.rational)
        return y.delayed(term.delay), u.delayed(term.delay)

    first, *others = path.terms if isinstance(path, DelayedSum) else (path,)
    total = through(first)
    for term in others:
        y, u = through(term)
        total = total[0] + y, total[1] + u
    return total


def _in_own_units(process: Process, time: float) -> tuple[Process, float]:
    num, den, gain = units.ratio_in_units(process.num, process.den, time)
    return Process(num, den, process.delay / time), gain


@dataclass(frozen=True)
class _InOwnUnits:
    """The loop inside: u counted in units of 1/gain, time in units of `time` [s]."""

    process: Process
    regulator: Regulator
    time: float
    gain: float

    @classmethod
    def of(cls, process: Process, regulator: Regulator) -> "_InOwnUnits":
        num, den = np.convolve(regulator.S, process.num).tolist(), np.convolve(regulator.R, process.den).tolist()
        time = units.characteristic_time(num, den, process.delay)
        inside, gain = _in_own_units(process, time)
        T, S, R = (units.in_units(p, time) for p in (regulator.T, regulator.S, regulator.R))
        size = units.size(R)
        T, S = (units.in_units(p, 1.0, size / gain) for p in (T, S))
        return cls(inside, Regulator(T, S, units.in_units(R, 1.0, size)), time, gain)

    def step(self, source: str, horizon: float, path: Process | None = None) -> tuple[Signal, Signal]:
        """(y, u) in seconds and in the units outside."""
        path, of_path = (None, 1.0) if path is None else _in_own_units(path, self.time)
        equation = loop_equation(self.process, self.regulator, source, path)
        _, u, y = solve(equation, horizon / self.time, self.time)
        step = {"load": self.gain, "disturbance": of_path}.get(source, 1.0)
        return _in_seconds(y, self.time, step), _in_seconds(u, self.time, step / self.gain)
