"""Tuning rules as SymPy expressions: the formula that is shown and the number that is computed come from one object.

A rule is empirical: it is cited, not derived. Each variant of "the same" rule that a source prints is a rule of its
own, with its own name, because 0.12 T_u and 0.125 T_u are different regulators.

All rules give the standard form ``K (1 + 1/(s Ti) + s Td)``; a parallel or series form is a conversion afterwards.
"""

from dataclasses import dataclass
from functools import cache

import sympy as sp
from sympy import Integer, Rational

k, T, L = sp.symbols("k T T_0", positive=True)
"""First-order model with dead time, ``k exp(-s T_0)/(1 + s T)``: gain [y/u], time constant [s], dead time [s]."""
Ku, Tu = sp.symbols("K_u T_u", positive=True)
"""Ultimate gain [u/y] and ultimate period [s]: where a proportional loop oscillates without decay."""
lam = sp.Symbol("lambda", positive=True)
"""Wanted closed-loop time constant [s]; SIMC calls it tau_c."""
a = k * L / T
"""Normalised dead time times gain: how far the first-order response lags, in units of y/u."""

NONE, OFF = sp.oo, Integer(0)
"""No integral action is Ti = infinity, no derivative action is Td = 0."""


@dataclass(frozen=True)
class Rule:
    """One row of one published table.

    inputs: the symbols the formulas need. K [u/y], Ti [s], Td [s]: the formulas. source: who, where.
    """

    name: str
    inputs: tuple[sp.Symbol, ...]
    K: sp.Expr
    Ti: sp.Expr
    Td: sp.Expr
    source: str

    def equations(self) -> dict[str, sp.Eq]:
        """The rule as equations to display; a term that is switched off is left out."""
        wanted = {"K": self.K, "Ti": self.Ti, "Td": self.Td}
        names = {"K": "K", "Ti": "T_i", "Td": "T_d"}
        return {n: sp.Eq(sp.Symbol(names[n]), e) for n, e in wanted.items() if e not in (NONE, OFF)}


ARTICLE = "pid-article"
ZN42 = "J. G. Ziegler and N. B. Nichols, Optimum settings for automatic controllers, Trans. ASME 64 (1942)"
CHR52 = "K. L. Chien, J. A. Hrones and J. B. Reswick, On the automatic control of generalized passive systems (1952)"


def _catalogue(*rules: Rule) -> dict[str, Rule]:
    by_name = {rule.name: rule for rule in rules}
    if len(by_name) != len(rules):
        raise ValueError("two rules of one name")
    return by_name


@cache
def step_rules() -> dict[str, Rule]:
    """Ziegler and Nichols on a step response, by name.

    The article prints Ti = 3 T0 for PI; the paper has T0/0.3 = 3.33 T0. Both are here.
    """
    x = (k, T, L)
    article = f"{ARTICLE}, table of the step-response method"
    return _catalogue(
        Rule("zn-step-p", x, 1 / a, NONE, OFF, f"{ZN42}; {article}"),
        Rule("zn-step-pi", x, Rational(9, 10) / a, L / Rational(3, 10), OFF, ZN42),
        Rule("zn-step-pi-article", x, Rational(9, 10) / a, 3 * L, OFF, article),
        Rule("zn-step-pid", x, Rational(6, 5) / a, 2 * L, L / 2, f"{ZN42}; {article}"),
    )


@cache
def ultimate_rules() -> dict[str, Rule]:
    """Ziegler and Nichols on the ultimate gain and period, by name.

    classical: 0.5, 0.45 and Tu/1.2, 0.6 and Tu/2 and Tu/8. The article prints 0.85 Tu for PI and 0.12 Tu for PID.
    """
    x = (Ku, Tu)
    article = f"{ARTICLE}, table of the ultimate-gain method"
    return _catalogue(
        Rule("zn-ultimate-p", x, Ku / 2, NONE, OFF, f"{ZN42}; {article}"),
        Rule("zn-ultimate-pi", x, Rational(9, 20) * Ku, Tu / Rational(6, 5), OFF, ZN42),
        Rule("zn-ultimate-pi-article", x, Rational(9, 20) * Ku, Rational(85, 100) * Tu, OFF, article),
        Rule("zn-ultimate-pid", x, Rational(3, 5) * Ku, Tu / 2, Tu / 8, f"{ZN42}; double-tank, section on PID"),
        Rule("zn-ultimate-pid-article", x, Rational(3, 5) * Ku, Tu / 2, Rational(12, 100) * Tu, article),
    )


@cache
def chr_rules() -> dict[str, Rule]:
    """Chien, Hrones and Reswick for set-point changes, without overshoot (-0) and with 20 % (-20), by name."""
    x = (k, T, L)
    source = f"{CHR52}; {ARTICLE}, tables of the Chien-Hrones-Reswick method"
    return _catalogue(
        Rule("chr-p-0", x, Rational(3, 10) / a, NONE, OFF, source),
        Rule("chr-pi-0", x, Rational(35, 100) / a, Rational(6, 5) * T, OFF, source),
        Rule("chr-pid-0", x, Rational(6, 10) / a, T, L / 2, source),
        Rule("chr-p-20", x, Rational(7, 10) / a, NONE, OFF, source),
        Rule("chr-pi-20", x, Rational(6, 10) / a, T, OFF, source),
        Rule("chr-pid-20", x, Rational(95, 100) / a, Rational(14, 10) * T, Rational(47, 100) * L, source),
    )


@cache
def lambda_rules() -> dict[str, Rule]:
    """Pole cancellation with a wanted closed-loop time constant, by name.

    first-order-pi: Ti = T without dead time; lambda is the closed loop's time constant, exactly.
    first-order-pi-script: the same with lambda = i T, the dimensionless i that the article's script runs through.
    lambda-pi, lambda-pid: for a model with dead time (E. B. Dahlin 1968; the PID row with exp(-sL) by Padé of order 1).
    """
    i = sp.Symbol("i", positive=True)
    dahlin = "E. B. Dahlin, Designing and tuning digital controllers (1968); Åström and Hägglund, Advanced PID Control"
    return _catalogue(
        Rule("first-order-pi", (k, T, lam), T / (lam * k), T, OFF, f"{ARTICLE}, section on the first-order plant"),
        Rule("first-order-pi-script", (k, T, i), T / (i * T * k), T, OFF, f"{ARTICLE}, file pid_script1.m"),
        Rule("lambda-pi", (k, T, L, lam), T / (k * (lam + L)), T, OFF, dahlin),
        Rule(
            "lambda-pid",
            (k, T, L, lam),
            (L / 2 + T) / (k * (L / 2 + lam)),
            T + L / 2,
            T * L / (L + 2 * T),
            dahlin,
        ),
    )


@cache
def simc_rules() -> dict[str, Rule]:
    """S. Skogestad's SIMC rules, by name; tau_c is `lam`, the recommended choice is tau_c = T0.

    The PID rule is for a second time constant T2 and is published for the series form; here its standard form.
    """
    T2 = sp.Symbol("T_2", positive=True)
    source = (
        "S. Skogestad, Simple analytic rules for model reduction and PID controller tuning, J. Process Control (2003)"
    )
    integral = sp.Min(T, 4 * (lam + L))
    gain = T / (k * (lam + L))
    factor = 1 + T2 / integral
    return _catalogue(
        Rule("simc-pi", (k, T, L, lam), gain, integral, OFF, source),
        Rule("simc-pid", (k, T, T2, L, lam), gain * factor, integral * factor, T2 / factor, source),
    )


def rule(name: str) -> Rule:
    """Any rule by its name. Raises KeyError with the known names.

    >>> rule("zn-step-pid").K
    6*T/(5*T_0*k)
    """
    known = step_rules() | ultimate_rules() | chr_rules() | lambda_rules() | simc_rules()
    if name not in known:
        raise KeyError(f"no tuning rule {name!r}; known: {', '.join(sorted(known))}")
    return known[name]
