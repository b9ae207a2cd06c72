"""State feedback, observer and the regulator that both make: poles of A - B K and of A - L C where they are wanted.

    x' = A x + B u,  y = C x        u = -K x^ + k_r r,    x^' = A x^ + B u + L (y - C x^)

One input is solved by Ackermann's formula, K = (0 ... 0 1) [B AB ...]^-1 p(A), for poles of any multiplicity: exactly
in fractions and letters; of floats in the Hessenberg form of (A, B), where the inverse is a product of subdiagonals.
Several inputs are solved robustly in double precision (Tits and Yang 1996, by SciPy), where a pole may be repeated as
often as there are inputs.
"""

from collections.abc import Sequence
from fractions import Fraction
from math import isfinite
from typing import Any

import numpy as np

from loopbook.controllers.regulator import Regulator
from loopbook.controllers.rst import PlacementError, Rst
from loopbook.numerics.real_numbers import complex_number, plain_number
from loopbook.process.state_space_in import ss
from loopbook.process.transfer_function import Process

UNREACHED = 1e-13


def state_feedback(A: Any, B: Any, poles: Sequence[Any]) -> Any:
    """K with the eigenvalues of A - B K at `poles`, complex ones in pairs.

    A (n, n), B (n, m) or n numbers; n poles. Floats give an array of floats, shape (m, n); exact numbers and letters
    (one input) a tuple of exact ones. Raises PlacementError where the pair (A, B) is not controllable, for another
    number of poles, and for several inputs where a pole is repeated more often than there are inputs.

    >>> state_feedback([[0, 1], [3, 2]], [0, 1], [-1, Fraction(-1, 2)])
    (Fraction(7, 2), Fraction(7, 2))
    >>> state_feedback([[0.0, 1.0], [3.0, 2.0]], [0.0, 1.0], [-1, -0.5]).tolist()
    [[3.5, 3.5]]
    """
    a, b = np.atleast_2d(np.asarray(A, dtype=object)), np.asarray(B, dtype=object)
    b = b.reshape(-1, 1) if b.ndim < 2 else b
    n = len(a)
    if a.shape != (n, n) or len(b) != n:
        raise PlacementError(f"A {a.shape} and B {b.shape}: a square A and a row of B for each state are expected")
    wanted = [_pole(p) for p in np.atleast_1d(np.asarray(poles, dtype=object))]
    if len(wanted) != n:
        raise PlacementError(f"{len(wanted)} poles for {n} states: as many of both are needed")
    if b.shape[1] > 1:
        return _robust(a, b, wanted)
    entries = [*a.flat, *b.flat, *wanted]
    if any(hasattr(x, "is_number") for x in entries):
        return _in_letters(a, b, wanted)
    if any(isinstance(x, float | complex | np.inexact) for x in entries):
        return _hessenberg(_floats(a), _floats(b), wanted)
    of_A, of_B = ([[_fraction(x) for x in row] for row in m] for m in (a, b))
    return tuple(_ackermann(of_A, of_B, _characteristic(wanted)))


def observer(A: Any, C: Any, poles: Sequence[Any]) -> Any:
    """L with the eigenvalues of A - L C at `poles`; arguments as for `state_feedback`. Floats give shape (n, p).

    Raises PlacementError where (A, C) is not observable.

    >>> observer([[0, 1], [0, 0]], [1, 0], [-3, -3])
    (Fraction(6, 1), Fraction(9, 1))
    """
    a, c = np.atleast_2d(np.asarray(A, dtype=object)), np.atleast_2d(np.asarray(C, dtype=object))
    try:
        found = state_feedback(a.T, c.T, poles)
    except PlacementError as error:
        raise PlacementError(str(error).replace("controllable", "observable").replace("(A, B)", "(A, C)")) from None
    return found.T if isinstance(found, np.ndarray) else found


def state_regulator(
    A: Any,
    B: Any = None,
    C: Any = None,
    *,
    poles: Sequence[Any],
    observer_poles: Sequence[Any],
    integral: bool = False,
    h: float | None = None,
) -> Regulator | Rst:
    """State feedback from an observer as R u = T r - S y; the loop has `poles` and `observer_poles`, static gain one.

    A, B, C: of x' = A x + B u, y = C x with one input and one output; or a `Process` without dead time alone. poles: n,
    one more with `integral`, which adds the state of the integral of r - y. observer_poles: n. h [s]: of a sampled
    system x(k+1) = A x + B u, whose poles lie in the unit circle; the answer is then an `Rst`, else a `Regulator`.
    Raises PlacementError where the pair is not controllable or observable, or constant inputs are blocked.

    >>> found = state_regulator([[0, 1], [0, 0]], [0, 1], [1, 0], poles=[-1, -1], observer_poles=[-3, -3])
    >>> found.R, found.S, found.T
    ((1.0, 8.0, 22.0), (24.0, 9.0), (1.0, 6.0, 9.0))
    """
    a, b, c = _of_process(A) if isinstance(A, Process) else (np.asarray(m, dtype=float) for m in (A, B, C))
    a, b, c = np.atleast_2d(a), b.reshape(-1, 1), c.reshape(1, -1)
    n, one = len(a), 1.0 if h is None else 0.0
    L = observer(a, c, observer_poles)
    if integral:
        below = np.zeros((1, 1)) if h is None else np.ones((1, 1))
        wide = np.block([[a, np.zeros((n, 1))], [-c, below]])
        K = np.asarray(state_feedback(wide, np.vstack([b, [[0.0]]]), poles), dtype=float)
    else:
        K = np.asarray(state_feedback(a, b, poles), dtype=float)
    inner = a - b @ K[:, :n] - np.asarray(L, dtype=float) @ c
    if integral:  # states (x^, integral); u = -K x^ - k_i (integral)
        inner = np.block([[inner, -b * K[0, n]], [np.zeros((1, n)), below]])
        of_r, of_y, direct = np.append(np.zeros(n), 1.0), np.append(np.ravel(L), -1.0), 0.0
    else:
        gain = float((c @ np.linalg.solve((1 - one) * np.eye(n) - a + b @ K, b)).item())
        if not abs(gain) > 1e-14 * float(np.abs(c).sum() * np.abs(b).sum()):
            raise PlacementError("the process blocks constant inputs: no k_r gives the loop static gain one")
        direct, of_r, of_y = 1 / gain, np.ravel(b) / gain, np.ravel(L)
    back, forth = ss(inner, of_y, K[0]), ss(inner, of_r, -K[0], direct)
    R, S, T = back.den, back.num, forth.num
    if h is None:
        return Regulator(tuple(T), tuple(S), tuple(R))
    rows = [(0.0,) * (len(R) - len(row)) + tuple(row) for row in (R, S, T)]
    return Rst(rows[0], rows[1], rows[2], h)


def _of_process(process: Process) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The controllable form of a strictly proper process."""
    if process.delay or not process.relative_degree:
        raise PlacementError("a strictly proper process without dead time is expected: sample it, or give A, B, C")
    n, a = process.order, np.asarray(process.den) / process.den[0]
    c = np.asarray(process.num) / process.den[0]
    A = np.eye(n, k=-1)
    A[0] = -a[1:]
    return A, np.eye(n)[:, 0], np.pad(c, (n - len(c), 0))


def _pole(value: Any) -> Any:
    """As it is where SymPy made it or it is real; a complex number as Python's."""
    if hasattr(value, "is_number"):
        return value
    number = complex_number(value, "pole", PlacementError)
    return number if number.imag or isinstance(value, complex | np.complexfloating) else value


def _fraction(value: Any) -> Fraction:
    try:
        return Fraction(plain_number(value))
    except (TypeError, ValueError, OverflowError):
        raise PlacementError(f"{value!r} is no finite real number: A, B and C hold such") from None


def _floats(matrix: np.ndarray) -> np.ndarray:
    return np.array([x if type(x) is float and isfinite(x) else float(_fraction(x)) for x in matrix.flat]).reshape(
        matrix.shape
    )


def _characteristic(poles: list[Any]) -> list[Fraction]:
    """The descending coefficients of prod(s - p) for real poles."""
    row = [Fraction(1)]
    for p in poles:
        value = _fraction(p)
        row = [x - value * y for x, y in zip([*row, Fraction(0)], [Fraction(0), *row], strict=True)]
    return row


def _hessenberg(A: np.ndarray, B: np.ndarray, poles: list[Any]) -> np.ndarray:
    """In coordinates in which B is beta e_1 and A upper Hessenberg: K = e_n' p(A) over beta and the subdiagonals."""
    from scipy.linalg import hessenberg

    n = len(A)
    mirror = B[:, 0].copy()
    length = float(np.linalg.norm(mirror))
    mirror[0] += np.copysign(length, mirror[0])
    first = np.eye(n) - 2 * np.outer(mirror, mirror) / (mirror @ mirror) if length else np.eye(n)
    H, Q = hessenberg(first @ A @ first, calc_q=True, check_finite=False)
    beta = float((first @ B[:, 0])[0])
    below = np.append(beta, np.diag(H, -1))
    size = max(float(np.abs(A).max(initial=0.0)), 0.0)
    if abs(beta) == 0 or (np.abs(below[1:]) <= UNREACHED * size).any():
        raise PlacementError("the pair (A, B) is not controllable: some mode cannot be moved")
    row = np.eye(n)[-1]
    for factor in _real_factors(poles):
        after = row @ H
        row = after + factor[1] * row if len(factor) == 2 else after @ H + factor[1] * after + factor[2] * row
    return np.asarray((row / np.prod(below) @ Q.T @ first)[None, :])


def _real_factors(poles: list[Any]) -> list[tuple[float, ...]]:
    """s - p for each real pole, s^2 - 2 Re p s + |p|^2 for each pair."""
    found: list[tuple[float, ...]] = []
    left = [complex(p) for p in poles]
    while left:
        p = left.pop()
        if p.imag:
            pair = min(left, key=lambda q: abs(q - p.conjugate()), default=None)
            if pair is None or abs(pair - p.conjugate()) > 1e-12 * abs(p):
                raise PlacementError(f"the pole {p} lacks its conjugate: the feedback would not be real")
            left.remove(pair)
            found.append((1.0, -2 * p.real, abs(p) ** 2))
        else:
            found.append((1.0, -p.real))
    return found


def _ackermann(A: list[list[Fraction]], B: list[list[Fraction]], p: list[Fraction]) -> list[Fraction]:
    """The last row of [B AB ...]^-1 times p(A)."""
    n = len(A)
    columns = [[row[0] for row in B]]
    for _ in range(n - 1):
        columns.append([sum((x * y for x, y in zip(row, columns[-1], strict=True)), Fraction(0)) for row in A])
    # q [B AB ... A^(n-1)B] = (0 ... 0 1)
    q = _solved([[*column, Fraction(int(i == n - 1))] for i, column in enumerate(columns)])
    total, power = [Fraction(0)] * n, q
    for coefficient in reversed(p):
        total = [t + coefficient * x for t, x in zip(total, power, strict=True)]
        power = [sum((power[i] * A[i][j] for i in range(n)), Fraction(0)) for j in range(n)]
    return total


def _solved(rows: list[list[Fraction]]) -> list[Fraction]:
    """The solution of square equations, the right side last in each row."""
    n = len(rows)
    for k in range(n):
        pivot = next((i for i in range(k, n) if rows[i][k]), None)
        if pivot is None:
            raise PlacementError("the pair (A, B) is not controllable: some mode cannot be moved")
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            if rows[i][k]:
                factor = rows[i][k] / rows[k][k]
                rows[i] = [x - factor * y for x, y in zip(rows[i], rows[k], strict=True)]
    found = [Fraction(0)] * n
    for k in range(n - 1, -1, -1):
        rest = sum((rows[k][j] * found[j] for j in range(k + 1, n)), Fraction(0))
        found[k] = (rows[k][n] - rest) / rows[k][k]
    return found


def _in_letters(A: np.ndarray, B: np.ndarray, poles: list[Any]) -> tuple[Any, ...]:
    import sympy

    a, b = (sympy.Matrix([[_symbolic(x) for x in row] for row in m]) for m in (A, B))
    n, s = a.rows, sympy.Dummy("s")
    reach = sympy.Matrix.hstack(*(a**k * b for k in range(n)))
    if sympy.simplify(reach.det()) == 0:
        raise PlacementError("the pair (A, B) is not controllable: some mode cannot be moved")
    wanted = sympy.Poly(sympy.expand(sympy.Mul(*(s - _symbolic(p) for p in poles))), s)
    last = sympy.zeros(1, n)
    last[n - 1] = 1
    value = sympy.zeros(n)
    for (power,), coefficient in wanted.terms():
        value += coefficient * a**power
    return tuple(sympy.factor(x) for x in last * reach.inv() * value)


def _symbolic(value: Any) -> Any:
    import sympy

    if isinstance(value, sympy.Basic):
        return value
    exact = Fraction(plain_number(value))
    return sympy.Rational(exact.numerator, exact.denominator)


def _robust(A: np.ndarray, B: np.ndarray, poles: list[Any]) -> np.ndarray:
    from scipy.signal import place_poles

    try:
        found = place_poles(np.asarray(A, dtype=float), np.asarray(B, dtype=float), np.asarray(poles, dtype=complex))
    except ValueError as error:
        raise PlacementError(f"these poles cannot be placed: {error}") from None
    return np.asarray(found.gain_matrix)
