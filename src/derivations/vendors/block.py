"""One PID block of a controller: its equation as the manual has it, and what to type in, as expressions.

The setting that is to be entered is the standard form

    u = K (b r - y + (r - y)/(s Ti) + s Td/(1 + s Tf) (c r - y))

with K > 0 (the direction is a switch of its own). A block's equation is written in the symbols of its entries and in
its own signals; `PidBlock.signals` turns it into u over y. `PidBlock.left` is what then differs from the standard
form: zero for every block, which is how the entries are proved.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

from sympy import Expr, Integer, Symbol, simplify, symbols

s = Symbol("s")
K, Ti, Td, Tf, b, c = symbols("K T_i T_d T_f b c", positive=True)
Sy, Su = symbols("S_y S_u", positive=True)  # spans of the measurement and of the output, high end less low end

UNITS = Integer(1)
NO_FILTER = Integer(0)
PERCENT_OF_RANGES = Su / Sy
PERCENT_OUT = Su / 100


@dataclass(frozen=True)
class Manual:
    """Where a block's equation was read. read: what stood there, where it was less than the equation in full."""

    title: str
    edition: str
    pages: str
    read: str = "the equation"


@dataclass(frozen=True)
class Entry:
    """One number to type in.

    name: as the controller calls it. unit: as it is typed. symbol: in the block's equation. value: from the standard
    form. derivative: only where there is derivative action. low, high: what the controller takes, None for no limit.
    """

    name: str
    unit: str
    symbol: Symbol
    value: Expr
    derivative: bool = False
    low: Expr | None = None
    high: Expr | None = None


@dataclass(frozen=True)
class Need:
    """What a setting must keep so that the block can express it: expression >= 0."""

    expression: Expr
    reason: str


@dataclass(frozen=True)
class PidBlock:
    """One PID block.

    feedback: -output/measurement, reference: output/set-point; expressions in s, the entries' symbols, b, c. signals:
    one of UNITS, PERCENT_OF_RANGES and PERCENT_OUT, the factor from the block's own signals to u over y. weights: the
    set-point weights b that it has, each with what selects it; none: b is typed in. on_error: does D act on the error
    (c = 1)? filter: Tf as the block makes it. derivative: "" or why its derivative
    action cannot be used. upwards, downwards: what makes it work on a process whose output rises, falls with u. does:
    what the block does otherwise, a sentence each.
    """

    name: str
    title: str
    manual: Manual
    entries: tuple[Entry, ...]
    feedback: Expr
    reference: Expr
    signals: Expr
    upwards: str
    downwards: str
    weights: Mapping[int, str] = field(default_factory=dict)
    on_error: bool = False
    filter: Expr = NO_FILTER
    needs: tuple[Need, ...] = ()
    derivative: str = ""
    selections: tuple[str, ...] = ()
    does: tuple[str, ...] = field(default=())

    @property
    def in_percent(self) -> bool:
        """Does an entry depend on the measuring range?"""
        return Sy in self.signals.free_symbols

    def left(self) -> tuple[Expr, Expr]:
        """What feedback and set-point path, with the entries put in, differ from the standard form by: (0, 0)."""
        weight = Integer(1) if self.on_error else Integer(0)
        put = {entry.symbol: entry.value for entry in self.entries}
        D = Td * s / (1 + self.filter * s) if not self.derivative else Integer(0)
        standard = K * (1 + 1 / (Ti * s) + D), K * (b + 1 / (Ti * s) + weight * D)
        ours = (self.signals * path.subs(put, simultaneous=True) for path in (self.feedback, self.reference))
        fixed = {c: weight, **({b: Integer(1)} if self.weights == {1: ""} else {})}
        return tuple(simplify((mine - right).subs(fixed)) for mine, right in zip(ours, standard, strict=True))
