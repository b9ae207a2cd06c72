"""AMIGO for stable processes: PI and PID from a step response, from a point of the frequency response, from both.

The rules were fitted to the MIGO optimum (largest integral gain for robustness M = 1.4) of a batch of processes; they
are cited, not derived (pid-report, sections 5.3.2 to 5.3.7). What can be derived is: the rules for integrating
processes are limits of these (`amigo_integrating`), and the adjustment for a derivative filter keeps the sum of all
lags (`with_filter`).

All rules give the standard form K (b r - y + (1/Ti) int e dt - Td dy/dt), derivative on the measurement.
"""

from collections.abc import Mapping
from functools import cache
from typing import Any

import sympy
from sympy import Expr, Integer, Rational, Symbol

from derivations.tuning.letters import K_180, L_1, T_1, T_2, T_180, K_p, L, T, T_f, kappa, tau
from derivations.tuning.rule import Caution, Rule
from derivations.tuning.takes import Takes

SOURCE = "Åström and Hägglund, Advanced PID control (2006); pid-report, section {}"
AIM = "load, robustness M = 1.4"
RELATIVE_DEAD_TIME = L / (L + T)

Constants = tuple[Expr, ...]
PI_STEP: dict[str, Constants] = {
    "K": (Rational(15, 100), Rational(35, 100)),
    "Ti": (Rational(35, 100), Rational(13), Rational(12), Rational(7)),
}
PID_STEP: dict[str, Constants] = {
    "K": (Rational(20, 100), Rational(45, 100)),
    "Ti": (Rational(40, 100), Rational(80, 100), Rational(10, 100)),
    "Td": (Rational(50, 100), Rational(30, 100)),
}
PI_FREQUENCY: dict[str, Constants] = {"K": (Rational(16, 100),), "Ti": (Rational(450, 100),)}
PID_FREQUENCY: dict[str, Constants] = {
    "K": (Rational(30, 100), Rational(10, 100)),
    "Ti": (Rational(60, 100), Rational(2)),
    "Td": (Rational(15, 100), Rational(95, 100)),
}
SECOND_ORDER = {  # section 5.3.7: the weights of 1, T1/L1, T2/L1 and T1 T2/L1^2 in K, ki and kd
    "alpha": (Rational(19, 100), Rational(37, 100), Rational(18, 100), Rational(2, 100)),
    "beta": (Rational(48, 100), Rational(3, 100), Rational(-7, 10000), Rational(12, 10000)),
    "gamma": (Rational(29, 100), Rational(16, 100), Rational(20, 100), Rational(28, 100)),
}

NO_WEIGHT = Caution(sympy.true, "the source gives no rule for b with frequency data: b = 0 is the cautious choice")
TOO_LARGE = Caution(
    kappa >= 1,
    "kappa = K180/Kp = {kappa:.4g}: no gain at -180 degrees reaches the static gain of a lag and a dead time; "
    "check K180 and Kp",
)
DOMINATED = (
    "kappa = K180/Kp = {kappa:.4g} <= {least:g}: the process is dominated by its lag and these settings are not "
    "appropriate; take "
)
NO_DEAD_TIME_RATIO = Caution(
    sympy.Or(sympy.Lt(tau, 0, evaluate=False), tau > 1),
    "tau = {tau:g} is no relative dead time, which lies between 0 and 1",
)


def _published(name: str, title: str, takes: Takes, section: str, first: tuple[Caution, ...] = (), **more: Any) -> Rule:
    """A rule of AMIGO, with a sentence for each parameter outside the range in which the source calls it good."""
    measures = {"tau": RELATIVE_DEAD_TIME, "kappa": kappa}
    outside = tuple(
        Caution(
            measures[by] <= limit,
            f"{parameter} is fitted for {by} > {{limit:g}}; here {by} = {{value:.3g}}",
            {"limit": limit, "value": measures[by]},
        )
        for parameter, (by, limit) in more.get("good", {}).items()
    )
    last = () if "b_above" in more else (NO_WEIGHT,)
    more |= {"section": section, "source": SOURCE.format(section), "year": 2006, "aim": AIM, "c": 0, "b": 0}
    return Rule(f"amigo-{name}", f"AMIGO {title}", takes, **more, cautions=first + outside + last)


def _lag_dominated(least: Rational) -> tuple[Caution, ...]:
    """An integrating process has kappa = 0; one dominated by its lag has little more."""
    both = {"least": least}
    return (
        Caution(
            sympy.And(sympy.Gt(kappa, 0, evaluate=False), kappa <= least),
            DOMINATED + "step and frequency together",
            both,
            "use amigo-combined-pid; extrapolate=True computes them all the same",
        ),
        Caution(
            sympy.Eq(kappa, 0, evaluate=False),
            DOMINATED + "the rules for integrating processes",
            both,
            "use amigo-step-pi-integrating, amigo-step-pid-integrating, amigo-combined-pid-integrating; "
            "extrapolate=True computes them all the same",
        ),
    )


@cache
def pi_step(K: Constants = PI_STEP["K"], Ti: Constants = PI_STEP["Ti"]) -> Rule:
    """PI from a step response, section 5.3.3. The constants are those in print; others make the same formulas.

    >>> pi_step().K.subs({K_p: 1, T: 1, L: 1})
    1/4
    """
    return _published(
        *("step-pi", "step, PI", Takes.STEP, "5.3.3"),
        inputs=(K_p, T, L),
        K=K[0] / K_p + (K[1] - L * T / (L + T) ** 2) * T / (K_p * L),
        Ti=Ti[0] * L + Ti[1] * L * T**2 / (T**2 + Ti[2] * L * T + Ti[3] * L**2),
        measure=RELATIVE_DEAD_TIME,
        b_above=Rational(3, 10),
    )


@cache
def pid_step(K: Constants = PID_STEP["K"], Ti: Constants = PID_STEP["Ti"], Td: Constants = PID_STEP["Td"]) -> Rule:
    """PID from a step response, section 5.3.4. The constants are those in print; others make the same formulas.

    >>> pid_step().K.subs({K_p: 1, T: 1, L: 1})
    13/20
    """
    conservative = Caution(
        RELATIVE_DEAD_TIME < Rational(1, 2),
        "conservative for tau < 0.5; here tau = {tau:.3g}: gain too low, integral time too long",
        {"tau": RELATIVE_DEAD_TIME},
    )
    return _published(
        *("step-pid", "step, PID", Takes.STEP, "5.3.4", (conservative,)),
        inputs=(K_p, T, L),
        K=(K[0] + K[1] * T / L) / K_p,
        Ti=(Ti[0] * L + Ti[1] * T) / (L + Ti[2] * T) * L,
        Td=Td[0] * L * T / (Td[1] * L + T),
        measure=RELATIVE_DEAD_TIME,
        b_above=Rational(5, 10),
        good={"K": ("tau", Rational(3, 10)), "Ti": ("tau", Rational(2, 10)), "Td": ("tau", Rational(5, 10))},
    )


@cache
def pi_frequency(K: Constants = PI_FREQUENCY["K"], Ti: Constants = PI_FREQUENCY["Ti"]) -> Rule:
    """PI from one point of the frequency response, section 5.3.5; kappa = K_180/K_p, constants as in print.

    >>> pi_frequency().Ti
    T_180/(9*kappa/2 + 1)
    """
    return _published(
        *("frequency-pi", "frequency, PI", Takes.FREQUENCY_AND_GAIN, "5.3.5"),
        inputs=(K_180, T_180, kappa),
        K=K[0] / K_180,
        Ti=T_180 / (1 + Ti[0] * kappa),
        good=dict.fromkeys(("K", "Ti"), ("kappa", Rational(2, 10))),
        refusals=(TOO_LARGE,),
        extrapolates=_lag_dominated(Rational(2, 10)),
    )


@cache
def pid_frequency(
    K: Constants = PID_FREQUENCY["K"], Ti: Constants = PID_FREQUENCY["Ti"], Td: Constants = PID_FREQUENCY["Td"]
) -> Rule:
    """PID from one point of the frequency response, section 5.3.6; kappa = K_180/K_p, constants as in print.

    >>> pid_frequency().Td.subs(kappa, 0)
    3*T_180/20
    """
    return _published(
        *("frequency-pid", "frequency, PID", Takes.FREQUENCY_AND_GAIN, "5.3.6"),
        inputs=(K_180, T_180, kappa),
        K=(K[0] - K[1] * kappa**4) / K_180,
        Ti=Ti[0] / (1 + Ti[1] * kappa) * T_180,
        Td=Td[0] * (1 - kappa) / (1 - Td[1] * kappa) * T_180,
        good=dict.fromkeys(("K", "Ti", "Td"), ("kappa", Rational(2, 10))),
        refusals=(TOO_LARGE,),
        extrapolates=_lag_dominated(Rational(2, 10)),
    )


@cache
def pid_combined() -> Rule:
    """PID from a step response and one point of the frequency response together, section 5.3.7.1.

    >>> pid_combined().K.subs({K_p: 1, T_1: 1, T_2: 1, L_1: 1})
    19/25
    """
    alpha, beta, gamma = SECOND_ORDER.values()
    basis = (Integer(1), T_1 / L_1, T_2 / L_1, T_1 * T_2 / L_1**2)
    K, ki, kd = (sum(c * x for c, x in zip(row, basis, strict=True)) / K_p for row in (alpha, beta, gamma))
    ki = sympy.expand(ki / L_1)
    kd = kd * L_1 * (T_1 + T_2) / (T_1 + T_2 + L_1)
    return _published(
        *("combined-pid", "step and frequency, PID", Takes.TWO_LAGS, "5.3.7.1"),
        inputs=(K_p, T_1, T_2, L_1),
        K=K,
        Ti=K / ki,
        Td=kd / K,
        measure=tau,
        b_above=Rational(5, 10),
        refusals=(NO_DEAD_TIME_RATIO,),
    )


def with_filter(data: Mapping[Symbol, Expr]) -> dict[Symbol, Expr]:
    """Process data adjusted for a derivative filter of time constant T_f, section 5.3.2.

    Half of T_f goes to the (shorter) lag, half to the dead time; gains stay. So the sum of all lags and dead times,
    which is the area above the step response divided by K_p, grows by T_f as it must.

    >>> with_filter({T: T, L: L})
    {T: T + T_f/2, L: L + T_f/2}
    """
    shorter = T if T in data else T_2
    dead = L if L in data else L_1
    return {symbol: value + T_f / 2 if symbol in (shorter, dead) else value for symbol, value in data.items()}


def rules() -> tuple[Rule, ...]:
    """By experiment: step, frequency, both."""
    return pi_step(), pid_step(), pi_frequency(), pid_frequency(), pid_combined()
