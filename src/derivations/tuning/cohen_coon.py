"""Cohen and Coon: a quarter decay ratio for a lag with dead time, also where the dead time is long.

r = T_0/T       P: K = (1 + r/3)/(k r)      PI: K = (9/10 + r/12)/(k r)      PID: K = (4/3 + r/4)/(k r)
"""

from functools import cache

import sympy as sp
from sympy import Rational

from derivations.tuning.letters import T_0, T, k
from derivations.tuning.rule import NONE, OFF, Rule
from derivations.tuning.takes import Takes

PAPER = "G. H. Cohen and G. A. Coon, Theoretical consideration of retarded control, Trans. ASME 75"


@cache
def rules() -> tuple[Rule, ...]:
    """P, PI and PID from the model k e^(-s T0)/(1 + s T)."""
    r = T_0 / T

    def row(kind: str, K: sp.Expr, Ti: sp.Expr = NONE, Td: sp.Expr = OFF) -> Rule:
        title, aim = f"Cohen-Coon, {kind.upper()}", "load: a quarter decay ratio"
        return Rule(
            f"cohen-coon-{kind}", title, Takes.STEP, (k, T, T_0), K / (k * r), Ti, Td, source=PAPER, year=1953, aim=aim
        )

    return (
        row("p", 1 + r / 3),
        row("pi", Rational(9, 10) + r / 12, T_0 * (30 + 3 * r) / (9 + 20 * r)),
        row("pid", Rational(4, 3) + r / 4, T_0 * (32 + 6 * r) / (13 + 8 * r), 4 * T_0 / (11 + 2 * r)),
    )
