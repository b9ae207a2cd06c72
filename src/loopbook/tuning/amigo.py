"""AMIGO: PI and PID settings from a step response, from a frequency point, or from both.

Each function takes the data of one kind of experiment (`loopbook.experiments.data`), computes with the expressions of
`derivations.tuning.amigo`, and returns the settings with the set-point weight b, the relative dead time tau or the gain
ratio kappa, and notes on how far the rule can be trusted there. Data of another kind are refused with the rule that
fits.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any

from loopbook.experiments.data import (
    FrequencyData,
    IntegratingPulseData,
    IntegratingStepData,
    StepData,
    TwoLagData,
)
from loopbook.tuning.amigo_filter import with_filter
from loopbook.tuning.rule import RuleDoesNotApply, Tuning

__all__ = [
    "Amigo",
    "decimals",
    "pi_frequency",
    "pi_step",
    "pi_step_integrating",
    "pi_step_limit",
    "pid_combined",
    "pid_combined_integrating",
    "pid_frequency",
    "pid_step",
    "pid_step_integrating",
    "with_filter",
]

if TYPE_CHECKING:
    from derivations.tuning.amigo import Rule

SOURCE = "Åström and Hägglund, Advanced PID control (2006); pid-report, section {}"
FITTING = {
    StepData: "pi_step or pid_step",
    IntegratingStepData: "pi_step_integrating or pid_step_integrating",
    FrequencyData: "pi_frequency or pid_frequency",
    TwoLagData: "pid_combined",
    IntegratingPulseData: "pid_combined_integrating",
}


@dataclass(frozen=True)
class Amigo(Tuning):
    """AMIGO settings; derivative on the measurement.

    tau: relative dead time L/(L+T), 0 for an integrating process, None where no step was made. kappa: gain ratio
    K180/Kp, None where no frequency experiment was made.
    """

    tau: float | None = None
    kappa: float | None = None

    @property
    def b(self) -> float:
        """Set-point weight, 0 or 1."""
        return self.pid.b

    @property
    def ki(self) -> float:
        """Integral gain K/Ti [u/(y s)]."""
        return self.K / self.Ti

    @property
    def kd(self) -> float:
        """Derivative gain K Td [u s/y]."""
        return self.K * self.Td


def pi_step(data: StepData) -> Amigo:
    """PI from a step response (section 5.3.3).

        K = 0.15/Kp + (0.35 - L T/(L+T)^2) T/(Kp L),   Ti = 0.35 L + 13 L T^2/(T^2 + 12 L T + 7 L^2)
        b = 0 for tau <= 0.3, 1 above

    Raises RuleDoesNotApply for L = 0 (the gain would be infinite) and for data of another experiment.

    >>> settings = pi_step(StepData(Kp=1, T=1.04, L=0.075))
    >>> round(settings.K, 4), round(settings.Ti, 4), settings.b
    (4.1333, 0.5389, 0.0)
    """
    return _from_step("pi_step", data, StepData, data_to_numbers=lambda d: (d.Kp, d.T, d.L))


def pid_step(data: StepData) -> Amigo:
    """PID from a step response (section 5.3.4).

        K = (0.2 + 0.45 T/L)/Kp,   Ti = (0.4 L + 0.8 T)/(L + 0.1 T) L,   Td = 0.5 L T/(0.3 L + T)
        b = 0 for tau <= 0.5, 1 above

    Conservative for tau < 0.5: the result's notes say so. Raises RuleDoesNotApply as `pi_step` does.

    >>> settings = pid_step(StepData(Kp=1, T=1, L=1))
    >>> round(settings.K, 4), round(settings.Ti, 4), round(settings.Td, 4)
    (0.65, 1.0909, 0.3846)
    """
    return _from_step("pid_step", data, StepData, data_to_numbers=lambda d: (d.Kp, d.T, d.L))


def pi_step_integrating(data: IntegratingStepData) -> Amigo:
    """PI for an integrating process (section 5.3.3): K = 0.35/(Kv L), Ti = 13.4 L, b = 0.

    >>> round(pi_step_integrating(IntegratingStepData(Kv=1, L=1)).Ti, 6)
    13.4
    """
    return _from_step("pi_step_integrating", data, IntegratingStepData, lambda d: (d.Kv, d.L))


def pi_step_limit(data: IntegratingStepData) -> Amigo:
    """The limit of `pi_step` for T -> infinity: as `pi_step_integrating` with Ti = 13.35 L.

    >>> round(pi_step_limit(IntegratingStepData(Kv=1, L=1)).Ti, 6)
    13.35
    """
    return _from_step("pi_step_limit", data, IntegratingStepData, lambda d: (d.Kv, d.L))


def pid_step_integrating(data: IntegratingStepData) -> Amigo:
    """PID for an integrating process (section 5.3.4): K = 0.45/(Kv L), Ti = 8 L, Td = 0.5 L, b = 0.

    The report prints K = 0.45/Kv; the L is in the limit of `pid_step` for T -> infinity and in the units.

    >>> pid_step_integrating(IntegratingStepData(Kv=1, L=2)).K
    0.225
    """
    return _from_step("pid_step_integrating", data, IntegratingStepData, lambda d: (d.Kv, d.L))


def pi_frequency(data: FrequencyData, Kp: float, extrapolate: bool = False) -> Amigo:
    """PI from the ultimate point and the static gain (section 5.3.5), kappa = K180/Kp.

        K = 0.16/K180,   Ti = T180/(1 + 4.5 kappa)

    Kp [y/u]: from a step response; math.inf for an integrating process, which is kappa = 0. The rule is meant for
    kappa > 0.2: below, RuleDoesNotApply, unless extrapolate is True, which computes and notes it. No rule for b: 0.

    >>> round(pi_frequency(FrequencyData(K180=0.5, T180=2.0), Kp=1.0).Ti, 4)
    0.6154
    """
    return _from_frequency("pi_frequency", data, Kp, extrapolate)


def pid_frequency(data: FrequencyData, Kp: float, extrapolate: bool = False) -> Amigo:
    """PID from the ultimate point and the static gain (section 5.3.6), kappa = K180/Kp.

        K = (0.3 - 0.1 kappa^4)/K180,   Ti = 0.6 T180/(1 + 2 kappa),   Td = 0.15 (1 - kappa)/(1 - 0.95 kappa) T180

    Kp, extrapolate and b as in `pi_frequency`.

    >>> round(pid_frequency(FrequencyData(K180=0.5, T180=2.0), Kp=1.0).Td, 4)
    0.2857
    """
    return _from_frequency("pid_frequency", data, Kp, extrapolate)


def pid_combined(data: TwoLagData, tau: float) -> Amigo:
    """PID from a step and a frequency experiment together (section 5.3.7.1).

        K  = (a1 + a2 T1/L1 + a3 T2/L1 + a4 T1 T2/L1^2)/Kp
        ki = (b1/L1 + b2 T1/L1^2 + b3 T2/L1^2 + b4 T1 T2/L1^3)/Kp
        kd = (c1 L1 + c2 T1 + c3 T2 + c4 T1 T2/L1) (T1+T2)/(T1+T2+L1)/Kp,   Ti = K/ki,   Td = kd/K

    with the twelve weights of `derivations.tuning.amigo.SECOND_ORDER`. tau: of the step data, for b (0 up to 0.5, 1
    above). Raises RuleDoesNotApply for L1 = 0.

    >>> settings = pid_combined(TwoLagData(Kp=1, T1=0.9988, T2=0.1057, L1=0.0102), tau=0.0673)
    >>> round(settings.K, 3), round(settings.Ti, 4), round(settings.Td, 4)
    (58.581, 0.1291, 0.0521)
    """
    _expect("pid_combined", data, TwoLagData)
    _needs_dead_time("pid_combined", data.L1)
    if not 0 <= tau <= 1:
        raise RuleDoesNotApply(f"pid_combined: tau = {tau!r} is no relative dead time, which lies between 0 and 1")
    return _result("pid_combined", (data.Kp, data.T1, data.T2, data.L1), tau=tau)


def pid_combined_integrating(data: IntegratingPulseData) -> Amigo:
    """PID for an integrating process from its response to a short pulse (section 5.3.7.2).

        K = (a2/L1 + a4 T2/L1^2)/Kv,   ki = (b2/L1^2 + b4 T2/L1^3)/Kv,   kd = (c2 + c4 T2/L1)/Kv

    b = 0: an integrating process has tau = 0.

    >>> round(pid_combined_integrating(IntegratingPulseData(Kv=1, T2=0, L1=1)).K, 4)
    0.37
    """
    _expect("pid_combined_integrating", data, IntegratingPulseData)
    _needs_dead_time("pid_combined_integrating", data.L1)
    return _result("pid_combined_integrating", (data.Kv, data.T2, data.L1), tau=0.0)


def decimals(expression: Any) -> Any:
    """A rule's expression for the eye: fractions as the decimals they are, such as 0.35 for 7/20.

    >>> from derivations.tuning.amigo import pi_step_integrating
    >>> decimals(pi_step_integrating().Ti)
    13.4*L
    """
    import sympy

    return expression.replace(lambda e: e.is_Rational and not e.is_Integer, lambda e: sympy.Float(str(float(e))))


def _from_step(name: str, data: Any, kind: type, data_to_numbers: Callable) -> Amigo:
    _expect(name, data, kind)
    _needs_dead_time(name, data.L)
    return _result(name, data_to_numbers(data), tau=getattr(data, "tau", 0.0))


def _from_frequency(name: str, data: Any, Kp: float, extrapolate: bool) -> Amigo:
    _expect(name, data, FrequencyData)
    if not Kp > 0:
        raise RuleDoesNotApply(f"{name}: Kp = {Kp!r} must be positive (math.inf for an integrating process)")
    kappa = data.kappa(Kp)
    rule = _rule(name)
    least = float(rule.good["K"][1])
    if kappa >= 1:
        raise RuleDoesNotApply(
            f"{name}: kappa = K180/Kp = {kappa:.4g}: no gain at -180 degrees reaches the static gain of a lag and a "
            "dead time; check K180 and Kp"
        )
    if kappa <= least and not extrapolate:
        better, functions = (
            ("step and frequency together", "pid_combined")
            if kappa
            else (
                "the rules for integrating processes",
                "pi_step_integrating, pid_step_integrating, pid_combined_integrating",
            )
        )
        raise RuleDoesNotApply(
            f"{name}: kappa = K180/Kp = {kappa:.4g} <= {least:g}: the process is dominated by its lag and these "
            f"settings are not appropriate; take {better}",
            f"use {functions}; extrapolate=True computes them all the same",
        )
    return _result(name, (data.K180, data.T180, kappa), kappa=kappa)


def _expect(name: str, data: Any, kind: type) -> None:
    if not isinstance(data, kind):
        fitting = FITTING.get(type(data), "data of loopbook.experiments")
        raise RuleDoesNotApply(f"{name} takes {kind.__name__}, got {type(data).__name__}: use {fitting}")


def _needs_dead_time(name: str, L: float) -> None:
    if L == 0:
        raise RuleDoesNotApply(
            f"{name}: without dead time (L = 0) its gain is infinite: the process is a pure lag; "
            "use loopbook.tuning.first_order, or give the dead time that the loop's actuator and sampling add"
        )


def _rule(name: str) -> "Rule":
    from derivations.tuning import amigo

    return getattr(amigo, name)()


@cache
def _functions(name: str) -> list[Callable]:
    import sympy

    rule = _rule(name)
    return [sympy.lambdify(rule.inputs, e, "math") for e in (rule.K, rule.Ti, rule.Td)]


def _result(name: str, numbers: tuple[float, ...], tau: float | None = None, kappa: float | None = None) -> Amigo:
    from loopbook.controllers.pid_forms import PidStandard

    rule = _rule(name)
    K, Ti, Td = (float(f(*numbers)) for f in _functions(name))
    b = 0.0 if rule.b_above is None or tau is None else float(tau > float(rule.b_above))
    pid = PidStandard(K=K, Ti=Ti, Td=Td, b=b)
    return Amigo(pid, rule.name, SOURCE.format(rule.section), _notes(rule, tau, kappa), tau, kappa)


def _notes(rule: "Rule", tau: float | None, kappa: float | None) -> tuple[str, ...]:
    """One sentence for each parameter outside the range in which the source calls it good."""
    value = {"tau": tau, "kappa": kappa}
    notes = [
        f"{parameter} is fitted for {measure} > {float(limit):g}; here {measure} = {value[measure]:.3g}"
        for parameter, (measure, limit) in rule.good.items()
        if value[measure] is not None and value[measure] <= float(limit)
    ]
    if rule.name.startswith("PID step") and "frequency" not in rule.name and tau is not None and tau < 0.5:
        notes.insert(0, f"conservative for tau < 0.5; here tau = {tau:.3g}: gain too low, integral time too long")
    if rule.b_above is None:
        notes.append("the source gives no rule for b with frequency data: b = 0 is the cautious choice")
    return tuple(notes)
