"""Chien, Hrones and Reswick: from a step response, for no overshoot or for 20 %, and which type to take.

For changes of the set-point. The overshoot is an aim, not a guarantee: it was found on the process of the authors'
simulator with the PID's derivative on the error. The article prints Ti = 1.4 T for PID with 20 %, other tables 1.36 T.
"""

from dataclasses import replace
from functools import cache
from typing import Any

import sympy as sp
from sympy import Expr, Rational

from derivations.tuning.letters import T_0, T, a, k
from derivations.tuning.rule import NONE, OFF, Caution, Rule
from derivations.tuning.takes import Takes
from derivations.tuning.ziegler_nichols import ARTICLE

PAPER = "K. L. Chien, J. A. Hrones and J. B. Reswick, On the automatic control of generalized passive systems (1952)"
HANDBOOK = "A. O'Dwyer, Handbook of PI and PID Controller Tuning Rules"
TYPES = ("p", "pi", "pid")
BOUNDS = {"higher order": (0, 3), "pid": (3, Rational(15, 2)), "pi": (Rational(15, 2), 10), "p": (10, sp.oo)}
"""The type that the article's table gives for low < R < high; R = 3, 7.5 and 10 belong to no row."""


def types(R: Any) -> tuple[str, ...]:
    """The types of regulator that the table names for R = T/T0: one, or at a border the two beside it.

    The borders are left open in print; both neighbours are returned because either is as good.

    >>> types(Rational(16, 5)), types(Rational(15, 2))
    (('pid',), ('pid', 'pi'))
    """
    return tuple(name for name, (low, high) in BOUNDS.items() if low <= R <= high)


def _cautions(kind: str) -> tuple[Caution, ...]:
    """One for each other row of the table of types."""
    R = T / T_0
    text = "R = T/T0 = {R:.4g}: by this ratio the method's own table takes "
    return tuple(
        Caution(
            sp.And(low < R, R < high), text + (other.upper() if other in TYPES else f"a regulator of {other}"), {"R": R}
        )
        for other, (low, high) in BOUNDS.items()
        if other != kind
    )


SETS: dict[tuple[int, str], dict[str, tuple[Expr, Expr, Expr]]] = {
    (0, "set-point"): {
        "p": (Rational(30, 100) / a, NONE, OFF),
        "pi": (Rational(35, 100) / a, Rational(120, 100) * T, OFF),
        "pid": (Rational(60, 100) / a, T, Rational(50, 100) * T_0),
    },
    (20, "set-point"): {
        "p": (Rational(70, 100) / a, NONE, OFF),
        "pi": (Rational(60, 100) / a, T, OFF),
        "pid": (Rational(95, 100) / a, Rational(140, 100) * T, Rational(47, 100) * T_0),
    },
    (0, "load"): {
        "p": (Rational(30, 100) / a, NONE, OFF),
        "pi": (Rational(60, 100) / a, Rational(400, 100) * T_0, OFF),
        "pid": (Rational(95, 100) / a, Rational(240, 100) * T_0, Rational(42, 100) * T_0),
    },
    (20, "load"): {
        "p": (Rational(70, 100) / a, NONE, OFF),
        "pi": (Rational(70, 100) / a, Rational(230, 100) * T_0, OFF),
        "pid": (Rational(120, 100) / a, Rational(200, 100) * T_0, Rational(42, 100) * T_0),
    },
}
"""(K, Ti, Td) of the paper's four sets by (overshoot in %, what the response answers) and type; the article has two."""


@cache
def rules() -> tuple[Rule, ...]:
    """For the set-point, without overshoot and with 20 %, each P, PI and PID."""
    source = f"{PAPER}; {ARTICLE}, tables of the Chien-Hrones-Reswick method"
    printed = tuple(
        Rule(
            f"chr-{kind}-{overshoot}",
            f"Chien-Hrones-Reswick {overshoot} %, {kind.upper()}",
            Takes.STEP,
            (k, T, T_0),
            *settings,
            source=source,
            year=1952,
            aim=f"set-point: {f'{overshoot} % overshoot' if overshoot else 'no overshoot'}",
            cautions=_cautions(kind),
        )
        for (overshoot, step), row in SETS.items()
        if step == "set-point"
        for kind, settings in row.items()
    )
    pid = next(rule for rule in printed if rule.name == "chr-pid-20")
    handbook = replace(
        pid, name="chr-pid-20-1.36", source=f"{PAPER}; {HANDBOOK}", Ti=Rational(136, 100) * T, variant_of=pid.name
    )
    return (*printed, handbook)
