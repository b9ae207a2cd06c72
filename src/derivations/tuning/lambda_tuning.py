"""Lambda tuning: pole cancellation with a wanted closed-loop time constant.

lambda-pi, lambda-pid: for a lag with dead time, by `direct_synthesis`, PI with the tangent of the dead time and PID
with Padé of order 1. Robust for lambda >= T0; slow for loads where T is much longer than T0.
first-order-pi: the same without dead time; lambda is the closed loop's time constant, exactly, as
`derivations.loop.first_order_loop` derives. first-order-pi-script: the same with lambda = i T, the dimensionless i that
the article's script runs through.
"""

from functools import cache
from typing import Any

import sympy as sp

from derivations.tuning.direct_synthesis import by_pade, by_tangent, s, standard
from derivations.tuning.letters import T_0, T, k, lam
from derivations.tuning.rule import Caution, Rule
from derivations.tuning.takes import Takes
from derivations.tuning.ziegler_nichols import ARTICLE

SOURCE = "E. B. Dahlin, Designing and tuning digital controllers (1968); Åström and Hägglund, Advanced PID Control"
AIM = "set-point: a wanted time constant"
SLOW = Caution(
    T > 8 * T_0, "T = {T:.4g} s is longer than 8 T0: the integral action is slow for loads; SIMC shortens it"
)
AGGRESSIVE = Caution(
    lam < T_0, "closed = {closed:.4g} s is shorter than T0 = {L:.4g} s: little robustness against a longer dead time"
)
MODE = Caution(lam < T, "a load's effect decays with T = {T:g} s although the set-point response has {closed:g} s")
DEAD_TIME = Caution(
    sp.Gt(T_0, 0, evaluate=False),
    "the process has a dead time of {L:.4g} s and the rule is for a lag without one",
    advice="use lambda-pi",
)
i = sp.Symbol("i", positive=True)


@cache
def rules() -> tuple[Rule, ...]:
    """PI and PID for a lag with dead time, and PI for a lag alone."""
    x = (k, T, T_0, lam)
    dead: dict[str, Any] = {
        "source": SOURCE,
        "year": 1968,
        "aim": AIM,
        "cautions": (SLOW, AGGRESSIVE),
        "defaults": {lam: sp.Max(T, T_0)},
    }
    alone: dict[str, Any] = {"aim": AIM, "refusals": (DEAD_TIME,)}
    lag = 1 + s * T
    pi, pid = standard(by_tangent(lag)), standard(by_pade(lag))
    gain, integral, _ = standard(by_tangent(lag).subs(T_0, 0))
    return (
        Rule("lambda-pi", "lambda, PI", Takes.STEP, x, *pi, **dead),
        Rule("lambda-pid", "lambda, PID", Takes.STEP, x, *pid, **dead),
        Rule(
            *("first-order-pi", "pole cancellation, PI", Takes.STEP, (k, T, lam), gain, integral),
            source=f"{ARTICLE}, section on the first-order plant",
            cautions=(MODE,),
            **alone,
        ),
        Rule(
            *("first-order-pi-script", "pole cancellation, PI", Takes.STEP, (k, T, i), gain.subs(lam, i * T), integral),
            source=f"{ARTICLE}, file pid_script1.m",
            variant_of="first-order-pi",
            **alone,
        ),
    )
