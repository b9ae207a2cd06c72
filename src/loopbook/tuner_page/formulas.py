"""The tuning rules as JavaScript: printed from the SymPy expressions that compute them in Python.

A rule becomes an object with its words and its formulas as functions of the quantities `q` (Kp, T, L, ...), a caution
``[when, sentence, shows]`` that rules share. Beside them: the equations of the two-lag model, the smooth branch of
MIGO, the controllers by a phase margin and by the poles of the loop. Of a rule that an algorithm computes, the words
alone.
"""

import json
import re
from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cache
from typing import Any

import sympy
from sympy.printing.jscode import JavascriptCodePrinter

from derivations.experiments import two_lags
from derivations.loop import robustness
from derivations.tuning import by_damping, pi_by_margin, pid_by_angles
from derivations.tuning.catalogue import catalogue
from derivations.tuning.letters import QUANTITIES
from derivations.tuning.rule import NONE, OFF, Caution, Rule
from derivations.tuning.takes import Takes
from loopbook.tuning.registry import rules as registry
from loopbook.tuning.rule import TuningRule

TAKES = {
    Takes.STEP: "step",
    Takes.INTEGRATING_STEP: "integratingStep",
    Takes.ONE_LAG: "oneLag",
    Takes.TWO_LAGS_OF_MODEL: "twoLagsOfModel",
    Takes.FREQUENCY_AND_GAIN: "frequencyAndGain",
    Takes.TWO_LAGS: "twoLags",
    Takes.PULSE: "pulse",
    Takes.FREQUENCY: "frequency",
    Takes.PROCESS: "process",
}
ASKED = {"w": "w", "w0": "w", "zeta": "zeta", "phase_margin": "margin"}
"""What a rule must be given, and the wish of the page that gives it."""

RATIONAL = re.compile(r"\((\d+)/(\d+)\)|(?<![\w./*)])(\d+)/(\d+)(?![\w.(*])")


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


def _decimal(match: re.Match[str]) -> str:
    """A ratio of whole numbers as the decimal that is the same double; as it is where that is longer."""
    over, under = (int(n) for n in (match[1] or match[3], match[2] or match[4]))
    decimal = str(over / under)
    return decimal if Fraction(decimal) == Fraction(over, under) else match[0]


def _printed(printer: JavascriptCodePrinter, expression: Any) -> str:
    return RATIONAL.sub(_decimal, printer.doprint(expression))


def _of_quantities(expression: Any) -> str:
    return f"(q) => {_printed(_Printer(), expression)}"


def _function(arguments: Sequence[sympy.Symbol], expression: Any) -> str:
    names = ", ".join(_word(a) for a in arguments)
    return f"({names}) => {_printed(_Plain(), expression)}"


class _Cautions:
    """The cautions of all rules and their sentences, each once."""

    def __init__(self) -> None:
        self.sentences: list[str] = []
        self.texts: list[str] = []

    def numbers(self, cautions: Sequence[Caution]) -> str:
        """The places of these cautions among all, as an array."""
        return f"[{', '.join(str(_place(self.texts, self._text(caution))) for caution in cautions)}]"

    def _text(self, caution: Caution) -> str:
        shows = ", ".join(f"{name}: {_of_quantities(e)}" for name, e in caution.shows.items())
        when = {sympy.true: "() => true", sympy.false: "() => false"}.get(caution.when) or _of_quantities(caution.when)
        return f"[{when}, {_place(self.sentences, caution.text)}, {{ {shows} }}]"


def _place(texts: list[str], text: str) -> int:
    if text not in texts:
        texts.append(text)
    return texts.index(text)


def _words(rule: Rule | TuningRule) -> dict[str, Any]:
    """What is said of a rule, whether formulas or an algorithm compute it."""
    words: dict[str, Any] = {"name": rule.name, "title": rule.title, "takes": TAKES[rule.takes], "action": rule.action}
    words |= {"integrating": rule.integrating, "source": rule.source, "year": rule.year, "aim": rule.aim}
    if rule.variant_of:
        words["variantOf"] = rule.variant_of
    return words


def _words_of_algorithm(rule: TuningRule) -> dict[str, Any]:
    words = _words(rule)
    if rule.required:
        words["asks"] = [ASKED[name] for name in rule.required]
    return words | {"equations": rule.text.splitlines()}


def _words_of_formulas(rule: Rule) -> dict[str, Any]:
    words = _words(rule)
    asks = [str(letter) for letter in rule.inputs if letter not in QUANTITIES]
    if asks or "closed" in {QUANTITIES.get(letter) for letter in rule.inputs} - {
        QUANTITIES[letter] for letter in rule.defaults
    }:
        words["asks"] = [*asks, *(["closed"] if not asks else [])]
    equations = {name: f"{e.lhs} = {sympy.sstr(_decimals(e.rhs))}" for name, e in rule.equations().items()}
    words["equations"] = list(equations.values())
    return words


def _formulas(rule: Rule, said: _Cautions) -> str:
    """What computes a rule."""
    formulas: Mapping[str, Any] = {"K": rule.K, "Ti": rule.Ti, "Td": rule.Td}
    parts = [f"{name}: {_of_quantities(e)}" for name, e in formulas.items() if e not in (NONE, OFF)]
    above = rule.b if rule.measure is None else sympy.Gt(rule.measure, rule.b_above)
    if not isinstance(above, sympy.Rel):
        parts += ["b: () => 0"] * (not above)
    else:
        parts.append(f"b: (q) => Number({_printed(_Printer(), above)})")
    defaults = ", ".join(f"{QUANTITIES[letter]}: {_of_quantities(e)}" for letter, e in rule.defaults.items())
    parts += [f"defaults: {{ {defaults} }}"] * bool(defaults)
    for name, cautions in (("refusals", rule.refusals + rule.extrapolates), ("cautions", rule.cautions)):
        parts += [f"{name}: {said.numbers(cautions)}"] * bool(cautions)
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
    parts |= {str(name): _function((a.w, a.k, a.f, a.b, a.a), e) for name, e in a.parallel().items()}
    return "".join(f"    {name}: {text},\n" for name, text in parts.items())


def _gains() -> str:
    """Arrays of gains: the PI with a phase margin at a frequency; PI and PID by the poles of the loop."""
    m, d = pi_by_margin, by_damping
    found = {
        "margin": ((m.w, m.g, m.phase, m.margin), m.gains()),
        "PI": ((d.b, d.a_1, d.a_0, d.omega_0, d.zeta), d.pi()),
        "PID": ((d.b, d.a_2, d.a_1, d.a_0, d.omega_0, d.zeta), {k: e.subs(d.alpha, 1) for k, e in d.pid().items()}),
    }
    lines = []
    for name, (letters, gains) in found.items():
        texts = ", ".join(_printed(_Plain(), e) for e in gains.values())
        lines.append(f"    {name}: ({', '.join(_word(letter) for letter in letters)}) => [{texts}],\n")
    return "".join(lines)


@cache
def _rules() -> tuple[tuple[str, ...], _Cautions]:
    """The formulas of all rules, and their cautions."""
    said = _Cautions()
    return tuple(_formulas(rule, said) for rule in catalogue().values()), said


def rules_words() -> dict[str, Any]:
    """What is said of the rules, for `texts`: those with formulas, then those that algorithms compute."""
    computed = [rule for rule in registry().values() if rule.name not in catalogue()]
    words = [_words_of_formulas(rule) for rule in catalogue().values()]
    return {"rules": words + [_words_of_algorithm(rule) for rule in computed], "sentences": _rules()[1].sentences}


@cache
def rules_script() -> str:
    """The text of the module `rules/formulas.js`."""
    rules, said = _rules()
    return (
        f"export const published = [{', '.join(rules)}];\n"
        f"export const allCautions = [{', '.join(said.texts)}];\n"
        f"export const twoLagEquations = {{\n{_two_lags()}}};\n"
        f"export const migoBranch = {{\n{_branch()}}};\n"
        f"export const byAngles = {{\n{_angles()}}};\n"
        f"export const gainsBy = {{\n{_gains()}}};\n"
    )
