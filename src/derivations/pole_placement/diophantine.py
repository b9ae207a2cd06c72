"""Pole placement: the polynomial equation A'C' + BD = P in z^-1, solved exactly.

The plant is y = (B/A) u, the regulator u = (Kr r - D y)/C with C = S C', where S holds the factors that the regulator
must have, (1 - z^-1) for an integrator. The closed loop is y = Kr B/(A C + B D) r, and A C + B D = A S C' + B D. So S
may be moved to the plant, A' = A S, and what remains is

    A' C' + B D = P

for the wanted characteristic polynomial P. It is linear in the coefficients of C' and D. `regulator_degrees` says how
many there are and why, `place` solves for them over the field of rational functions of all symbols.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import product, zip_longest

import sympy as sp
from sympy.polys.constructor import construct_domain
from sympy.polys.matrices import DomainMatrix

from derivations.algebra.delay_polynomials import Z, coefficients, difference_equation, polynomial
from derivations.errors import LoopbookError
from derivations.pole_placement.regulator_degrees import Degrees


class PolePlacementError(LoopbookError):
    """The polynomial equation has no solution, or its data make no plant or no loop."""


class CommonFactor(PolePlacementError):
    """A' and B share a factor that P lacks. Attributes: factor (expression in z^-1, constant term 1), P."""

    def __init__(self, factor: sp.Expr, P: sp.Expr, z: sp.Symbol):
        self.factor, self.P = factor, P
        roots = _roots(factor, z)
        where = f" (z = {', '.join(str(r) for r in roots)})" if roots else ""
        super().__init__(
            f"A' and B share the factor {factor}{where}, which does not divide P = {P}. Every closed loop keeps that "
            "factor: cancel it in the plant, leave out an integrator that meets a zero at z = 1, or put it into P"
        )


class NoDelay(PolePlacementError):
    """B has a term without delay, or is zero. Attribute: B."""

    def __init__(self, B: sp.Expr):
        self.B = B
        what = "is zero: the input does not reach the output" if B == 0 else "has a term without delay"
        super().__init__(
            f"B = {B} {what}; a sampled plant starts with z^-1 or later, because y(k) is measured before u(k) is set"
        )


class NoStaticGain(PolePlacementError):
    """No Kr gives the closed loop static gain 1, because B(1) = 0 or P(1) = 0. Attributes: B_at_1, P_at_1."""

    def __init__(self, B_at_1: sp.Expr, P_at_1: sp.Expr):
        self.B_at_1, self.P_at_1 = B_at_1, P_at_1
        why = "the plant blocks constant inputs, B(1) = 0" if B_at_1 == 0 else "P has a root at z = 1"
        super().__init__(f"Kr = P(1)/B(1) does not exist: {why}")


def _roots(factor: sp.Expr, z: sp.Symbol) -> list[sp.Expr]:
    values = coefficients(factor, z=z)
    found = sp.roots(sp.Poly(values, z))
    return sorted(found, key=sp.default_sort_key)


@dataclass(frozen=True)
class PolePlacement:
    """A solved polynomial equation. All polynomials are expressions in z^-1 and start with 1 where they can.

    A, B: plant. fixed: S. P: wanted polynomial. common: the factor of A' and B that was cancelled (1 for none).
    degrees: with their explanation. unknowns: c_1, ..., d_0, ...; matrix, right_side: the Sylvester system
    matrix * unknowns = right_side. determinant: of the matrix; where it vanishes, A' and B have a common factor.
    solution: unknown -> value, in the order of `unknowns`.
    """

    A: sp.Expr
    B: sp.Expr
    fixed: sp.Expr
    P: sp.Expr
    common: sp.Expr
    degrees: Degrees
    unknowns: tuple[sp.Symbol, ...]
    matrix: sp.Matrix
    right_side: sp.Matrix
    determinant: sp.Expr
    solution: dict[sp.Symbol, sp.Expr]
    z: sp.Symbol = Z

    @cached_property
    def C_prime_form(self) -> sp.Expr:
        """C' = 1 + c_1 z^-1 + ... with the unknowns as symbols."""
        return polynomial([1, *self.unknowns[: self.degrees.c]], self.z)

    @cached_property
    def D_form(self) -> sp.Expr:
        """D = d_0 + d_1 z^-1 + ... with the unknowns as symbols."""
        return polynomial(self.unknowns[self.degrees.c :], self.z)

    @cached_property
    def C_form(self) -> sp.Expr:
        """C = S C' with the unknowns as symbols, by powers of z^-1."""
        return polynomial([sp.expand(c) for c in coefficients(self.fixed * self.C_prime_form, "C", self.z)], self.z)

    @cached_property
    def law(self) -> sp.Eq:
        """A S C' + B D = P multiplied out, with the unknowns as symbols, by powers of z^-1."""
        left = self.A * self.fixed * self.C_prime_form + self.B * self.D_form
        sides = ([sp.expand(c) for c in coefficients(side, z=self.z)] for side in (left, self.P))
        return sp.Eq(*(polynomial(side, self.z) for side in sides), evaluate=False)

    @cached_property
    def equations(self) -> list[sp.Eq]:
        """The system, a row for each of z^-1, z^-2, ..., as the coefficients of `law` are compared.

        >>> a, b, q = sp.symbols("a b q")
        >>> place_exactly(1 + a / Z, b / Z, 1 - q / Z, fixed=integrators(1)).equations
        [Eq(a + b*d_0 - 1, -q), Eq(-a + b*d_1, 0)]
        """
        left, right = (
            [sp.expand(c) for c in coefficients(side, z=self.z)] for side in (self.law.lhs, sp.expand(self.law.rhs))
        )
        right += [sp.S.Zero] * (len(left) - len(right))
        return [sp.Eq(x, y, evaluate=False) for x, y in zip(left[1:], right[1:], strict=True)]

    @cached_property
    def C_prime(self) -> sp.Expr:
        """C' in the symbols of the problem."""
        return self.C_prime_form.xreplace(self.solution)

    @cached_property
    def C(self) -> sp.Expr:
        """C = S C', the denominator of the regulator, in the symbols of the problem."""
        return self.C_form.xreplace(self.solution)

    @cached_property
    def D(self) -> sp.Expr:
        """The feedback polynomial in the symbols of the problem."""
        return self.D_form.xreplace(self.solution)

    @cached_property
    def Kr(self) -> sp.Expr:
        """P(1)/B(1): the closed loop from r to y has static gain 1. Raises NoStaticGain where there is none."""
        B_at_1, P_at_1 = (sp.cancel(p.subs(self.z, 1)) for p in (self.B, self.P))
        if B_at_1 == 0 or P_at_1 == 0:
            raise NoStaticGain(B_at_1, P_at_1)
        return sp.factor(P_at_1) / B_at_1

    @cached_property
    def closed_loop(self) -> sp.Expr:
        """A C + B D multiplied out and reduced; `place` has checked that it is P."""
        forms = [coefficients(p, z=self.z) for p in (self.A, self.B, self.C_form, self.D_form)]
        solved = [[c.xreplace(self.solution) for c in form] for form in forms]
        field, _ = construct_domain([c for form in solved for c in form], field=True)
        a, b, c, d = ([field.from_sympy(c) for c in form] for form in solved)
        total = [x + y for x, y in zip_longest(_product(a, c), _product(b, d), fillvalue=field.zero)]
        return polynomial([field.to_sympy(c) for c in total], self.z)

    @cached_property
    def parameters(self) -> dict[str, sp.Expr]:
        """Kr and the unknowns by name, as the document tabulates them."""
        return {"K_r": self.Kr, **{s.name: value for s, value in self.solution.items()}}

    def plant_equation(self) -> sp.Eq:
        """y(k) from earlier y and u."""
        return difference_equation(("y", self.A), {"u": self.B}, z=self.z)

    def regulator_equation(self) -> sp.Eq:
        """u(k) from r(k), y(k) and earlier u and y, in the symbols K_r, c_i, d_i."""
        gain = sp.Symbol("K_r")
        return difference_equation(("u", self.C_form), {"r": gain, "y": -self.D_form}, z=self.z)


def integrators(count: int, z: sp.Symbol = Z) -> sp.Expr:
    """(1 - z^-1)^count, the fixed factor of a regulator with that many integrators."""
    return (1 - z**-1) ** count


def place_exactly(A: sp.Expr, B: sp.Expr, P: sp.Expr, fixed: sp.Expr = sp.S.One, z: sp.Symbol = Z) -> PolePlacement:
    """The regulator of least order with A S C' + B D = P.

    A, B: plant y = (B/A) u, polynomials in z^-1 with symbolic or exact rational coefficients; A(0) not 0, B with at
    least one delay (any dead time is a power of z^-1 in B). P: wanted characteristic polynomial, P(0) not 0. fixed: S,
    factors of the regulator's denominator, `integrators(1)` for one integrator. A and S are scaled to start with 1 (B
    with A), P too.

    Solvable exactly where gcd(A S, B) divides P. A common factor that does is cancelled first and reported as
    `common`. Symbols stand for generic values: the solution holds where `determinant` is not zero.
    Raises CommonFactor, NoDelay, PolePlacementError, and DelayPolynomialError for inexact numbers.

    >>> a, b, q = sp.symbols("a b q")
    >>> design = place_exactly(1 + a / Z, b / Z, 1 - q / Z, fixed=integrators(1))
    >>> design.solution
    {d_0: (-a - q + 1)/b, d_1: a/b}
    >>> design.closed_loop
    -q/z + 1
    """
    A, S, B, P = (sp.sympify(p, strict=True) for p in (A, fixed, B, P))
    a, s, b, p = (coefficients(e, n, z) for e, n in ((A, "A"), (S, "S"), (B, "B"), (P, "P")))
    for values, name, expression in ((a, "A", A), (s, "S", S), (p, "P", P)):
        if not values or sp.cancel(values[0]) == 0:
            raise PolePlacementError(
                f"{name} = {expression} must have a term without delay (a root at z = infinity is no pole)"
            )
    if not b or sp.cancel(b[0]) != 0:
        raise NoDelay(B)
    a, b, s, p = _scaled(a, a[0]), _scaled(b, a[0]), _scaled(s, s[0]), _scaled(p, p[0])
    w = sp.Dummy("w")
    A_prime, B_w, P_w = (
        sp.Poly(list(reversed(v)), w, field=True) for v in ([sp.expand(c) for c in _product(a, s)], b, p)
    )
    common = sp.gcd(A_prime, B_w)
    common = common.mul_ground(1 / common.eval(0))
    if not P_w.rem(common).is_zero:
        raise CommonFactor(_from_poly(common, z), polynomial(p, z), z)
    a_short, b_short, p_short = (_coefficients_of(poly.quo(common)) for poly in (A_prime, B_w, P_w))
    n = Degrees(len(a) - 1, len(s) - 1, len(b) - 1, len(p) - 1, common.degree())
    unknowns, matrix, right = _sylvester(a_short, b_short, p_short, n)
    determinant, values = solve_system(matrix, right)
    A, B, S, P = (polynomial(v, z) for v in (a, b, s, p))
    solution = dict(zip(unknowns, values, strict=True))
    design = PolePlacement(A, B, S, P, _from_poly(common, z), n, unknowns, matrix, right, determinant, solution, z)
    if rest := [c for c in coefficients(design.closed_loop - design.P, z=z) if sp.cancel(c) != 0]:
        raise AssertionError(f"the solution does not satisfy A C + B D = P: left over {rest}")
    return design


def _scaled(values: list[sp.Expr], by: sp.Expr) -> list[sp.Expr]:
    return values if by == 1 else [sp.cancel(v / by) for v in values]


def _product(p: list, q: list) -> list:
    """Coefficients of the product of two polynomials, over any ring."""
    out: list = [0] * max(len(p) + len(q) - 1, 0)
    for (i, x), (j, y) in product(enumerate(p), enumerate(q)):
        out[i + j] = out[i + j] + x * y
    return out


def _coefficients_of(poly: sp.Poly) -> list[sp.Expr]:
    return list(reversed(poly.all_coeffs()))


def _from_poly(poly: sp.Poly, z: sp.Symbol) -> sp.Expr:
    return polynomial(_coefficients_of(poly), z)


def _sylvester(a: list, b: list, p: list, n: Degrees) -> tuple[tuple[sp.Symbol, ...], sp.Matrix, sp.Matrix]:
    """Row i: the coefficient of z^-i of A'C' + BD = P. Column of c_j: A' shifted j down; of d_j: B shifted j down."""
    at: Callable = lambda values, i: values[i] if 0 <= i < len(values) else sp.S.Zero  # noqa: E731
    c = [sp.Symbol(f"c_{j}") for j in range(1, n.c + 1)]
    d = [sp.Symbol(f"d_{j}") for j in range(n.d + 1)]
    rows = range(1, n.unknowns + 1)
    shifts = [(a, j) for j in range(1, n.c + 1)] + [(b, j) for j in range(n.d + 1)]
    matrix = sp.Matrix(n.unknowns, len(shifts), lambda i, j: at(shifts[j][0], rows[i] - shifts[j][1]))
    right = sp.Matrix([at(p, i) - at(a, i) for i in rows])
    return (*c, *d), matrix, right


def solve_system(matrix: sp.Matrix, right: sp.Matrix) -> tuple[sp.Expr, list[sp.Expr]]:
    """(determinant, solution) of a square system over the field of rational functions of its symbols.

    matrix: (n, n), right: (n, 1), symbols and exact numbers. Fraction-free elimination in the polynomial ring of the
    symbols, then one division for each unknown, so that every value is one fraction in lowest terms.
    Raises PolePlacementError where numbers hide that the determinant is zero.
    """
    if matrix.rows == 0:
        return sp.S.One, []
    M, rhs = DomainMatrix.from_Matrix(matrix).unify(DomainMatrix.from_Matrix(right))
    ring = M.domain
    numerators, denominator = M.solve_den(rhs)
    field = ring.get_field()
    bottom = field.convert_from(denominator, ring)
    values = [field.to_sympy(field.convert_from(v, ring) / bottom) for v in numerators.to_list_flat()]
    determinant = sp.factor(ring.to_sympy(M.det()))
    if determinant.is_number and determinant.equals(0):
        raise PolePlacementError(
            "the coefficients are numbers that depend on each other, such as exp(-1/5), exp(-1/7) and exp(-12/35), "
            "in a way that gives A' and B a common factor; with symbols or rational numbers that factor would be named"
        )
    return determinant, values
