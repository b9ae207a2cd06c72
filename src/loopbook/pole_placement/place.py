"""Pole placement for a sampled process, in numbers and in symbols."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from derivations.algebra.delay_polynomials import Z, polynomial
from derivations.pole_placement import diophantine
from loopbook.controllers.rst import PlacementError, with_zeros
from loopbook.pole_placement.numeric import Placement
from loopbook.pole_placement.numeric import place_numerically as place_in_numbers
from loopbook.process.sampled import SampledProcess


def place(
    process: SampledProcess, poles: Any, *, observer: Sequence[complex] = (), integrators: int = 1,
    symbols: bool = False,
) -> Any:  # fmt: skip
    """The RST regulator of least order that gives a sampled process the wanted poles, R u = T r - S y.

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
    if not (isinstance(integrators, int | np.integer) and integrators >= 0):
        raise PlacementError(f"integrators = {integrators!r}: a whole number, 0 or more, is expected")
    wanted = (
        list(poles) if isinstance(poles, Sequence | np.ndarray) else [poles] * (process.process.order + integrators)
    )
    if symbols:
        return _in_letters(process, [*wanted, *observer], integrators)
    outside = [pole for pole in [*wanted, *observer] if not abs(complex(pole)) < 1]
    if outside:
        raise PlacementError(f"the poles {outside} do not lie inside the unit circle: the loop would not be stable")
    B, A = process.polynomials
    found: Placement = place_in_numbers(
        B, A, with_zeros(wanted), process.h, observer=with_zeros(observer), integrators=integrators
    )
    return found


def _in_letters(process: SampledProcess, poles: list[Any], integrators: int) -> Any:
    import sympy

    B, A = process.polynomials
    a = [sympy.Symbol(f"a_{i}") if value else 0 for i, value in enumerate(A)][1:]
    b = [sympy.Symbol(f"b_{i}") if value else 0 for i, value in enumerate(B)]
    P = sympy.Mul(*(1 - sympy.nsimplify(pole, rational=True) / Z for pole in poles))
    return diophantine.place_exactly(polynomial([1, *a]), polynomial(b), P, diophantine.integrators(integrators))
