"""The printed formulas and programs of the pole-placement section, each put beside what was derived."""

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import sympy

from derivations.algebra.delay_polynomials import K, Z, in_delays, polynomial
from derivations.pole_placement.diophantine import PolePlacement
from derivations.sampling.zero_order_hold import Sampled
from loopbook.documents.double_tank import long_fractions
from loopbook.documents.printed_formulas import formulas
from notebook_reports.formula.read import read_formula
from notebook_reports.ledger.document import Document
from notebook_reports.ledger.verdicts import rounds_to

REGULATOR = ("K_r", "c_1", "c_2", "c_3", "d_0", "d_1", "d_2")


def right_sides(document: Document, id: str) -> list[Any]:
    """Of the equations that a statement prints."""
    return [right for _, right in formulas(document.said(id))]


def two_forms_agree(printed: Mapping[str, Fraction]) -> bool:
    """Are the sampled model in z and the one in z^-1, both as printed, the same pair of polynomials?"""
    v = {id.removeprefix("sampled-"): x for id, x in printed.items()}
    in_z = in_delays((v["z-b3"] * Z + v["z-b4"]) / (Z**4 + v["z-a1"] * Z**3 + v["z-a2"] * Z**2))
    in_delay = polynomial([1, v["a1"], v["a2"]]), polynomial([0, 0, 0, v["b3"], v["b4"]])
    return all(sympy.expand(one - other) == 0 for one, other in zip(in_z, in_delay, strict=True))


def rows(design: PolePlacement) -> dict[str, Any]:
    """The rows of the system as the appendix numbers them, ``row-z5`` to ``row-z0``: left side minus right side."""
    return {f"row-z{5 - i}": sympy.expand(law.lhs - law.rhs) for i, law in enumerate(design.equations)}


def rows_agree(design: PolePlacement, document: Document) -> dict[str, bool]:
    """Is each printed row the derived one?"""
    printed = {id: formulas(document.said(id))[0] for id in rows(design)}
    derived = rows(design)
    return {id: bool(sympy.expand(left - right - derived[id]) == 0) for id, (left, right) in printed.items()}


def recursions(design: PolePlacement) -> tuple[Any, Any]:
    """y(k) and u(k) as the two difference equations give them, equalities."""
    return design.plant_equation(), design.regulator_equation()


def recursions_agree(design: PolePlacement, document: Document) -> dict[str, bool]:
    """Are the printed recursions, the expanded C, the rows of the start and those of the loop the derived ones?

    Both sides are compared. A row of the start is the recursion with nothing before the first sample.
    """
    both = [law.args for law in recursions(design)]
    first = int(document.said("start-up-rows").number("first"))
    before = {sympy.Function(name)(i): 0 for name in "uy" for i in range(first - 4, first)}
    rows_of = range(first, first + 4)
    starts = [(left.subs(K, i), right.subs(K, i).subs(before)) for i in rows_of for left, right in both]
    derived = {
        "plant-recursion": both[:1],
        "regulator-recursion": both[1:],
        "c-expanded": [(sympy.Symbol("C"), design.C_form)],
        "start-up-rows": starts,
        "loop-rows": both,
    }
    pairs = {id: zip(derived[id], formulas(document.said(id)), strict=True) for id in derived}
    return {
        id: all(left == at and sympy.expand(right - printed) == 0 for (left, right), (at, printed) in pair)
        for id, pair in pairs.items()
    }


def longest_shift(design: PolePlacement) -> int:
    """The most samples that a recursion looks back: its general row may begin one later."""
    signals = (f for law in recursions(design) for f in law.rhs.atoms(sympy.core.function.AppliedUndef))
    return int(max(K - f.args[0] for f in signals))


def laws_agree(design: PolePlacement, document: Document) -> dict[str, bool]:
    """Are the recursions, each shift a factor z^-1, the printed quotients of transforms?"""
    signals = dict(zip("yur", sympy.symbols("Y U R"), strict=True))
    forms = dict(zip(sympy.symbols("A B C D"), (design.A, design.B, design.C_form, design.D_form), strict=True))
    laws = [(out - law).subs(forms) for out, law in formulas(document.said("laws-behind"))]
    below = design.A, design.C_form
    agree = {}
    for name, newest, law, under, quotient in zip(
        ("process", "regulator"), "yu", recursions(design), below, laws, strict=True
    ):
        found = law.rhs.atoms(sympy.core.function.AppliedUndef)
        shifted = {f: signals[f.func.__name__] * Z ** (f.args[0] - K) for f in found}
        agree[name] = sympy.cancel(signals[newest] - law.rhs.subs(shifted) - under * quotient) == 0
    return agree


def model_form_agrees(model: Sampled, document: Document) -> dict[str, bool]:
    """Are the printed A and B, with the derived coefficients in them, the model's, and the printed process its B/A?"""
    claim = document.said("model-form")
    printed = zip(("A", "B"), right_sides(document, claim.id), strict=True)
    gaps = {f"${n}$": right.subs(model.coefficients) - getattr(model, n) for n, right in printed}
    process = read_formula(claim.text("process")).subs({"A": model.A, "B": model.B})
    gaps["the process"] = process - model.B / model.A
    return {name: sympy.simplify(gap) == 0 for name, gap in gaps.items()}


def closed_loop_agrees(document: Document) -> bool:
    """Is the printed Y/R the loop's, solved from its two laws, A Y = B U and C U = K_r R - D Y?"""
    A, B, C, D, Kr, Y, U, R = sympy.symbols("A B C D K_r Y U R")
    solved = sympy.solve([A * Y - B * U, C * U - Kr * R + D * Y], [Y, U])[Y]
    ((quotient, printed),) = formulas(document.said("closed-loop"))
    return bool(sympy.cancel(quotient.subs(Y, solved) - printed) == 0)


def degree_rules_hold(design: PolePlacement, document: Document) -> dict[str, bool]:
    """Do the printed rules for the degrees hold, and are there as many unknowns as powers?"""
    n = design.degrees
    degrees = {"n_a": n.a_prime, "n_b": n.b, "n_c": n.c, "n_d": n.d, "m": n.p}
    printed = formulas(document.said("degree-rules"))
    rules = {str(left): sympy.Eq(left, right).subs(degrees) == sympy.true for left, right in printed}
    return rules | {"as many unknowns as powers": n.unknowns == n.largest_p}


def shapes_agree(design: PolePlacement, document: Document) -> dict[str, bool]:
    """Are the printed forms of C' and D those of the derived degrees?"""
    pairs = zip(("$C'$", "$D$"), right_sides(document, "shapes"), (design.C_prime_form, design.D_form), strict=True)
    return {name: sympy.expand(one - other) == 0 for name, one, other in pairs}


def integrator_moved(design: PolePlacement, document: Document) -> tuple[Any, Any]:
    """(A C - A' C', C less the derived one) with A' and C as printed: zero where the integrator may move."""
    read = {"A": design.A, "Cprime": design.C_prime_form}
    A_prime, C = (right.subs(read) for right in right_sides(document, "integrator-moves"))
    return sympy.expand(design.A * C - A_prime * design.C_prime_form), sympy.expand(C - design.C_form)


def quotient_orders(design: PolePlacement, parameters: Mapping[str, Fraction], h: float) -> tuple[int, int]:
    """How many poles the closed loop has as the script builds it from quotients, and how many are left of them.

    parameters: numbers for all symbols of the design by name. Needs python-control.
    """
    import control

    delay = 1 / control.tf([1, 0], [1], h)  # z^-1
    numbers = {name: float(value) for name, value in parameters.items()}
    forms = (design.A, design.B, design.C_form, design.D_form)
    A, B, C, D = (sympy.lambdify(Z, form.subs(numbers))(1 / delay) for form in forms)
    total = numbers["K_r"] * B / (A * C + B * D)
    return len(total.poles()), len(control.minreal(total, tol=1e-3, verbose=False).poles())


def ratios(design: PolePlacement, coefficients: Mapping[Any, Fraction]) -> dict[str, int]:
    """Numerators and denominators of the parameters as polynomials in q, by the ids of the appendix."""
    found: dict[str, int] = {}
    for name, value in design.parameters.items():
        terms = sympy.Poly(value.subs(coefficients), sympy.Symbol("q")).terms()
        powers = {power: Fraction(int(c.p), int(c.q)) for (power,), c in terms}
        found |= long_fractions.as_printed(f"d_iterativ-{name.replace('_', '')}", powers)
    return found


def rounding(found: Mapping[str, Any], document: Document) -> int:
    """How many of the numbers, by id, round to what the document prints."""
    printed = document.printed.values
    return sum(rounds_to(value, printed[id].printed) for id, value in found.items() if id in printed)


def typed_in(document: Document) -> dict[str, dict[str, Fraction]]:
    """What the long expressions of the appendix, typed in as printed, give at the poles of the table, by name and q."""
    text = document.given("Appendix, d_iterativ")
    polynomials = {name: long_fractions.read_back(text, f"d_iterativ-{name.replace('_', '')}") for name in REGULATOR}
    poles = ("0.3", "0.5", "0.7")
    return {
        name: {q: long_fractions.value_at(polynomial, Fraction(q)) for q in poles}
        for name, polynomial in polynomials.items()
    }


def typed_in_agree(document: Document) -> dict[str, bool]:
    """Do they round to the table's cells?"""
    table = document.printed.values
    return {
        f"${name}$": all(
            rounds_to(value, table[f"regulator-{name.replace('_', '')}-q{q}"].printed) for q, value in values.items()
        )
        for name, values in typed_in(document).items()
    }
