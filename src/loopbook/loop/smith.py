"""A Smith predictor: the regulator acts on what the process would show without its dead time, by a model.

    R u = T r - S (y + n + G_m (1 - exp(-L_m s)) u),        model G_m exp(-L_m s), process P

With the model right, the reference sees T G_m/(R + S G_m) behind the dead time, as if that were outside the loop. With
another process, its dead time above all, it does not: every answer here is for the process as it is, exactly.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.loop.general import DelayedRegulator, GeneralLoop
from loopbook.loop.margins import Margins
from loopbook.loop.shown_loop import said_of
from loopbook.loop.transfer import LoopError
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.real_numbers import real
from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.process.transfer_function import Process


class Between(NamedTuple):
    """From low to high."""

    low: float
    high: float


@dataclass(frozen=True, repr=False)
class SmithRobustness(ShortRepr, ShownAsTable):
    """What the loop bears, the predictor as it is.

    delay: the dead times [s] of the process between which it stays stable. gain: the factors on its gain. model_delay:
    what the predictor believes [s]. margins: those of the loop.
    """

    delay: Between
    gain: Between
    model_delay: float
    margins: Margins

    def table(self) -> PlainTable:
        """Each range with what it is about."""
        rows: list[list[Any]] = [["dead time [s]", self.delay.low, self.delay.high]]
        rows += [["gain, factor", self.gain.low, self.gain.high]]
        notes = [f"the predictor's model has {self.model_delay:.4g} s; Ms = {self.margins.Ms.value:.4g}"]
        return PlainTable(["stable for a process with", "from", "to"], rows, notes)


@dataclass(frozen=True, repr=False)
class SmithLoop(GeneralLoop):
    """A process under a regulator that is tuned for the model without dead time.

    process: as it is. regulator: a PID form or what a `Loop` takes. model: what the predictor believes, by default the
    process itself.

    The model has to be stable: the predictor runs it, and its poles stay poles of the loop that nothing moves.

    >>> from loopbook.controllers.pid_forms import PidStandard
    >>> loop = SmithLoop(Process.fopdt(2, 10, 6), PidStandard(2.0, 10))
    >>> [round(x, 3) for x in loop.robustness().delay], loop.with_delay(1.0).is_stable
    ([0.0, 15.074], True)
    """

    process: Process
    model: Process | None = None

    @property
    def predicted(self) -> Process:
        """The model that the predictor runs."""
        return self.process if self.model is None else self.model

    @cached_property
    def rows(self) -> tuple[ExponentialPolynomial, ...]:
        """B, A, T, S, R, the predictor's model in the last three."""
        c, model, of = Regulator.of(self.regulator), self.predicted, ExponentialPolynomial.of
        if model.relative_degree == 0:
            raise LoopError("the model acts at once: a predictor needs a lag in it")
        below, above = of(model.den), of(model.num) - of(model.num, model.delay)
        predictor = DelayedRegulator(of(c.T) * below, of(c.S) * below, of(c.R) * below + of(c.S) * above)
        return *self.process.fraction, predictor.T, predictor.S, predictor.R

    def closed(self, source: str = "reference", output: str = "y") -> Any:
        """As of any loop; with the process's own lags in the model they cancel where they are not seen."""
        if not self._lags_are_known or source not in ("reference", "noise"):
            return super().closed(source, output)
        c, of, P = Regulator.of(self.regulator), ExponentialPolynomial.of, self.process
        model = self.predicted
        S, T, A = of(c.S), of(c.T), of(P.den)
        below = of(c.R) * A + S * (of(model.num) - of(model.num, model.delay) + of(P.num, P.delay))
        along = T if source == "reference" else S * -1.0
        return self.process.simplest(along * (of(P.num, P.delay) if output == "y" else A), below)

    @property
    def _lags_are_known(self) -> bool:
        return self.predicted.den == self.process.den

    def parts(self) -> list[list[Any]]:
        """What it is made of."""
        return [*super().parts(), ["model of the predictor", said_of(self.predicted)]]

    def with_delay(self, more: float) -> "SmithLoop":
        """The same predictor on a process with `more` seconds of dead time added; it may be negative."""
        L = self.process.delay + real(more, "more", LoopError, " s")
        if L < 0:
            raise LoopError(f"more = {more!r} s: the process has only {self.process.delay:g} s of dead time")
        return SmithLoop(Process(self.process.num, self.process.den, L), self.regulator, self.path, self.predicted)

    def with_gain(self, factor: float) -> "SmithLoop":
        """The same predictor on a process with `factor` times the gain."""
        return SmithLoop(self.process * real(factor, "factor"), self.regulator, self.path, self.predicted)

    def robustness(self) -> SmithRobustness:
        """Between which dead times and gains of the process the loop stays stable, the predictor as it is.

        Exact: a pole can reach the imaginary axis only at a gain crossover, whose frequencies do not depend on the
        process's dead time. Raises LoopError for an unstable loop.
        """
        m = self.margins()
        sooner = [(-np.radians(c.phase_margin)) % (2 * np.pi) / c.w for c in m.gain_crossovers]
        low = max(self.process.delay - min(sooner, default=np.inf), 0.0)
        return SmithRobustness(
            Between(low, self.process.delay + m.delay), Between(m.gain_low, m.gain), self.predicted.delay, m
        )
