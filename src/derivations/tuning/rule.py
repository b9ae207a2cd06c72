"""A published tuning rule: its formulas as SymPy expressions, and what is known of it.

What is shown and what computes come from these expressions. A rule is empirical: it is cited, not derived. Each variant
of "the same" rule that a source prints is a rule of its own, with its own name, because 0.12 T_u and 0.125 T_u are
different regulators.

All rules give the standard form K (1 + 1/(s Ti) + s Td); a parallel or series form is a conversion afterwards.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field

import sympy as sp
from sympy import Expr, Integer, Rational, Symbol

from derivations.tuning.takes import Takes

NONE, OFF = sp.oo, Integer(0)
"""No integral action is Ti = infinity, no derivative action is Td = 0."""


@dataclass(frozen=True)
class Caution:
    """A sentence that is said where a condition holds.

    when: a relation of the quantities (letters stand for positive numbers, so ``T <= 0`` is written unevaluated). text:
    with {name} for each of `shows`, and for the quantities by their names (Kp, T, L, ...). advice: what to do, for
    programmers.
    """

    when: sp.Basic
    text: str
    shows: Mapping[str, Expr] = field(default_factory=dict)
    advice: str = ""


@dataclass(frozen=True)
class Rule:
    """One row of one published table.

    name: how programs call it, ``zn-step-pid``; title: how a table does. takes: what it must know. inputs: the letters
    of its formulas. K [u/y], Ti [s], Td [s]: the formulas. source, year: who, where, when (None: no date is known).
    aim: what its settings are meant for. c: 1 where the published form differentiates the error, 0 where the
    measurement. b: the set-point weight, 1 where `measure`, the relative dead time, exceeds `b_above`. good: by
    parameter, symbol (tau or kappa) and the value above which the source calls that parameter good; empty where it
    calls all good. integrating: is the process meant an integrating one? None: either. cautions: what limits the trust
    in the settings. refusals: where the rule does not apply; those in `extrapolates` only unless the user insists.
    defaults: formulas of the options that have one. variant_of: the rule of which this is another source's variant.
    section: of the source.
    """

    name: str
    title: str
    takes: Takes
    inputs: tuple[Symbol, ...]
    K: Expr
    Ti: Expr = NONE
    Td: Expr = OFF
    source: str = ""
    year: int | None = None
    aim: str = ""
    c: int = 1
    b: int = 1
    measure: Expr | None = None
    b_above: Rational | None = None
    good: Mapping[str, tuple[str, Rational]] = field(default_factory=dict)
    integrating: bool | None = False
    cautions: tuple[Caution, ...] = ()
    refusals: tuple[Caution, ...] = ()
    extrapolates: tuple[Caution, ...] = ()
    defaults: Mapping[Symbol, Expr] = field(default_factory=dict)
    variant_of: str = ""
    section: str = ""

    @property
    def action(self) -> str:
        """P, PI or PID: what the formulas hold."""
        return "P" + "I" * (self.Ti != NONE) + "D" * (self.Td != OFF)

    @property
    def ki(self) -> Expr:
        """The integral gain K/Ti."""
        return self.K / self.Ti

    @property
    def kd(self) -> Expr:
        """The derivative gain K Td."""
        return self.K * self.Td

    def equations(self) -> dict[str, sp.Eq]:
        """The rule as equations to display; a term that is switched off is left out."""
        wanted = {"K": self.K, "Ti": self.Ti, "Td": self.Td}
        names = {"K": "K", "Ti": "T_i", "Td": "T_d"}
        return {n: sp.Eq(sp.Symbol(names[n]), e) for n, e in wanted.items() if e not in (NONE, OFF)}
