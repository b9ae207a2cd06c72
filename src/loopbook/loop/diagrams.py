"""A loop's margins, its Bode and its Nyquist diagram: of a process, a continuous loop or a sampled one."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.loop import margins as continuous_margins
from loopbook.loop.discrete import DiscreteLoop
from loopbook.loop.frequency_curves import of_pulses, of_sums, of_transfer
from loopbook.loop.general import GeneralLoop
from loopbook.loop.margins import Margins
from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.plots.frequency import Curve, bode_figure, nyquist_curves
from loopbook.plots.shown import shown_once
from loopbook.process.algebra import TransferAlgebra
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.sampled import SampledProcess
from loopbook.process.transfer_function import Process

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def margins(loop: Any) -> Margins:
    """Gain, phase and delay margins with Ms and Mt of a stable loop; prints and displays as a table.

    loop: any loop; or a transfer function, continuous or in z, as the loop transfer itself. Raises LoopError for an
    unstable loop, which has none: `crossovers` shows where its gain passes 1 and its phase -180 degrees.

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> from loopbook.loop.continuous import Loop
    >>> print(margins(Loop(Process.fopdt(2, 10, 3), PidStandard(0.5, 10))))
    margin     value  at [rad/s]
    gain       5.236  0.5236
    phase [°]  72.81  0.1
    delay [s]  12.71  0.1
    Ms         1.307  0.333
    Mt         1      0
    """
    if isinstance(loop, Process):
        return continuous_margins.margins(LoopTransfer(loop.num, loop.den, loop.delay))
    if isinstance(loop, DiscreteProcess | SampledProcess):
        loop = DiscreteLoop(loop)
    if isinstance(loop, TransferAlgebra):
        loop = GeneralLoop(loop, 1.0)
    if not hasattr(loop, "margins"):
        raise LoopError(f"{type(loop).__name__} has no margins: give a loop, or a process as its loop transfer")
    found: Margins = loop.margins()
    return found


def bode(system: Any, w: Sequence[float] | None = None, title: str = "Bode diagram") -> "Figure":
    """Gain and phase with exact dead time, as a matplotlib figure; of a loop the loop transfer with its margins.

    system: a process or a loop, continuous, sampled or in z, a PID form or a regulator, or several by name in a
    mapping. w [rad/s]: the frequencies; by default all that have corners and crossovers in them.

    >>> bode(Process.fopdt(2, 10, 3)).axes[0].get_ylabel()
    'gain'
    """
    return shown_once(bode_figure(_curves(system, w), title))


def nyquist(system: Any, w: Sequence[float] | None = None, title: str = "Nyquist diagram") -> "Figure":
    """The curve around -1 with the margins, and the circle that it touches for its Ms; arguments as for `bode`.

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> from loopbook.loop.continuous import Loop
    >>> len(nyquist(Loop(Process.fopdt(2, 10, 3), PidStandard(0.5, 10))).axes)
    1
    """
    return shown_once(nyquist_curves(_curves(system, w), title))


def _curves(system: Any, w: Sequence[float] | None) -> dict[str, Curve]:
    named = dict(system) if isinstance(system, Mapping) else {"loop transfer": system}
    return {name: _curve(one, None if w is None else np.asarray(w, dtype=float)) for name, one in named.items()}


def _curve(system: Any, w: np.ndarray | None) -> Curve:
    if hasattr(system, "frequency_curve"):
        found: Curve = system.frequency_curve(w)
        return found
    if isinstance(system, SampledProcess | DiscreteProcess):
        return of_pulses(system, w)
    if isinstance(system, Process):
        return of_transfer(LoopTransfer(system.num, system.den, system.delay), w)
    if isinstance(system, TransferAlgebra):
        return of_sums(system, w)
    regulator = Regulator.of(system)
    return of_transfer(LoopTransfer(regulator.S, regulator.R), w)
