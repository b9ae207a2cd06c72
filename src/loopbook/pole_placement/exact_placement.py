"""A sampled plant, a pole q and the regulator that puts the poles there: its numbers, its recursion, its loop.

Everything comes from one `derivations.pole_placement.diophantine.place_exactly`, with the plant's exact fractions: the
parameters that are tabulated, the difference equations that run, and the polynomials of the `Rst` whose margins are
asked for.
"""

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any

from derivations.algebra.delay_polynomials import Z, coefficients, difference_equation
from derivations.pole_placement.diophantine import integrators as fixed
from derivations.pole_placement.diophantine import place_exactly
from loopbook.controllers.rst import Rst, zeros_of
from loopbook.numerics.rational_numbers import decimal, function
from loopbook.numerics.recursion import recursion, run_recursion
from loopbook.pole_placement.sampled_plant import SampledPlant


@dataclass(frozen=True)
class PlacedLoop:
    """Make it with `place_poles`. plant: what the regulator was designed for. q: the pole. design: the solution.

    parameters: K_r, c_1, ..., d_0, ... as fractions; K_r and d_i in input per output, c_i without unit.
    """

    plant: SampledPlant
    q: Fraction
    design: Any
    parameters: dict[str, Fraction]

    @cached_property
    def rst(self) -> Any:
        """The regulator as a `loopbook.controllers.rst.Rst`: R = C, S = D, T = K_r."""
        R, S = (tuple(map(float, coefficients(p))) or (0.0,) for p in (self.design.C, self.design.D))
        return Rst(R, S, (float(self.parameters["K_r"]),), float(self.plant.h))

    @cached_property
    def regulator_radius(self) -> float:
        """The largest |z| of the regulator's own poles without its integrators; above 1 it is unstable by itself."""
        poles = zeros_of([float(c) for c in coefficients(self.design.C_prime)])
        return float(abs(poles).max(initial=0.0))

    def step(self, steps: int, plant: SampledPlant | None = None, exact: bool = False) -> dict[str, list]:
        """y, u and r for a unit step of the set point at the first of `steps` samples, from the difference equations.

        plant: the one that answers; default the one designed for. exact: fractions instead of floats.
        """
        answers = plant or self.plant
        number = Fraction if exact else float
        process = recursion(difference_equation(("y", answers.A), {"u": answers.B}), {}, number)
        regulator = recursion(self.design.regulator_equation(), self.parameters, number)
        return run_recursion([process, regulator], {"r": [number(1)] * steps}, steps)


def place_poles(plant: SampledPlant, q: Any, poles: int | None = None, integrators: int = 1) -> PlacedLoop:
    """The regulator that places poles at q and leaves the rest at the origin.

    q: 0 <= q < 1, as a decimal or a fraction. poles: how many; default as many as the plant with the integrators has.
    Raises ValueError for q outside [0, 1) and the errors of `derivations.pole_placement.diophantine.place_exactly`.

    >>> from loopbook.pole_placement.sampled_plant import sample_two_lags
    >>> loop = place_poles(sample_two_lags(5, 7, Fraction(1, 8360), 2, 1).rounded(), 0.5)
    >>> [f"{float(v):.5g}" for v in loop.parameters.values()]
    ['43298', '1.186', '1.5399', '0.80337', '7.0523e+05', '-1.0809e+06', '4.1892e+05']
    """
    from sympy import Rational

    exact = decimal(q)
    if not 0 <= exact < 1:
        raise ValueError(
            f"q = {q}: the pole must lie in [0, 1). Outside the unit circle the loop is unstable, q = 1 never "
            "settles, and a negative q makes the input alternate"
        )
    poles = len(plant.a) + integrators if poles is None else poles
    wanted = (1 - Rational(exact.numerator, exact.denominator) / Z) ** poles
    design = place_exactly(plant.A, plant.B, wanted, fixed(integrators))
    names, expressions = zip(*design.parameters.items(), strict=True)
    return PlacedLoop(plant, exact, design, dict(zip(names, function([], list(expressions))(), strict=True)))
