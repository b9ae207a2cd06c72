"""Step responses of processes and closed loops with exact dead time.

The loop is

    u = T/R r - S/R (y + n)            y = B/A exp(-L s) (u + d) + w

r reference, n measurement noise, d load disturbance at the process input, w what a disturbance contributes that enters
elsewhere. All step at t = 0 from rest.
"""

import numpy as np

from loopbook.method_of_steps import DelayEquation, ResponseError, solve
from loopbook.process import DelayedSum, Process
from loopbook.regulator import Regulator
from loopbook.signals import Signal
from loopbook.state_space import StateSpace, observer_form

INPUTS = ("reference", "load", "noise", "disturbance")


def open_loop_step(process: Process, horizon: float) -> Signal:
    """The unit step response of num/den without its dead time, on [0, horizon]."""
    plant = observer_form(process.den, [process.num])
    zero = np.zeros(2)
    row = np.vstack([np.zeros(plant.C.shape), plant.C])
    equation = DelayEquation(plant.A, 0 * plant.B[:, 0], plant.B[:, 0], row, zero, np.array([0, plant.D[0, 0]]), 0.0)
    return solve(equation, max(horizon, 1e-9))[1]


def _split(regulator: Regulator) -> tuple[float, StateSpace]:
    """S/R = k s + S1/R with a proper S1/R, and the state space with inputs (r, -(y + n))."""
    if len(regulator.T) > len(regulator.R):
        raise ResponseError(
            "the regulator differentiates the reference without a filter, and the derivative of a step is an impulse: "
            "give the derivative a filter or take it of the measurement only (c = 0)"
        )
    if regulator.excess > 1:
        raise ResponseError(
            f"S/R has {regulator.excess} zeros more than poles: a regulator may differentiate once at most; filter it"
        )
    S, slope = regulator.S, 0.0
    if regulator.excess == 1:
        slope = S[0] / regulator.R[0]
        S = tuple(np.polysub(S, slope * np.append(regulator.R, 0.0))[1:])
    return slope, observer_form(regulator.R, [regulator.T, S])


def _beside(process: Process, path: Process) -> tuple[StateSpace, bool]:
    """State space with inputs (u, w) for y = B/A u + G w; poles that both share stand once. True: all are shared."""
    quotient, remainder = np.polydiv(process.den, path.den)
    shared = len(path.den) <= len(process.den) and np.allclose(
        remainder, 0, rtol=0, atol=1e-12 * np.abs(process.den).max()
    )
    if shared:
        return observer_form(process.den, [process.num, tuple(np.polymul(path.num, quotient))]), True
    a, b = observer_form(process.den, [process.num, (0.0,)]), observer_form(path.den, [(0.0,), path.num])
    n, k = len(a.A), len(b.A)
    A = np.block([[a.A, np.zeros((n, k))], [np.zeros((k, n)), b.A]])
    return StateSpace(A, np.vstack([a.B, b.B]), np.hstack([a.C, b.C]), a.D + b.D), False


def _equation(process: Process, regulator: Regulator, source: str, path: Process | None) -> DelayEquation:
    """The loop as a delay equation with outputs (u + d, u, y); the first is what passes the dead time."""
    slope, control = _split(regulator)
    plant, shared = _beside(process, path or Process((0.0,), (1.0,)))
    if path is not None and not shared and (path.poles.real > -1e-12).any():
        raise ResponseError(
            "the disturbance's path has poles that do not decay and are not the process's own: no regulator can hold it"
        )
    if slope and plant.D.any():
        raise ResponseError("an unfiltered derivative of a process that acts at once: filter the derivative")
    if slope and source == "noise":
        raise ResponseError(
            "the regulator differentiates the measurement without a filter: a step of the noise gives an impulse"
        )
    r, d, n, w = (float(source == name) for name in INPUTS)
    n_p, n_c = len(plant.A), len(control.A)
    b_u, b_w, d_u, d_w = plant.B[:, 0], plant.B[:, 1], plant.D[0, 0], plant.D[0, 1]
    b_r, b_y, d_r, d_y = control.B[:, 0], control.B[:, 1], control.D[0, 0], control.D[0, 1]
    y_x = np.append(plant.C[0], np.zeros(n_c))
    y_rate = np.append(plant.C[0] @ plant.A, np.zeros(n_c))
    A = np.block(
        [[plant.A, np.zeros((n_p, n_c))], [np.zeros((n_c, n_p)), control.A]],
    )
    A[n_p:] -= np.outer(b_y, y_x)
    b = np.append(b_u, -b_y * d_u)
    e = np.append(b_w * w, b_r * r - b_y * (d_w * w + n))
    u_x = np.append(np.zeros(n_p), control.C[0]) - d_y * y_x - slope * y_rate
    u_v = -d_y * d_u - slope * float(plant.C[0] @ b_u)
    u_1 = d_r * r - d_y * (d_w * w + n) - slope * float(plant.C[0] @ b_w) * w
    C = np.vstack([u_x, u_x, y_x])
    return DelayEquation(A, b, e, C, np.array([u_v, u_v, d_u]), np.array([u_1 + d, u_1, d_w * w]), process.delay)


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
        _, u, y = solve(_equation(process, regulator, source, None), horizon)
        return y, u
    if path is None:
        raise ResponseError("a disturbance needs the path it takes to the output: Loop(process, regulator, path)")
    total: tuple[Signal, Signal] | None = None
    for term in path.terms if isinstance(path, DelayedSum) else (path,):
        _, u, y = solve(_equation(process, regulator, source, term.rational), horizon)
        pair = y.delayed(term.delay), u.delayed(term.delay)
        total = pair if total is None else (total[0] + pair[0], total[1] + pair[1])
    return total
