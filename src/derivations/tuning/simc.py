"""SIMC, S. Skogestad's rules: PI for one lag with dead time, PID for two, with one parameter for speed, tau_c = lambda.

    series   Kc = T/(k (lambda + T0)), tau_I = min(T, 4 (lambda + T0)), tau_D = T2
    here     the equal standard form: K = Kc (1 + T2/tau_I), Ti = tau_I + T2, Td = T2/(1 + T2/tau_I)

Gain and cancelled lags are those of `direct_synthesis`, and 4 (lambda + T0) is its integral time for an integrator. The
author recommends lambda = T0. An integrating process is a lag so long that only its slope k/T = K_v is seen.
"""

from functools import cache
from typing import Any

import sympy as sp

from derivations.tuning.direct_synthesis import by_tangent, integral_time_of_an_integrator, s, slope_gain, standard
from derivations.tuning.letters import T_0, T_2, K_v, T, k, lam
from derivations.tuning.rule import OFF, Caution, Rule
from derivations.tuning.takes import Takes

SOURCE = "S. Skogestad, Simple analytic rules for model reduction and PID controller tuning, J. Process Control (2003)"
FAST = Caution(lam < T_0, "closed = {closed:g} s is shorter than T0 = {L:g} s: faster than the author recommends")
ONE_LAG = Caution(
    sp.Le(T_2, 0, evaluate=False),
    "derivative action needs a second lag; the model has one, for which SIMC gives PI",
)
SWAPPED = Caution(T_2 > T, "T2 = {T2:g} s is the shorter time constant, T = {T:g} s the longer; swap them")


@cache
def rules() -> tuple[Rule, ...]:
    """PI and PID, for a stable and for an integrating process."""
    gain, cancelling, _ = standard(by_tangent(1 + s * T))
    slow, slope = integral_time_of_an_integrator(), slope_gain()
    integral = sp.Min(cancelling, slow)
    common: dict[str, Any] = {
        "source": SOURCE,
        "year": 2003,
        "aim": "set-point and load, Ms 1.6",
        "cautions": (FAST,),
        "defaults": {lam: T_0},
    }

    def with_second_lag(gain: sp.Expr, integral: sp.Expr) -> tuple[sp.Expr, sp.Expr, sp.Expr]:
        factor = 1 + T_2 / integral
        return gain * factor, integral * factor, T_2 / factor

    one, two = Takes.ONE_LAG, Takes.TWO_LAGS_OF_MODEL
    pid = {**common, "refusals": (ONE_LAG, SWAPPED)}
    pid_integrating = {**common, "refusals": (ONE_LAG,), "integrating": True}
    return (
        Rule("simc-pi", "SIMC, PI", one, (k, T, T_0, lam), gain, integral, OFF, **common),
        Rule("simc-pid", "SIMC, PID", two, (k, T, T_2, T_0, lam), *with_second_lag(gain, integral), **pid),
        Rule(*("simc-pi-integrating", "SIMC, PI", one, (K_v, T_0, lam), slope, slow, OFF), integrating=True, **common),
        Rule(
            *("simc-pid-integrating", "SIMC, PID", two, (K_v, T_2, T_0, lam), *with_second_lag(slope, slow)),
            **pid_integrating,
        ),
    )
