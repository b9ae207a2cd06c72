"""Numbers and polynomials as LaTeX, four or five digits, no term that is zero and no factor that is one."""

from collections.abc import Sequence

import numpy as np


def number(value: float, digits: int = 5) -> str:
    """A number in LaTeX.

    >>> number(0.25), number(-1.2e-7)
    ('0.25', '-1.2 \\\\cdot 10^{-7}')
    """
    text, e, power = f"{float(value):.{digits}g}".partition("e")
    return rf"{text} \cdot 10^{{{int(power)}}}" if e else text


def polynomial(coefficients: Sequence[float], variable: str, powers: Sequence[int]) -> str:
    """sum of coefficients times variable^power, as given.

    >>> polynomial([40, 14, 1], "s", [2, 1, 0])
    '40 s^{2} + 14 s + 1'
    """
    text = ""
    for value, power in zip(coefficients, powers, strict=True):
        if value == 0:
            continue
        factor = "" if power == 0 else variable if power == 1 else f"{variable}^{{{power}}}"
        size = number(abs(value))
        term = size if not factor else factor if size == "1" else f"{size} {factor}"
        sign = "-" if value < 0 else ""
        text += f" {sign or '+'} {term}" if text else sign + term
    return text or "0"


def descending(row: Sequence[float], variable: str = "s") -> str:
    """A row of descending coefficients."""
    return polynomial(row, variable, range(len(row) - 1, -1, -1))


def in_delays(row: Sequence[float]) -> str:
    """A row of the coefficients of z^0, z^-1, ...

    >>> in_delays([1, -0.5])
    '1 - 0.5 z^{-1}'
    """
    return polynomial(row, "z", [-i for i in range(len(row))])


def lags(row: Sequence[float]) -> str:
    """The same as `descending`, as factors s and (T s + 1) where four digits of each T tell the row exactly.

    >>> lags([40, 14, 1, 0])
    's (10 s + 1) (4 s + 1)'
    """
    values = np.asarray(row, dtype=float)
    rest = np.trim_zeros(values, "b")
    integrators = len(values) - len(rest)
    times = [float(f"{t:.4g}") for t in sorted(-1 / np.roots(rest).real, reverse=True)]
    product = np.array([1.0])
    for t in times:
        product = np.polymul(product, [t, 1.0])
    told = len(times) > 1 and min(times) > 0 and np.allclose(product, rest, rtol=1e-9, atol=0)
    if not told:
        return descending(row)
    power = ["s" if integrators == 1 else f"s^{{{integrators}}}"] if integrators else []
    return " ".join([*power, *(f"({descending([t, 1.0])})" for t in times)])
