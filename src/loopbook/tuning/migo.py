"""MIGO: the PI and PID regulators of largest integral gain for a given robustness.

Maximise ki = K/Ti subject to |C + L(i w)| >= R for all w: the Nyquist curve of L = G (k + ki/s + kd s) stays out of the
circle that encloses both the Ms and the Mp circle of value M (`derivations.loop.robustness.joint_circle`).

Where the curve touches the circle smoothly, k, ki and kd are explicit functions of the touching frequency w
(`derivations.loop.robustness.smooth_branch`). So the optimum needs no search in three dimensions:

    PI    kd(w) = 0, on the rising branch: one root of one function
    PID   kd and ki both grow with w; follow w upwards until the curve touches the circle a second time, at w2

The second touch is the largest kd whose smooth optimum is feasible for all frequencies. Larger ki exist beyond it, on
the edge where two frequencies bind at once, with erratic responses; the method leaves them out on purpose.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from derivations.tuning.takes import Takes
from loopbook.controllers.pid_forms import PidStandard
from loopbook.loop.process_phase import NoSuchFrequency, frequency_at, phase
from loopbook.loop.stability import unstable_roots
from loopbook.loop.transfer import LoopTransfer
from loopbook.process.transfer_function import Process
from loopbook.tuning.migo_branch import (
    M_DEFAULT,
    TOLERANCE,
    circle,
    clearance,
    deepest,
    kd_limit,
    smooth_branch,
)
from loopbook.tuning.result import RuleDoesNotApply, Tuning
from loopbook.tuning.rule import TuningRule
from loopbook.tuning.second_touch import least_room

__all__ = ["M_DEFAULT", "Migo", "circle", "clearance", "computed", "is_stable", "pi", "pid", "smooth_branch"]

ON_AXIS = 1e-9
SOURCE = "Åström, Panagopoulos, Hägglund (1998, 2002); pid-report, section 5.3"


@dataclass(frozen=True)
class Migo(Tuning):
    """A MIGO optimum.

    M: the joint robustness asked for. touches: the frequencies [rad/s] at which the Nyquist curve touches the circle
    (inf where dead time turns a loop gain that does not fade). stable: by the argument count of the loop.
    """

    M: float = M_DEFAULT
    touches: tuple[float, ...] = ()
    stable: bool = False


def pi(process: Process, M: float = M_DEFAULT) -> Migo:
    """The PI regulator of largest ki for the joint robustness M.

    process: with or without dead time, stable or integrating. Returns standard form; K [u/y], Ti [s].
    Raises RuleDoesNotApply where no smooth optimum exists, or where another frequency enters the circle before it.

    >>> best = pi(Process((1.0,), (1.0, 3.0, 3.0, 1.0)))
    >>> round(best.K, 3), round(best.Ti, 2)
    (0.606, 2.09)
    """
    w = _pi_touch(process, _reference(process), M)
    k, ki, _ = smooth_branch(process, np.array(w), M)
    return _result(process, "migo-pi", M, (k, ki, 0.0), (w,))


def pid(process: Process, M: float = M_DEFAULT) -> Migo:
    """The PID regulator of largest kd whose smooth optimum keeps the joint robustness M at all frequencies.

    process: with or without dead time, stable or integrating. The derivative has no filter. Returns standard form.
    Raises RuleDoesNotApply as `pi` does, and where ki grows without bound (second order without dead time).

    >>> best = pid(Process((1.0,), (1.0, 3.0, 3.0, 1.0)))
    >>> round(best.K, 2), round(best.Ti, 2), round(best.Td, 2)
    (2.63, 1.49, 0.91)
    """
    scale = _reference(process)
    if not kd_limit(process, M):
        raise RuleDoesNotApply("MIGO PID: the process answers at once, and derivative action has no gain that it bears")
    start = _pi_touch(process, scale, M)
    low, high, second = _first_violation(process, scale, start, _branch_end(process, start, M), M)
    if math.isinf(second):
        w = _where_derivative_is(process, kd_limit(process, M), low, high, M)
    else:
        w, second = _second_touch(process, scale, start, low, high, second, M)
    return _result(process, "migo-pid", M, tuple(smooth_branch(process, np.array(w), M)), (w, second))


def _pi_touch(process: Process, scale: float, M: float) -> float:
    """The touching frequency of the PI optimum, once it is known to be feasible."""
    w = _pi_frequency(process, scale, M)
    k, ki, _ = smooth_branch(process, np.array(w), M)
    worst, at = deepest(process, scale, np.array([[k], [ki], [0.0]]), M)
    if worst[0] < -TOLERANCE:
        raise RuleDoesNotApply(
            f"MIGO PI: the smooth optimum K = {k:.4g}, ki = {ki:.4g} enters the M = {M} circle at {at[0]:.4g} rad/s; "
            "its largest ki lies on an edge where two frequencies bind"
        )
    return w


def _reference(process: Process) -> float:
    """A frequency that scales all grids: where the phase is -150 degrees."""
    if not process.num[-1] / process.den[np.flatnonzero(process.den)[-1]] > 0:
        raise RuleDoesNotApply("MIGO: the gain of the process is not positive; change the sign of u, tune, change back")
    if (process.poles.real > ON_AXIS * abs(process.poles)).any():
        raise RuleDoesNotApply(f"MIGO: the process is unstable by itself, poles {process.poles}")
    try:
        return frequency_at(process, math.radians(-150))
    except NoSuchFrequency as error:
        raise RuleDoesNotApply(f"MIGO: {error}, so ki has no finite optimum") from None


def _pi_frequency(process: Process, scale: float, M: float) -> float:
    """The touching frequency of the PI optimum: where kd(w) rises through zero with positive gains."""
    from scipy.optimize import brentq

    w = scale * np.logspace(-3, 0.7, 400)
    k, ki, kd = smooth_branch(process, w, M)
    below_ultimate = phase(process, w) > -math.pi  # above it the loops on the branch are unstable
    rising = np.flatnonzero((kd[:-1] <= 0) & (kd[1:] > 0) & (ki[1:] > 0) & (k[1:] > 0) & below_ultimate[1:])
    if not rising.size:
        raise RuleDoesNotApply("MIGO PI: ki has no smooth maximum under this robustness")
    best = rising[np.argmax(ki[rising])]
    return float(
        brentq(
            lambda x: smooth_branch(process, np.array(x), M)[2], w[best], w[best + 1], xtol=1e-15 * w[best], rtol=1e-14
        )
    )


def _branch_end(process: Process, start: float, M: float) -> float:
    """How far the branch goes up from the PI optimum: kd rises and ki is positive."""
    w = start * np.logspace(0, 2.5, 800)
    _, ki, kd = smooth_branch(process, w, M)
    turned = np.flatnonzero((np.diff(kd) < 0) | (ki[1:] <= 0))
    return float(w[turned[0]] if turned.size else w[-1])


def _first_violation(process: Process, scale: float, start: float, end: float, M: float) -> tuple[float, float, float]:
    """A bracket (feasible, infeasible) of touching frequencies on the branch, and where the curve enters the circle."""
    low, high, second = start, end, math.nan
    while high / low > 1.002:
        w = np.geomspace(low, high, 24)[1:]
        depth, at = deepest(process, scale, smooth_branch(process, w, M), M)
        bad = np.flatnonzero(depth < -TOLERANCE)
        if not bad.size:
            if math.isnan(second):
                raise RuleDoesNotApply("MIGO PID: no second touch, ki grows with kd without bound")
            return float(w[-2]), float(w[-1]), second
        first = bad[0]
        high, second = float(w[first]), float(at[first])
        low = float(w[first - 1]) if first else low
    return low, high, second


def _where_derivative_is(process: Process, kd: float, low: float, high: float, M: float) -> float:
    """The touching frequency in (low, high) at which the branch has the derivative gain kd."""
    from scipy.optimize import brentq

    return float(
        brentq(lambda w: smooth_branch(process, np.array(w), M)[2] - kd, low, high, xtol=1e-15 * low, rtol=1e-13)
    )


def _second_touch(
    process: Process, scale: float, start: float, low: float, high: float, near: float, M: float
) -> tuple[float, float]:
    """The touching frequencies w and w2 where the smallest clearance around w2 is exactly zero.

    Dead time brings the curve past the circle once a turn, and the grid may have seen the wrong turn first. So the
    settings found are looked at once more, eight times as densely, and the deeper turn is taken if there is one.
    """
    from scipy.optimize import brentq

    for _ in range(5):
        at_low, near = least_room(process, low, near, M)
        if at_low <= 0:
            low, high = start, low
        room = lambda x: least_room(process, x, near, M, known=True)[0]  # noqa: E731, B023
        if not room(low) > 0 > room(high):
            return _bisected(process, scale, start, high, M)
        w = float(brentq(room, low, high, xtol=1e-15 * low, rtol=1e-13))
        depth, at = deepest(process, scale, smooth_branch(process, np.array([w]), M), M, density=8)
        if depth[0] >= -TOLERANCE:
            return w, least_room(process, w, near, M)[1]
        near, high = float(at[0]), w
    return _bisected(process, scale, start, high, M)


def _bisected(process: Process, scale: float, low: float, high: float, M: float) -> tuple[float, float]:
    """The same by halving between a feasible and an infeasible touching frequency.

    For a curve whose second touch grows out of the first one, where there is no clearance between them to solve for.
    """
    second = high
    for _ in range(50):
        middle = math.sqrt(low * high)
        depth, at = deepest(process, scale, smooth_branch(process, np.array([middle]), M), M, density=4)
        if depth[0] < -TOLERANCE:
            high, second = middle, float(at[0])
        else:
            low = middle
    return low, second


def _result(process: Process, rule: str, M: float, gains: tuple[float, float, float], touches: Iterable[float]) -> Migo:
    k, ki, kd = map(float, gains)
    if not (k > 0 and ki > 0 and kd >= 0):
        raise RuleDoesNotApply(f"{rule}: the smooth optimum has K = {k:.4g}, ki = {ki:.4g}, kd = {kd:.4g}")
    settings = PidStandard(K=k, Ti=k / ki, Td=kd / k, b=0.0)
    stable = is_stable(process, settings)
    if not stable:
        raise RuleDoesNotApply(f"{rule}: the loop with {settings} is unstable by its argument count")
    return Migo(settings, rule, SOURCE, M=M, touches=tuple(map(float, touches)), stable=stable)


def is_stable(process: Process, regulator: PidStandard) -> bool:
    """Are all roots of the loop to the left of the imaginary axis, by its argument count?"""
    num, den = regulator.transfer()
    loop = LoopTransfer(tuple(np.polymul(num, process.num)), tuple(np.polymul(den, process.den)), process.delay)
    return unstable_roots(loop) == 0


def computed() -> tuple[TuningRule, ...]:
    """Both optima as rules of the family."""
    return tuple(
        TuningRule(
            *(f"migo-{design.__name__}", f"MIGO, {design.__name__.upper()}", Takes.PROCESS, design.__name__.upper()),
            *(None, "load, a given robustness M", 1998, SOURCE),
            settings=lambda data, design=design, **options: design(data.upright(), **options),
            options={"M": f"the joint robustness, default {M_DEFAULT}"},
            text="maximise K/Ti subject to |C + L(i w)| >= R for all w",
        )
        for design in (pi, pid)
    )
