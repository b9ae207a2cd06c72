"""Solving the six symbolic equations of the double tank beside inverting their matrix.

The system has five symbols. `Matrix.inv()` gives nested fractions; only after `cancel` are they the polynomials over
one determinant that `place` returns, and the check that both are the same is part of the bench. SymPy's cache is
emptied before every run.
"""

import time
from collections.abc import Callable
from statistics import median

import sympy as sp
from sympy.core.cache import clear_cache

from derivations.algebra.delay_polynomials import Z
from derivations.pole_placement.diophantine import integrators, place_exactly, solve_system


def _median(work: Callable, times: int) -> tuple[float, object]:
    seconds, outcome = [], None
    for _ in range(times):
        clear_cache()
        start = time.perf_counter()
        outcome = work()
        seconds.append(time.perf_counter() - start)
    return median(seconds), outcome


def rows(times: int = 9) -> list[tuple[str, float, str]]:
    """(what, seconds, remark); medians of `times` runs, of a third as many for the slow ones."""
    a1, a2, b3, b4, q = sp.symbols("a_1 a_2 b_3 b_4 q")
    plant = 1 + a1 / Z + a2 / Z**2, b3 / Z**3 + b4 / Z**4
    whole, design = _median(lambda: place_exactly(*plant, (1 - q / Z) ** 3, integrators(1)), times)
    matrix, right = design.matrix, design.right_side
    ours, (_, solved) = _median(lambda: solve_system(matrix, right), times)
    raw, inverse = _median(lambda: matrix.inv() * right, max(times // 3, 1))
    same, cancelled = _median(lambda: (matrix.inv() * right).applyfunc(sp.cancel), max(times // 3, 1))
    equal = all(sp.cancel(x - y) == 0 for x, y in zip(cancelled, solved, strict=True))
    operations = [sum(sp.count_ops(x) for x in values) for values in (solved, inverse)]
    return [
        ("solve_system, 6 equations", ours, f"lowest terms, {operations[0]} operations"),
        ("place, with degrees, common factor and check", whole, "the closed loop multiplied out and compared with P"),
        ("Matrix.inv() * right side", raw, f"{raw / ours:.1f} times as long; nested, {operations[1]} operations"),
        ("the same, then cancel", same, f"{same / ours:.1f} times as long; equal to ours: {'yes' if equal else 'NO'}"),
    ]
