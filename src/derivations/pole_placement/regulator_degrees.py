"""How long a pole-placement regulator must be, and why: the degrees in z^-1 that make A S C' + B D = P solvable.

S holds the factors that the regulator must have (integrators); A' = A S. All degrees are degrees in z^-1, so a dead
time counts in the degree of B.
"""

from dataclasses import dataclass

import sympy as sp

from derivations.algebra.delay_polynomials import Z, coefficients


@dataclass(frozen=True)
class Degrees:
    """Degrees of the equation A S C' + B D = P and of its solution of least order.

    a, fixed, b, p: degrees of A, S, B, P. common: degree of the factor of A' and B that is cancelled (it divides P).

    >>> n = Degrees(a=2, fixed=1, b=4, p=3)
    >>> n.c, n.d, n.unknowns, n.largest_p
    (3, 2, 6, 6)
    """

    a: int
    fixed: int
    b: int
    p: int
    common: int = 0

    @property
    def a_prime(self) -> int:
        """Degree of A' = A S."""
        return self.a + self.fixed

    @property
    def d(self) -> int:
        """Degree of D: n_a' - 1, less what is cancelled; -1 where D = 0 suffices."""
        return self.a_prime - self.common - 1

    @property
    def c(self) -> int:
        """Degree of C': n_b - 1, less what is cancelled, or more where P is long."""
        return max(self.b - self.common - 1, self.p - self.a_prime)

    @property
    def unknowns(self) -> int:
        """Number of unknown coefficients and of equations: C' starts with 1, D with d0."""
        return self.c + self.d + 1

    @property
    def largest_p(self) -> int:
        """Highest degree of P, that is the number of poles outside the origin, that needs no longer C'."""
        return self.a_prime + self.b - self.common - 1

    def why(self) -> list[str]:
        """The argument, one step a sentence, as text with LaTeX mathematics between dollar signs."""
        a_prime, b, p = (n - self.common for n in (self.a_prime, self.b, self.p))
        most = rf"n_{{a'}} + n_b - 1 = {a_prime + b - 1}"
        moved = rf"n_{{a'}} = {self.a} + {self.fixed} = {self.a_prime}"
        steps = [rf"The factors that the regulator must have move to the plant: ${moved}$."]
        if self.common:
            steps.append(
                rf"$A'$ and $B$ share a factor of degree ${self.common}$ that divides $P$. The equation is divided by "
                rf"it, which leaves $n_{{a'}} = {a_prime}$, $n_b = {b}$, $n_p = {p}$."
            )
        steps.append(
            r"If $(C', D)$ solves the equation, so does $(C' + B T, D - A' T)$ for every polynomial $T$. Dividing $D$ "
            r"by $A'$ leaves a remainder of degree at most $n_{a'} - 1$. "
            rf"So $n_d = {self.d}$ suffices, and this $D$ is unique."
        )
        longer = (
            f"at most ${most}$, so it sets no degree" if p <= a_prime + b - 1 else f"more than ${most}$: $C'$ is longer"
        )
        steps.append(
            rf"Then $A' C' = P - B D$ has the degree $\max(n_p, n_b + n_d)$. That of $P$ is ${p}$, {longer}. Hence "
            rf"$n_{{c'}} = \max(n_b - 1, n_p - n_{{a'}}) = {self.c}$."
        )
        steps.append(
            rf"The coefficients of $z^{{-1}}, \dots, z^{{-{self.unknowns}}}$ give $n_{{c'}} + n_{{a'}} = "
            rf"{self.unknowns}$ equations for $n_{{c'}} + n_d + 1 = {self.unknowns}$ unknowns: a square system. "
            "That of $z^0$ reads $1 = 1$."
        )
        steps.append(
            rf"${self.largest_p}$ poles can be placed without a longer regulator. $P$ places ${self.p}$ outside the "
            "origin; the others stay at $z = 0$, where a mode dies in one sample."
            if self.p <= self.largest_p
            else rf"$P$ places ${self.p}$ poles outside the origin; ${self.largest_p}$ would need no longer regulator."
        )
        return steps


def degrees(A: sp.Expr, B: sp.Expr, P: sp.Expr, fixed: sp.Expr = sp.S.One, z: sp.Symbol = Z) -> Degrees:
    """The degrees of the regulator of least order for coprime A S and B; all four are expressions in z^-1.

    Raises DelayPolynomialError where one of them is not a polynomial in z^-1.

    >>> from sympy.abc import a, b, q
    >>> degrees(1 + a / Z, b / Z**3, 1 - q / Z, fixed=1 - 1 / Z)
    Degrees(a=1, fixed=1, b=3, p=1, common=0)
    """
    return Degrees(*(len(coefficients(p, name, z)) - 1 for p, name in ((A, "A"), (fixed, "S"), (B, "B"), (P, "P"))))
