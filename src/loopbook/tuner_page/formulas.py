"""The tuning rules as JavaScript: printed from the SymPy expressions that compute them in Python.

A rule becomes an object with its words and its formulas as functions of the quantities `q` (Kp, T, L, ...), a caution
``[when, text, shows]``. Beside them: the equations of the two-lag model, the smooth branch of MIGO, the PID by angles.
"""

import json
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any

import sympy
from sympy.printing.jscode import JavascriptCodePrinter

from derivations.experiments import two_lags
from derivations.loop import robustness
from derivations.tuning import pid_by_angles
from derivations.tuning.catalogue import catalogue
from derivations.tuning.letters import QUANTITIES
from derivations.tuning.rule import NONE, OFF, Caution, Rule
from derivations.tuning.takes import Takes

TAKES = {
    Takes.STEP: "step",
    Takes.INTEGRATING_STEP: "integratingStep",
    Takes.ONE_LAG: "oneLag",
    Takes.TWO_LAGS_OF_MODEL: "twoLagsOfModel",
    Takes.FREQUENCY_AND_GAIN: "frequencyAndGain",
    Takes.TWO_LAGS: "twoLags",
    Takes.PULSE: "pulse",
    Takes.FREQUENCY: "frequency",
}


class _Printer(JavascriptCodePrinter):
    """Quantities as properties of q, the rest as it is."""

    def _print_Symbol(self, expr: sympy.Symbol) -> str:
        return f"q.{QUANTITIES.get(expr, expr)}"


class _Plain(JavascriptCodePrinter):
    """Symbols as arguments, named without what JavaScript does not allow."""

    def _print_Symbol(self, expr: sympy.Symbol) -> str:
        return _word(expr)


def _word(symbol: sympy.Symbol) -> str:
    return str(symbol).replace("'", "_slope").replace("omega_180", "w").replace("omega", "w")


def _of_quantities(expression: Any) -> str:
    return f"(q) => {_Printer().doprint(expression)}"


def _function(arguments: Sequence[sympy.Symbol], expression: Any) -> str:
    names = ", ".join(_word(a) for a in arguments)
    return f"({names}) => {_Plain().doprint(expression)}"


def _caution(caution: Caution, sentences: list[str]) -> str:
    shows = ", ".join(f"{json.dumps(name)}: {_of_quantities(e)}" for name, e in caution.shows.items())
    when = {sympy.true: "() => true", sympy.false: "() => false"}.get(caution.when) or _of_quantities(caution.when)
    if caution.text not in sentences:
        sentences.append(caution.text)
    return f"[{when}, sentences[{sentences.index(caution.text)}], {{ {shows} }}]"


def _cautions(cautions: Sequence[Caution], sentences: list[str]) -> str:
    return f"[{', '.join(_caution(caution, sentences) for caution in cautions)}]"


def _words(rule: Rule) -> dict[str, Any]:
    """What is said of a rule."""
    words: dict[str, Any] = {"name": rule.name, "title": rule.title, "takes": TAKES[rule.takes], "action": rule.action}
    words |= {"integrating": rule.integrating, "source": rule.source, "year": rule.year, "aim": rule.aim}
    if rule.variant_of:
        words["variantOf"] = rule.variant_of
    asks = [str(letter) for letter in rule.inputs if letter not in QUANTITIES]
    if asks or "closed" in {QUANTITIES.get(letter) for letter in rule.inputs} - {
        QUANTITIES[letter] for letter in rule.defaults
    }:
        words["asks"] = [*asks, *(["closed"] if not asks else [])]
    equations = {name: f"{e.lhs} = {sympy.sstr(_decimals(e.rhs))}" for name, e in rule.equations().items()}
    words["equations"] = list(equations.values())
    return words


def _formulas(rule: Rule, sentences: list[str]) -> str:
    """What computes a rule; sentences: of its cautions."""
    formulas: Mapping[str, Any] = {"K": rule.K, "Ti": rule.Ti, "Td": rule.Td}
    parts = [f"{name}: {_of_quantities(e)}" for name, e in formulas.items() if e not in (NONE, OFF)]
    if rule.measure is not None:
        above = sympy.Gt(rule.measure, rule.b_above)
        parts.append(f"b: (q) => {_Printer().doprint(sympy.Piecewise((1, above), (0, True)))}")
    elif not rule.b:
        parts.append("b: () => 0")
    defaults = ", ".join(f"{QUANTITIES[letter]}: {_of_quantities(e)}" for letter, e in rule.defaults.items())
    parts += [f"defaults: {{ {defaults} }}"] * bool(defaults)
    for name, cautions in (("refusals", rule.refusals + rule.extrapolates), ("cautions", rule.cautions)):
        parts += [f"{name}: {_cautions(cautions, sentences)}"] * bool(cautions)
    needs = sorted({QUANTITIES[letter] for letter in rule.inputs if letter in QUANTITIES} & {"L", "L1"})
    if needs and "closed" not in _names(rule):
        parts.append(f"dead: {json.dumps(needs)}")
    return f"{{ {', '.join(parts)} }}"


def _names(rule: Rule) -> set[str]:
    return {QUANTITIES.get(letter, str(letter)) for letter in rule.inputs}


def _decimals(expression: Any) -> Any:
    return expression.replace(lambda e: e.is_Rational and not e.is_Integer, lambda e: sympy.Float(str(float(e))))


def _two_lags() -> str:
    """T1 and L1 of the two-lag model, and what the step response at T63 lacks."""
    found = two_lags.residuals(sympy.exp(-1))
    names = (two_lags.T_1, two_lags.T_2, two_lags.L_1, two_lags.T_63)
    first = (two_lags.alpha, two_lags.omega, two_lags.K_p, two_lags.K_u)
    parts = {
        "firstLag": _function(first, two_lags.first_lag_without_cancellation()),
        "deadTime": _function((two_lags.omega, two_lags.T_1, two_lags.T_2), two_lags.dead_time()),
        "lacks": _function(names, found.e1),
        "lacksEqual": _function(names, found.e1_equal),
    }
    return "".join(f"    {name}: {text},\n" for name, text in parts.items())


def _branch() -> str:
    """k, ki and kd on the smooth branch of MIGO, and its circle."""
    d, found, circle = robustness, robustness.smooth_branch(), robustness.joint_circle()
    arguments = (d.w, d.a, d.b, d.r, d.da, d.db, d.C, d.R)
    parts = {
        "k": _function(arguments, found.k),
        "ki": _function(arguments, found.k_i.subs(d.k_d, 0)),
        "kd": _function(arguments, found.k_d),
        "centre": _function((d.M,), -circle.centre),
        "radius": _function((d.M,), circle.radius),
    }
    return "".join(f"    {name}: {text},\n" for name, text in parts.items())


def _angles() -> str:
    """The PID with a phase margin at a frequency."""
    a = pid_by_angles
    parts = {"lead": _function((a.phase, a.margin, a.f, a.a), a.lead())}
    parts |= {name: _function((a.w, a.k, a.f, a.b, a.a), e) for name, e in a.parallel().items()}
    return "".join(f"    {name}: {text},\n" for name, text in parts.items())


@cache
def _rules() -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The formulas of all rules, and the sentences of their cautions."""
    sentences: list[str] = []
    rules = tuple(_formulas(rule, sentences) for rule in catalogue().values())
    return rules, tuple(sentences)


def rules_words() -> dict[str, Any]:
    """What is said of the rules, for `texts`."""
    return {"rules": [_words(rule) for rule in catalogue().values()], "sentences": _rules()[1]}


@cache
def rules_script() -> str:
    """The text of the module `rules/formulas.js`."""
    rules = ", ".join(_rules()[0])
    return (
        'import { texts } from "../core/texts.js";\n'
        "const sentences = texts.sentences;\n"
        "const EMPTY = { defaults: {}, refusals: [], cautions: [], dead: [], b: () => 1 };\n"
        f"export const published = [{rules}].map((rule, i) => ({{ ...EMPTY, ...texts.rules[i], ...rule }}));\n"
        f"export const twoLagEquations = {{\n{_two_lags()}}};\n"
        f"export const migoBranch = {{\n{_branch()}}};\n"
        f"export const byAngles = {{\n{_angles()}}};\n"
    )
