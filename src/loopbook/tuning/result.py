"""What a tuning rule answers: settings with their source and what limits the trust in them, or why there are none."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

from loopbook.controllers.pid_forms import LEFT_OUT, PidStandard
from loopbook.controllers.regulator import Regulator
from loopbook.plots.plain_table import PlainTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.refusal import Refusal


class RuleDoesNotApply(Refusal):
    """A tuning rule was asked for a process it does not cover; the message names the rule that does."""


@dataclass(frozen=True, repr=False)
class Tuning(ShortRepr):
    """Settings and where they come from.

    pid: standard form as published, mostly without filter; Ti = inf without integral action, Td = 0 without derivative
    action; c = 1 where the source differentiates the error. rule: its name in `loopbook.tuning.RULES`. source: who
    and where. notes: what limits the trust in these numbers, one sentence each. values: what the formulas were given,
    by name. known_by: how that follows from what the rule was given, "" where it was given itself.

    >>> print(Tuning(PidStandard(2.0, 4.0), "own", "given", ("a guess",)))
    own: K = 2, Ti = 4 s, b = 1 (standard form)
    source: given
    mind: a guess
    """

    pid: PidStandard
    rule: str
    source: str
    notes: tuple[str, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict, compare=False)
    known_by: str = ""

    @property
    def K(self) -> float:
        """Proportional gain [u/y]."""
        return self.pid.K

    @property
    def Ti(self) -> float:
        """Integral time [s], inf without integral action."""
        return self.pid.Ti

    @property
    def Td(self) -> float:
        """Derivative time [s]."""
        return self.pid.Td

    @property
    def b(self) -> float:
        """Set-point weight."""
        return self.pid.b

    @property
    def ki(self) -> float:
        """Integral gain K/Ti [u/(y s)]."""
        return self.K / self.Ti

    @property
    def kd(self) -> float:
        """Derivative gain K Td [u s/y]."""
        return self.K * self.Td

    def as_built(self, N: float = 10.0) -> PidStandard:
        """The settings as they are built: the derivative on the measurement, behind a filter Td/N where it has none.

        >>> Tuning(PidStandard(2.0, 4.0, 1.0, c=1.0), "own", "given").as_built().Tf
        0.1
        """
        if self.pid.Tf:
            return replace(self.pid, c=0.0, N=LEFT_OUT)
        return PidStandard(self.K, self.Ti, self.Td, b=self.b, c=0.0, N=N if self.Td else LEFT_OUT)

    def regulator(self) -> Regulator:
        """The polynomials T, S, R of the settings as they are built: what closes a `Loop`."""
        return self.as_built().regulator()

    def table(self) -> PlainTable:
        """The settings with their source, how they are known, and what limits the trust in them."""
        rows: list[list[Any]] = [["K", self.K], ["Ti [s]", self.Ti], ["Td [s]", self.Td], ["b", self.b]]
        rows += [["Tf [s]", self.pid.Tf]] if self.pid.Tf else []
        rows += [["source", self.source], *([["known by", self.known_by]] if self.known_by else [])]
        return PlainTable([self.rule, "standard form"], rows, [f"mind: {note}" for note in self.notes])

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()

    def __str__(self) -> str:
        times = f", Ti = {self.Ti:.4g} s" * (self.Ti < float("inf")) + f", Td = {self.Td:.4g} s" * bool(self.Td)
        lines = [f"{self.rule}: K = {self.K:.4g}{times}, b = {self.b:g} (standard form)", f"source: {self.source}"]
        lines += [f"known by: {self.known_by}"] * bool(self.known_by)
        return "\n".join(lines + [f"mind: {note}" for note in self.notes])
