"""IMC by Rivera, Morari and Skogestad: the inverse of a lag with dead time behind a filter of time constant lambda.

    imc-pi       K = (T + T0/2)/(k lambda), Ti = T + T0/2         the paper's "improved PI", lambda > 1.7 T0
    imc-pi-lag   K = T/(k lambda), Ti = T                         the dead time left out, lambda > 1.7 T0
    imc-pid      K = (T + T0/2)/(k (lambda + T0/2)), Ti = T + T0/2, Td = T T0/(2 T + T0)      lambda > 0.8 T0

and lambda > 0.2 T always. Here lambda is the filter's time constant, not that of the closed loop plus dead time.
"""

from functools import cache
from typing import Any

import sympy as sp
from sympy import Rational

from derivations.tuning.letters import T_0, T, k, lam
from derivations.tuning.rule import Caution, Rule
from derivations.tuning.takes import Takes

PAPER = (
    "D. E. Rivera, M. Morari and S. Skogestad, Internal model control: PID controller design, Ind. Eng. Chem. Process "
    "Des. Dev. 25, table II"
)
INPUT = Caution(lam < T / 5, "closed = {closed:.4g} s is shorter than 0.2 T = {short:.4g} s", {"short": T / 5})


def _least(times: Rational) -> tuple[sp.Expr, tuple[Caution, ...]]:
    """The least lambda that the paper recommends, and what is said below it."""
    text = "closed = {closed:.4g} s is shorter than {times:.2g} T0, which the authors recommend as the least"
    return sp.Max(times * T_0, T / 5), (Caution(lam < times * T_0, text, {"times": times}), INPUT)


@cache
def rules() -> tuple[Rule, ...]:
    """PI in two ways and PID; lambda is by default the shortest that the paper recommends."""
    x = (k, T, T_0, lam)
    half = T_0 / 2
    pi, pi_cautions = _least(Rational(17, 10))
    pid, pid_cautions = _least(Rational(8, 10))
    common: dict[str, Any] = {"source": PAPER, "year": 1986, "aim": "set-point: robust"}
    by_pi: dict[str, Any] = {**common, "defaults": {lam: pi}, "cautions": pi_cautions}
    by_pid: dict[str, Any] = {**common, "defaults": {lam: pid}, "cautions": pid_cautions}
    return (
        Rule("imc-pi", "IMC, PI", Takes.STEP, x, (T + half) / (k * lam), T + half, **by_pi),
        Rule("imc-pi-lag", "IMC, PI", Takes.STEP, x, T / (k * lam), T, variant_of="imc-pi", **by_pi),
        Rule(
            *("imc-pid", "IMC, PID", Takes.STEP, x, (T + half) / (k * (lam + half)), T + half),
            T * T_0 / (2 * T + T_0),
            **by_pid,
        ),
    )
