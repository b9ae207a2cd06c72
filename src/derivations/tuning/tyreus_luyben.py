"""Tyreus and Luyben: from the ultimate point, calmer than Ziegler and Nichols; made for integrators with dead time.

The paper of 1992 gives PI; the PID row is Luyben's later one.
"""

from functools import cache
from typing import Any

from sympy import Rational

from derivations.tuning.letters import K_u, T_u
from derivations.tuning.rule import Rule
from derivations.tuning.takes import Takes

PAPER = (
    "B. D. Tyreus and W. L. Luyben, Tuning PI controllers for integrator/dead time processes, Ind. Eng. Chem. Res. 31"
)
BOOK = "M. L. Luyben and W. L. Luyben, Essentials of Process Control"


@cache
def rules() -> tuple[Rule, ...]:
    """PI and PID."""
    common: dict[str, Any] = {"aim": "load: well damped", "integrating": None}
    Ti = Rational(11, 5) * T_u
    pi, pid = K_u / Rational(16, 5), K_u / Rational(11, 5)
    at = Takes.FREQUENCY, (K_u, T_u)
    return (
        Rule("tyreus-luyben-pi", "Tyreus-Luyben, PI", *at, pi, Ti, source=PAPER, year=1992, **common),
        Rule(
            *("tyreus-luyben-pid", "Tyreus-Luyben, PID", *at, pid, Ti, T_u / Rational(63, 10)),
            source=BOOK,
            year=1997,
            **common,
        ),
    )
