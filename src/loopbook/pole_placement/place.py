"""Pole placement for a sampled process, a plant in z or a continuous process, in numbers and in symbols."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from derivations.algebra.delay_polynomials import Z, polynomial
from derivations.pole_placement import diophantine
from loopbook.controllers.rst import PlacementError, with_zeros
from loopbook.numerics.real_numbers import complex_number, whole
from loopbook.pole_placement.continuous import listed, place_continuous
from loopbook.pole_placement.numeric import Placement
from loopbook.pole_placement.numeric import place_numerically as place_in_numbers
from loopbook.process.transfer_function import Process


def place(
    process: Any, poles: Any, *, observer: Sequence[complex] = (), integrators: int = 1, symbols: bool = False
) -> Any:
    """The RST regulator of least order that gives a process the wanted poles, R u = T r - S y.

    process: a `SampledProcess` or `DiscreteProcess`; of a continuous `Process` without dead time the poles are those in
    s and the answer is a continuous regulator: see `loopbook.pole_placement.continuous`.
    poles: the z of the closed loop, or one number for as many as process and integrators have; inside the unit circle,
    complex ones in pairs. observer: further poles, which the reference does not excite. integrators: how many the
    regulator has. Returns a `Placement` with its `Rst`; symbols=True returns the solution in the plant's letters a_i,
    b_i instead (`derivations.pole_placement.diophantine.PolePlacement`), where the poles may be SymPy expressions.
    Raises PlacementError where the equation has no solution, with the factor, and for poles outside the unit circle.

    >>> from loopbook.process.sampled import sample
    >>> from loopbook.process.transfer_function import Process
    >>> place(sample(Process([1], [5, 1]), 1.0), 0.5).regulator.is_stable
    True
    """
    integrators = whole(integrators, "integrators", PlacementError)
    if isinstance(process, Process):
        return place_continuous(process, poles, observer=observer, integrators=integrators)
    B, A = np.asarray(process.num), np.asarray(process.den)
    wanted = listed(poles, len(A) - 1 + integrators)
    if symbols:
        return _in_letters(process, [*wanted, *listed(observer, 1)], integrators)
    wanted, hidden = ([complex_number(p, "pole", PlacementError) for p in row] for row in (wanted, listed(observer, 1)))
    outside = [pole for pole in [*wanted, *hidden] if not abs(pole) < 1]
    if outside:
        raise PlacementError(f"the poles {outside} do not lie inside the unit circle: the loop would not be stable")
    found: Placement = place_in_numbers(
        B, A, with_zeros(wanted), process.h, observer=with_zeros(hidden), integrators=integrators
    )
    return found


def _in_letters(process: Any, poles: list[Any], integrators: int) -> Any:
    import sympy

    B, A = process.num, process.den
    a = [sympy.Symbol(f"a_{i}") if value else 0 for i, value in enumerate(A)][1:]
    b = [sympy.Symbol(f"b_{i}") if value else 0 for i, value in enumerate(B)]
    P = sympy.Mul(*(1 - sympy.nsimplify(pole, rational=True) / Z for pole in poles))
    return diophantine.place_exactly(polynomial([1, *a]), polynomial(b), P, diophantine.integrators(integrators))
