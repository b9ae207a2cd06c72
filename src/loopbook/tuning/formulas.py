"""A published rule computed: the expressions of `derivations.tuning` as functions, its cautions as sentences."""

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from derivations import tuning as folder
from derivations.tuning.takes import Takes
from loopbook.controllers.pid_forms import PidStandard
from loopbook.lazy import late
from loopbook.numerics.real_numbers import plain_number
from loopbook.printed.store import kept_for, lambda_text, run_text
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.result import RuleDoesNotApply, Tuning
from loopbook.tuning.rule import TuningRule

derived = late("derivations.tuning.catalogue")
letters = late("derivations.tuning.letters")

OPTIONS = {
    "closed": "the wanted time constant of the closed loop [s]",
    "i": "the wanted time constant of the closed loop over T",
    "Kp": "the static gain [y/u], math.inf for an integrating process; default that of the process",
    "tau": "the relative dead time for b; default that of the process's step response",
    "extrapolate": "True computes also where the source calls the rule unfit",
}


@dataclass(frozen=True)
class PrintedFormula:
    """A derived expression as the text of a function of quantities, by their names (Kp, T, L, ...)."""

    names: tuple[str, ...]
    text: str

    def __call__(self, values: Mapping[str, float]) -> Any:
        return _function(self.text)(*(values[name] for name in self.names))

    def number(self, values: Mapping[str, float]) -> float:
        """Its value, infinite where it divides by zero."""
        try:
            return float(self(values))
        except ZeroDivisionError:
            return math.inf


@dataclass(frozen=True)
class SaidWhen:
    """A sentence that is said where a condition holds, see `derivations.tuning.rule.Caution`."""

    when: PrintedFormula
    text: str
    shows: Mapping[str, PrintedFormula]
    advice: str

    def holds(self, values: Mapping[str, float]) -> bool:
        return bool(self.when(values))

    def sentence(self, values: Mapping[str, float]) -> str:
        return self.text.format(**{**values, **{name: shown.number(values) for name, shown in self.shows.items()}})


@dataclass(frozen=True)
class Published:
    """A published rule as functions; its fields are those of `derivations.tuning.rule.Rule`, letters by their names.

    letters: the names of its inputs' quantities. own: of the inputs that are options of the rule's own.
    """

    name: str
    source: str
    takes: Takes
    letters: tuple[str, ...]
    own: tuple[str, ...]
    K: PrintedFormula
    Ti: PrintedFormula
    Td: PrintedFormula
    b: int
    c: int
    measure: PrintedFormula | None
    b_above: float | None
    defaults: Mapping[str, PrintedFormula]
    cautions: tuple[SaidWhen, ...]
    refusals: tuple[SaidWhen, ...]
    extrapolates: tuple[SaidWhen, ...]

    @classmethod
    def read(cls, plain: Mapping[str, Any]) -> "Published":
        """From what `_plain` gives."""
        known = dict(plain) | {"takes": Takes(plain["takes"])}
        known |= {name: tuple(plain[name]) for name in ("letters", "own")}
        known |= {name: PrintedFormula(tuple(plain[name][0]), plain[name][1]) for name in ("K", "Ti", "Td")}
        known["measure"] = _formula(plain["measure"]) if plain["measure"] else None
        known["defaults"] = {name: _formula(text) for name, text in plain["defaults"].items()}
        for kind in ("cautions", "refusals", "extrapolates"):
            known[kind] = tuple(
                SaidWhen(_formula(when), text, {n: _formula(f) for n, f in shows.items()}, advice)
                for when, text, shows, advice in plain[kind]
            )
        return cls(**known)


def _formula(plain: Any) -> PrintedFormula:
    return PrintedFormula(tuple(plain[0]), plain[1])


@cache
def _function(text: str) -> Callable[..., Any]:
    return run_text(text, "math")


def published() -> list[TuningRule]:
    """Every published rule as one that runs, module by module."""
    added = [path for path in folder.__path__ if Path(path) != Path(folder.__file__).parent]
    return [_as_tuning_rule(head, plain) for head, plain in _catalogue(*added)]


def _as_tuning_rule(head: Mapping[str, Any], plain: Mapping[str, Any]) -> TuningRule:
    """The rule that runs, its flags read off the formulas."""
    takes, own = Takes(plain["takes"]), plain["own"]
    names = [*own, *["Kp"] * (takes is Takes.FREQUENCY_AND_GAIN), *["tau"] * (takes is Takes.TWO_LAGS)]
    names += ["extrapolate"] * bool(plain["extrapolates"])
    rule: list[Published] = []

    def settings(data: ProcessData, **options: Any) -> Tuning:
        if not rule:
            rule.append(Published.read(plain))
        return compute(rule[0], data, **options)

    return TuningRule(
        **head,
        name=plain["name"],
        source=plain["source"],
        takes=takes,
        settings=settings,
        options={name: OPTIONS[name] for name in names},
        required=tuple(name for name in own if name not in plain["defaults"]),
    )


@kept_for()
def _catalogue(*added: str) -> list[list[dict[str, Any]]]:
    """Every rule as plain data: what stands in tables, and what computes. added: folders beside the package's own."""
    return [[_head(rule), _plain(rule)] for rule in derived.catalogue().values()]


def _head(rule: Any) -> dict[str, Any]:
    text = "\n".join(f"{e.lhs} = {decimals(e.rhs)}" for e in rule.equations().values())
    names = ("title", "action", "integrating", "aim", "year", "variant_of")
    return {**{name: getattr(rule, name) for name in names}, "text": text}


def _plain(rule: Any) -> dict[str, Any]:
    quantities = letters.QUANTITIES
    own = [str(letter) for letter in rule.inputs if letter not in quantities]
    plain: dict[str, Any] = {name: getattr(rule, name) for name in ("name", "source", "b", "c")}
    plain |= {"takes": str(rule.takes), "letters": [_name(x) for x in rule.inputs]}
    plain |= {"own": [*own, *["closed"] * (letters.lam in rule.inputs)]}
    plain |= {name: _written(getattr(rule, name)) for name in ("K", "Ti", "Td")}
    plain["measure"] = None if rule.b_above is None else _written(rule.measure)
    plain["b_above"] = None if rule.b_above is None else float(rule.b_above)
    plain["defaults"] = {quantities[letter]: _written(e) for letter, e in rule.defaults.items()}
    for kind in ("cautions", "refusals", "extrapolates"):
        plain[kind] = [
            [_written(c.when), c.text, {n: _written(e) for n, e in c.shows.items()}, c.advice]
            for c in getattr(rule, kind)
        ]
    return plain


def _written(expression: Any) -> list[Any]:
    symbols = sorted(expression.free_symbols, key=str)
    return [[_name(x) for x in symbols], lambda_text(symbols, expression, "math")]


def _name(letter: Any) -> str:
    return letters.QUANTITIES.get(letter, str(letter))


def compute(rule: Published, data: ProcessData, extrapolate: bool = False, **options: float) -> Tuning:
    """The settings of a published rule; see `TuningRule` for what is given and refused."""
    beside = {name: _number(name, options[name]) for name in ("Kp", "tau") if name in options}
    numbers, how = data.numbers(rule.takes, **beside)
    values = {**numbers, **{name: _number(name, value) for name, value in options.items() if name != "Kp"}}
    missing = {*rule.letters} - {*rule.own, *values, "closed"}
    if missing:
        raise RuleDoesNotApply(f"the process {'integrates' if 'Kv' in values else 'does not integrate'}")
    for name, default in rule.defaults.items():
        values.setdefault(name, default.number(values))
    _positive(rule, values, values.keys() - numbers.keys() - options.keys())
    for caution in rule.refusals + (() if extrapolate else rule.extrapolates):
        if caution.holds(values):
            raise RuleDoesNotApply(caution.sentence(values), caution.advice)
    K, Ti, Td = (formula.number(values) for formula in (rule.K, rule.Ti, rule.Td))
    if not (0 < K < math.inf and Ti > 0 and 0 <= Td < math.inf):
        given = ", ".join(f"{name} = {value:.4g}" for name, value in values.items())
        raise RuleDoesNotApply(f"it gives K = {K:g}, Ti = {Ti:g} s, Td = {Td:g} s for {given}: no regulator")
    b = float(rule.b)
    if rule.measure is not None and rule.b_above is not None:
        b = float(rule.measure.number(values) > rule.b_above)
    notes = tuple(caution.sentence(values) for caution in rule.cautions if caution.holds(values))
    return Tuning(PidStandard(K, Ti, Td, b=b, c=float(rule.c)), rule.name, rule.source, notes, values, how)


def _number(name: str, value: Any) -> float:
    try:
        return float(plain_number(value))
    except TypeError as error:
        raise RuleDoesNotApply(f"{name}: {error}") from None


def _positive(rule: Published, values: Mapping[str, float], defaulted: Collection[str]) -> None:
    """A dead time of zero would give an infinite gain; an option is a positive time, closed zero beside a dead time."""
    asked = {*rule.letters}
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


def decimals(expression: Any) -> Any:
    """A rule's expression for the eye: fractions as the decimals they are, such as 0.35 for 7/20.

    >>> from derivations.tuning.amigo_integrating import pi_step_integrating
    >>> decimals(pi_step_integrating().Ti)
    13.4*L
    """
    import sympy

    return expression.replace(lambda e: e.is_Rational and not e.is_Integer, lambda e: sympy.Float(str(float(e))))
