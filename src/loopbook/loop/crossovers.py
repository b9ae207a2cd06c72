"""All gain and phase crossovers of a loop, stable or not, with what each would be as a margin."""

from dataclasses import dataclass
from typing import Any

from loopbook.loop import circle_margins, margins
from loopbook.loop.cascade import CascadeLoop
from loopbook.loop.continuous import Loop
from loopbook.loop.discrete import DiscreteLoop
from loopbook.loop.feedforward import FeedforwardLoop
from loopbook.loop.general import GeneralLoop, ratio_crossovers, strictly_proper
from loopbook.loop.margins import GainCrossover, PhaseCrossover
from loopbook.loop.sampled import SampledLoop
from loopbook.loop.stability import is_stable
from loopbook.loop.transfer import LoopError, LoopTransfer
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.process.algebra import TransferAlgebra
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.sampled import SampledProcess
from loopbook.process.transfer_function import Process


@dataclass(frozen=True, repr=False)
class Crossovers(ShortRepr, ShownAsTable):
    """stable: is the closed loop? Only then the values are margins. gain, phase: all crossovers, ascending in w."""

    stable: bool
    gain_crossovers: tuple[GainCrossover, ...]
    phase_crossovers: tuple[PhaseCrossover, ...]

    @property
    def phase(self) -> float:
        """The smallest angle to -180 degrees [degrees] in size, its sign kept; inf without a gain crossover."""
        return min((c.phase_margin for c in self.gain_crossovers), key=abs, default=float("inf"))

    @property
    def gain(self) -> float:
        """The factor to -1 that is nearest to 1 in ratio; inf without a phase crossover."""
        factors = [c.gain for c in self.phase_crossovers]
        return min(factors, key=lambda factor: max(factor, 1 / factor), default=float("inf"))

    def table(self) -> PlainTable:
        """A row for each crossover."""
        rows: list[list[Any]] = [["gain 1", c.w, f"{c.phase_margin:.4g}° to -180°"] for c in self.gain_crossovers]
        rows += [["phase -180°", c.w, f"{c.gain:.4g} times to -1"] for c in self.phase_crossovers]
        notes = [] if self.stable else ["the closed loop is unstable: these are no margins"]
        return PlainTable(["crossover", "at [rad/s]", "there"], sorted(rows, key=lambda row: row[1]), notes)


def crossovers(system: Any) -> Crossovers:
    """Where the gain passes 1 and the phase -180 degrees, of a stable or an unstable loop.

    system: any loop; or a transfer function, continuous or in z, as the loop transfer itself.
    With dead time there are infinitely many phase crossovers: all with a gain above 1 and the nearest below it.

    >>> found = crossovers(Process([50], [5, 10.25, 6.25, 1]))
    >>> found.stable, round(found.phase, 1)
    (False, -35.1)
    """
    if isinstance(system, Process):
        system = LoopTransfer(system.num, system.den, system.delay)
    if isinstance(system, Loop):
        system = system.transfer
    if isinstance(system, LoopTransfer):
        return Crossovers(is_stable(system), margins.gain_crossovers(system), margins.phase_crossovers(system))
    if isinstance(system, FeedforwardLoop):
        return crossovers(system.loop)
    if isinstance(system, CascadeLoop):
        system = system.outer
    if isinstance(system, TransferAlgebra):
        system = GeneralLoop(system, 1.0)
    if isinstance(system, GeneralLoop):
        return Crossovers(system.is_stable, *ratio_crossovers(*strictly_proper(system.transfer)))
    if isinstance(system, DiscreteProcess | SampledProcess):
        system = DiscreteLoop(system)
    if isinstance(system, SampledLoop | DiscreteLoop):
        h = system.regulator.h if isinstance(system, SampledLoop) else system.h
        circle = system.on_circle
        return Crossovers(
            system.is_stable, circle_margins.gain_crossovers(circle, h), circle_margins.phase_crossovers(circle, h)
        )
    raise LoopError(f"{type(system).__name__} has no crossovers: give a loop, or a process as its loop transfer")
