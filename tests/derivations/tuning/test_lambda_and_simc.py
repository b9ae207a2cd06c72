"""What the rules with a wanted time constant promise, in exact numbers: the loop transfer function that they leave."""

import pytest
import sympy as sp

from derivations.tuning import direct_synthesis as synthesis
from derivations.tuning import lambda_tuning, simc
from derivations.tuning.letters import T_0, T_2, K_v, T, k, lam

s = synthesis.s


def loop(rule, plant):
    """C(s) G(s) without the dead time, C in standard form."""
    return sp.simplify(rule.K * (1 + 1 / (rule.Ti * s) + rule.Td * s) * plant)


def named(rules):
    return {rule.name: rule for rule in rules()}


def test_the_pi_rules_cancel_the_lag_and_leave_an_integrator():
    rules, lag = named(lambda_tuning.rules), k / (1 + s * T)
    assert sp.simplify(loop(rules["lambda-pi"], lag) - 1 / (s * (lam + T_0))) == 0
    closed = 1 / loop(rules["first-order-pi"], lag)
    assert sp.simplify(closed - lam * s) == 0, "the closed loop 1/(1 + lambda s)"


def test_the_lambda_pid_cancels_the_lag_and_the_pade_pole():
    """With exp(-s T0) as (1 - s T0/2)/(1 + s T0/2) the loop is (1 - s T0/2)/(s (lambda + T0/2))."""
    padé = k / (1 + s * T) / (1 + s * T_0 / 2)
    assert sp.simplify(loop(named(lambda_tuning.rules)["lambda-pid"], padé) - 1 / (s * (lam + T_0 / 2))) == 0


def test_simc_cancels_the_second_lag_and_with_a_short_first_one_that_too():
    rules = named(simc.rules)
    pid = rules["simc-pid"]
    short = {sp.Min(T, 4 * (lam + T_0)): T}  # the integral time where T is the smaller one
    settings = [sp.sympify(x, strict=True).subs(short) for x in (pid.K, pid.Ti, pid.Td)]
    C = settings[0] * (1 + 1 / (settings[1] * s) + settings[2] * s)
    assert sp.simplify(C * k / ((1 + s * T) * (1 + s * T_2)) - 1 / (s * (lam + T_0))) == 0


def test_simc_for_an_integrating_process_is_the_limit_of_a_long_lag():
    rules = named(simc.rules)
    long = {sp.Min(T, 4 * (lam + T_0)): 4 * (lam + T_0)}
    for action in ("pi", "pid"):
        stable, integrating = rules[f"simc-{action}"], rules[f"simc-{action}-integrating"]
        for name in ("K", "Ti", "Td"):
            one = sp.sympify(getattr(stable, name), strict=True).subs(long).subs(k, K_v * T)
            assert sp.simplify(one - getattr(integrating, name)) == 0, f"{action}, {name}"


def test_the_integral_time_of_an_integrator_gives_a_double_root():
    gain, Ti = synthesis.slope_gain(), synthesis.integral_time_of_an_integrator()
    roots = sp.roots(sp.numer(sp.together(s**2 + gain * K_v * (s + 1 / Ti))), s)
    assert list(roots.values()) == [2] and all(root.is_negative for root in roots)


def test_a_regulator_of_another_form_is_refused():
    with pytest.raises(ValueError, match=r"is not of the form K \(1 \+ 1/\(s Ti\) \+ s Td\)"):
        synthesis.standard(1 / (1 + synthesis.s))
