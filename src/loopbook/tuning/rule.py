"""Tuning rules: a module per method, each returning settings that say where they come from and how far to trust them.

Every rule gives a `Tuning`: the settings, the rule's name and source, and notes on its validity. The settings are the
standard form ``K (1 + 1/(s Ti) + s Td)`` acting on the error (b = c = 1, no filter), as the rules were published. The
formulas are the SymPy expressions of `derivations.tuning.rules`; `compute` turns them into numbers.
"""

from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING

from loopbook.refusal import Refusal

if TYPE_CHECKING:
    from loopbook.controllers.pid_forms import PidStandard


class RuleDoesNotApply(Refusal):
    """A tuning rule was asked for a process it does not cover; the message names the rule that does."""


@dataclass(frozen=True)
class Tuning:
    """Settings and where they come from.

    pid: standard form; Ti = inf without integral action, Td = 0 without derivative action. rule: the rule's name in
    `derivations.tuning.rules`. source: who and where. notes: what limits the trust in these numbers, one sentence each.
    """

    pid: "PidStandard"
    rule: str
    source: str
    notes: tuple[str, ...] = ()

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


@cache
def _functions(name: str):
    import sympy

    from derivations.tuning.rules import rule

    found = rule(name)
    return [sympy.lambdify(found.inputs, e, modules="math") for e in (found.K, found.Ti, found.Td)], found


def compute(name: str, *inputs: float, notes: tuple[str, ...] = ()) -> Tuning:
    """The settings of one rule of `derivations.tuning.rules` for numbers in the order of the rule's ``inputs``.

    Raises RuleDoesNotApply where an input is not a positive finite number (a dead time of zero included: every rule
    that takes one divides by it), KeyError for an unknown rule.

    >>> compute("zn-step-pid", 3, 3.285, 1.005).K.__round__(4)
    1.3075
    """
    from math import inf, isfinite

    from loopbook.controllers.pid_forms import PidStandard

    functions, found = _functions(name)
    if len(inputs) != len(found.inputs):
        raise TypeError(f"{name} takes {', '.join(map(str, found.inputs))}; got {len(inputs)} numbers")
    for symbol, value in zip(found.inputs, inputs, strict=True):
        if not (isfinite(value) and value > 0):
            raise RuleDoesNotApply(f"{name}: {symbol} must be a positive number, got {value:g}; source: {found.source}")
    K, Ti, Td = (float(f(*map(float, inputs))) for f in functions)
    return Tuning(PidStandard(K=K, Ti=Ti if Ti < inf else inf, Td=Td, c=1.0), name, found.source, notes)
