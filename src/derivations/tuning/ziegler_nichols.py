"""Ziegler and Nichols: from a step response, or from the gain and period at which a proportional loop oscillates.

The article prints Ti = 3 T0 for PI where the paper has T0/0.3 = 3.33 T0; 0.85 Tu where it has Tu/1.2, and 0.12 Tu where
it has Tu/8. Many tables round 3.33 T0 or 3.3 T0, and Åström and Hägglund print 0.4 Ku and 0.8 Tu. All are here.
"""

from dataclasses import replace
from functools import cache

import sympy as sp
from sympy import Rational

from derivations.tuning.letters import T_0, K_u, T, T_u, a, k
from derivations.tuning.rule import NONE, OFF, Caution, Rule
from derivations.tuning.takes import Takes

ARTICLE = "pid-article"
PAPER = "J. G. Ziegler and N. B. Nichols, Optimum settings for automatic controllers, Trans. ASME 64 (1942)"
ROUNDED = f"{PAPER}, with T0/0.3 rounded as most tables print it"
ASTROM = "K. J. Åström and T. Hägglund, PID Controllers: Theory, Design, and Tuning (1995), frequency response method"
AIM = "load: a quarter decay ratio"
RANGE = Caution(
    sp.Or(T_0 / T < Rational(1, 10), T_0 / T > 1),
    "T0/T = {ratio:.3g} lies outside 0.1 to 1, the range the rule was found on",
    {"ratio": T_0 / T},
)


@cache
def rules() -> tuple[Rule, ...]:
    """From the model k e^(-s T0)/(1 + s T), then from the ultimate point; P, PI, PID and the article's variants."""
    article = f"{ARTICLE}, table of the step-response method"

    def step(name: str, kind: str, source: str, K: sp.Expr, Ti: sp.Expr = NONE, Td: sp.Expr = OFF) -> Rule:
        title, inputs = f"Ziegler-Nichols step, {kind}", (k, T, T_0)
        return Rule(name, title, Takes.STEP, inputs, K, Ti, Td, source=source, year=1942, aim=AIM, cautions=(RANGE,))

    pi = step("zn-step-pi", "PI", PAPER, Rational(9, 10) / a, T_0 / Rational(3, 10))
    by_step = (
        step("zn-step-p", "P", f"{PAPER}; {article}", 1 / a),
        pi,
        step("zn-step-pid", "PID", f"{PAPER}; {article}", Rational(6, 5) / a, 2 * T_0, T_0 / 2),
        replace(pi, name="zn-step-pi-article", source=article, Ti=3 * T_0, variant_of=pi.name),
        *(
            replace(pi, name=f"zn-step-pi-{name}", source=ROUNDED, Ti=Rational(*Ti) * T_0, variant_of=pi.name)
            for name, Ti in {"3.33": (333, 100), "3.3": (33, 10)}.items()
        ),
    )
    return by_step + _ultimate()


def _ultimate() -> tuple[Rule, ...]:
    article = f"{ARTICLE}, table of the ultimate-gain method"

    def ultimate(name: str, kind: str, source: str, K: sp.Expr, Ti: sp.Expr = NONE, Td: sp.Expr = OFF) -> Rule:
        title, inputs = f"Ziegler-Nichols ultimate, {kind}", (K_u, T_u)
        return Rule(
            name, title, Takes.FREQUENCY, inputs, K, Ti, Td, source=source, year=1942, aim=AIM, integrating=None
        )

    pi = ultimate("zn-ultimate-pi", "PI", PAPER, Rational(9, 20) * K_u, T_u / Rational(6, 5))
    tank = f"{PAPER}; double-tank, section on PID"
    pid = ultimate("zn-ultimate-pid", "PID", tank, Rational(3, 5) * K_u, T_u / 2, T_u / 8)
    return (
        ultimate("zn-ultimate-p", "P", f"{PAPER}; {article}", K_u / 2),
        pi,
        pid,
        replace(
            pi,
            name=f"{pi.name}-0.4",
            source=ASTROM,
            K=Rational(4, 10) * K_u,
            Ti=Rational(8, 10) * T_u,
            variant_of=pi.name,
        ),
        replace(pi, name=f"{pi.name}-article", source=article, Ti=Rational(85, 100) * T_u, variant_of=pi.name),
        replace(pid, name=f"{pid.name}-article", source=article, Td=Rational(12, 100) * T_u, variant_of=pid.name),
    )
