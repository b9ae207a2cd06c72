"""A loop's margins, its Bode and its Nyquist diagram: of a process, a continuous loop or a sampled one."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.loop import margins as continuous_margins
from loopbook.loop.continuous import Loop
from loopbook.loop.margins import Margins
from loopbook.loop.sampled import SampledLoop, SampledMargins
from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.plots.frequency import Curve, bode_figure, nyquist_curves
from loopbook.plots.shown import shown_once
from loopbook.process.sampled import SampledProcess
from loopbook.process.transfer_function import Process

if TYPE_CHECKING:
    from matplotlib.figure import Figure

DECADES = 1.5  # beyond the outermost corner
TURN = 0.1  # rad of dead-time phase between neighbouring points


def margins(loop: Loop | SampledLoop) -> Margins | SampledMargins:
    """Gain, phase and delay margins with Ms and Mt of a stable loop; prints and displays as a table.

    Raises LoopError for an unstable loop, which has none.

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> print(margins(Loop(Process.fopdt(2, 10, 3), PidStandard(0.5, 10))))
    margin     value  at [rad/s]
    gain       5.236  0.5236
    phase [°]  72.81  0.1
    delay [s]  12.71  0.1
    Ms         1.307  0.333
    Mt         1      0
    """
    return loop.margins()


def bode(system: Any, w: Sequence[float] | None = None, title: str = "Bode diagram") -> "Figure":
    """Gain and phase with exact dead time, as a matplotlib figure; of a loop the loop transfer with its margins.

    system: a `Process`, `Loop`, `SampledProcess` or `SampledLoop`, a PID form or a regulator, or several by name in a
    mapping. w [rad/s]: the frequencies; by default all that have corners and crossovers in them.

    >>> bode(Process.fopdt(2, 10, 3)).axes[0].get_ylabel()
    'gain'
    """
    return shown_once(bode_figure(_curves(system, w), title))


def nyquist(system: Any, w: Sequence[float] | None = None, title: str = "Nyquist diagram") -> "Figure":
    """The curve around -1 with the margins, and the circle that it touches for its Ms; arguments as for `bode`.

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> len(nyquist(Loop(Process.fopdt(2, 10, 3), PidStandard(0.5, 10))).axes)
    1
    """
    return shown_once(nyquist_curves(_curves(system, w), title))


def _curves(system: Any, w: Sequence[float] | None) -> dict[str, Curve]:
    named = dict(system) if isinstance(system, Mapping) else {"loop transfer": system}
    return {name: _curve(one, None if w is None else np.asarray(w, dtype=float)) for name, one in named.items()}


def _curve(system: Any, w: np.ndarray | None) -> Curve:
    if isinstance(system, SampledLoop | SampledProcess):
        return _of_sampled(system, w)
    if isinstance(system, Loop):
        transfer = system.transfer
    elif isinstance(system, Process):
        transfer = LoopTransfer(system.num, system.den, system.delay)
    else:
        regulator = Regulator.of(system)
        transfer = LoopTransfer(regulator.S, regulator.R)
    w = _frequencies(transfer) if w is None else w
    value = transfer(1j * w)
    if not isinstance(system, Loop):
        return Curve(w, abs(value), np.degrees(np.unwrap(np.angle(value))))
    at_gain = [(c.w, c.phase_margin) for c in continuous_margins.gain_crossovers(transfer)]
    at_phase = [(c.w, c.gain) for c in continuous_margins.phase_crossovers(transfer)]
    try:
        Ms = system.margins().Ms
        peak = (Ms.w, Ms.value)
    except LoopError:
        peak = None
    return Curve(w, abs(value), np.degrees(np.unwrap(np.angle(value))), at_phase, at_gain, peak)


def _frequencies(transfer: LoopTransfer) -> np.ndarray:
    """From below the lowest corner to above the highest, dense enough for the turns of a dead time."""
    corners = [abs(r) for r in (*transfer.poles, *transfer.zeros) if abs(r) > 0] + list(transfer.gain_crossovers)
    corners += [1 / transfer.delay] if transfer.delay else []
    low, high = min(corners, default=1.0) / 10**DECADES, max(corners, default=1.0) * 10**DECADES
    if transfer.delay:
        high = min(high, max(8 / transfer.delay, 3 * max(transfer.gain_crossovers, default=0.0)))
    w = np.geomspace(low, high, 600)
    if transfer.delay:
        w = np.union1d(w, np.arange(TURN, high * transfer.delay, TURN) / transfer.delay)
    return w


def _of_sampled(system: SampledLoop | SampledProcess, w: np.ndarray | None) -> Curve:
    h = system.regulator.h if isinstance(system, SampledLoop) else system.h
    w = np.geomspace(1e-3, 1.0, 1200) * math.pi / h if w is None else w
    if isinstance(system, SampledProcess):
        value = system(np.exp(1j * w * h))
        return Curve(w, abs(value), np.degrees(np.unwrap(np.angle(value))))
    value = system.at(w * h)
    at_gain = [(float(x), float(np.degrees(np.angle(-system.at(np.array(x * h)))))) for x in system.gain_crossovers]
    at_phase = [(float(x), float(1 / abs(system.at(np.array(x * h))))) for x in system.phase_crossovers if x > 0]
    Ms = system.margins().Ms if system.is_stable else None
    peak = (Ms.w, Ms.value) if Ms is not None else None
    return Curve(w, abs(value), np.degrees(np.unwrap(np.angle(value))), at_phase, at_gain, peak)
