"""A published rule computed: the expressions of `derivations.tuning` as functions, its cautions as sentences."""

import math
from collections.abc import Callable, Collection, Mapping
from functools import cache
from typing import Any

import sympy

from derivations.tuning.letters import QUANTITIES, lam
from derivations.tuning.rule import Caution, Rule
from derivations.tuning.takes import Takes
from loopbook.controllers.pid_forms import PidStandard
from loopbook.numerics.real_numbers import plain_number
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.result import RuleDoesNotApply, Tuning
from loopbook.tuning.rule import TuningRule

OPTIONS = {
    "closed": "the wanted time constant of the closed loop [s]",
    "i": "the wanted time constant of the closed loop over T",
    "Kp": "the static gain [y/u], math.inf for an integrating process; default that of the process",
    "tau": "the relative dead time for b; default that of the process's step response",
    "extrapolate": "True computes also where the source calls the rule unfit",
}


def as_tuning_rule(rule: Rule) -> TuningRule:
    """The rule that runs, its flags read off the formulas."""
    own = [str(letter) for letter in rule.inputs if letter not in QUANTITIES]
    own += ["closed"] * (lam in rule.inputs)
    names = [*own, *["Kp"] * (rule.takes is Takes.FREQUENCY_AND_GAIN), *["tau"] * (rule.takes is Takes.TWO_LAGS)]
    names += ["extrapolate"] * bool(rule.extrapolates)
    defaults = {QUANTITIES[letter] for letter in rule.defaults}
    return TuningRule(
        *(rule.name, rule.title, rule.takes, rule.action, rule.integrating, rule.aim, rule.year, rule.source),
        settings=lambda data, **options: compute(rule, data, **options),
        options={name: OPTIONS[name] for name in names},
        required=tuple(name for name in own if name not in defaults),
        variant_of=rule.variant_of,
        text="\n".join(f"{e.lhs} = {decimals(e.rhs)}" for e in rule.equations().values()),
    )


def compute(rule: Rule, data: ProcessData, extrapolate: bool = False, **options: float) -> Tuning:
    """The settings of a published rule; see `TuningRule` for what is given and refused."""
    beside = {name: _number(name, options[name]) for name in ("Kp", "tau") if name in options}
    numbers, how = data.numbers(rule.takes, **beside)
    values = {**numbers, **{name: _number(name, value) for name, value in options.items() if name != "Kp"}}
    missing = {QUANTITIES[letter] for letter in rule.inputs if letter in QUANTITIES} - {*values, "closed"}
    if missing:
        raise RuleDoesNotApply(f"the process {'integrates' if 'Kv' in values else 'does not integrate'}")
    for letter, default in rule.defaults.items():
        values.setdefault(QUANTITIES[letter], _value(default, values))
    _positive(rule, values, values.keys() - numbers.keys() - options.keys())
    for caution in rule.refusals + (() if extrapolate else rule.extrapolates):
        if _holds(caution, values):
            raise RuleDoesNotApply(_sentence(caution, values), caution.advice)
    K, Ti, Td = (_value(formula, values) for formula in (rule.K, rule.Ti, rule.Td))
    if not (0 < K < math.inf and Ti > 0 and 0 <= Td < math.inf):
        given = ", ".join(f"{name} = {value:.4g}" for name, value in values.items())
        raise RuleDoesNotApply(f"it gives K = {K:g}, Ti = {Ti:g} s, Td = {Td:g} s for {given}: no regulator")
    b = float(rule.b) if rule.b_above is None else float(_value(rule.measure, values) > float(rule.b_above))
    notes = tuple(_sentence(caution, values) for caution in rule.cautions if _holds(caution, values))
    return Tuning(PidStandard(K, Ti, Td, b=b, c=float(rule.c)), rule.name, rule.source, notes, values, how)


def _number(name: str, value: Any) -> float:
    try:
        return float(plain_number(value))
    except TypeError as error:
        raise RuleDoesNotApply(f"{name}: {error}") from None


def _positive(rule: Rule, values: Mapping[str, float], defaulted: Collection[str]) -> None:
    """A dead time of zero would give an infinite gain; an option is a positive time, closed zero beside a dead time."""
    asked = {_name(letter) for letter in rule.inputs}
    for name in ("closed", "i"):
        if name == "closed" and name in asked and name in defaulted and values[name] == 0:
            raise RuleDoesNotApply(
                "without dead time the recommended closed = T0 is zero and the gain infinite: give closed, the time "
                "constant that the closed loop shall have"
            )
        at_once = name == "closed" and values.get(name) == 0 and max(values.get("L", 0), values.get("L1", 0)) > 0
        if name in asked and not (at_once or (math.isfinite(values[name]) and values[name] > 0)):
            zero = " (or 0 beside a dead time)" if name == "closed" else ""
            raise RuleDoesNotApply(f"{name} = {values[name]:g} must be a positive number{zero}")
    if any(name in asked and values[name] == 0 and "closed" not in asked for name in ("L", "L1")):
        raise RuleDoesNotApply(
            "without dead time (L = 0) its gain is infinite: the process is a pure lag; give the dead "
            "time that the loop's actuator and sampling add, or take the rule that cancels the pole",
            "use first-order-pi",
        )


def _name(letter: sympy.Symbol) -> str:
    return QUANTITIES.get(letter, str(letter))


@cache
def _compiled(expression: sympy.Basic) -> tuple[tuple[str, ...], Callable]:
    letters = sorted(expression.free_symbols, key=str)
    return tuple(map(_name, letters)), sympy.lambdify(letters, expression, "math")


def _value(expression: sympy.Basic, values: Mapping[str, float]) -> Any:
    names, function = _compiled(expression)
    try:
        return float(function(*(values[name] for name in names)))
    except ZeroDivisionError:
        return math.inf


def _holds(caution: Caution, values: Mapping[str, float]) -> bool:
    names, function = _compiled(caution.when)
    return bool(function(*(values[name] for name in names)))


def _sentence(caution: Caution, values: Mapping[str, float]) -> str:
    return caution.text.format(**{**values, **{name: _value(e, values) for name, e in caution.shows.items()}})


def decimals(expression: Any) -> Any:
    """A rule's expression for the eye: fractions as the decimals they are, such as 0.35 for 7/20.

    >>> from derivations.tuning.amigo_integrating import pi_step_integrating
    >>> decimals(pi_step_integrating().Ti)
    13.4*L
    """
    return expression.replace(lambda e: e.is_Rational and not e.is_Integer, lambda e: sympy.Float(str(float(e))))
