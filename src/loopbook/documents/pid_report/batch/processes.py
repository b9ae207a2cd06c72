"""The processes on which the AMIGO rules were fitted: nine families, 133 processes.

pid-report, section 5.3, speaks of 134 test processes and lists none of them. The families below are the published
transcription (Åström and Hägglund, Advanced PID control, 2006); they sum to 133.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np

from loopbook.process.transfer_function import Process

LAGS = (0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.3, 1.5, 2, 4, 6, 8, 10, 20, 50, 100, 200, 500, 1000)
DOUBLE_LAGS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.3, 1.5, 2, 4, 6, 8, 10, 20, 50, 100, 200, 500)
FAST_LAGS = (0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 2, 5, 10)
DEAD_TIMES = (0.01, 0.02, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 1)
TENTHS = tuple(round(0.1 * i, 1) for i in range(1, 12))


@dataclass(frozen=True)
class Member:
    """One process of the batch: family 1 to 9, the parameters that single it out, the process (times in s)."""

    family: int
    parameters: tuple[tuple[str, float], ...]
    process: Process

    @property
    def name(self) -> str:
        return f"family {self.family}: " + ", ".join(f"{name} = {value:g}" for name, value in self.parameters)

    @property
    def integrates(self) -> bool:
        return bool(np.isinf(self.process.static_gain))


FORMULAS = {
    1: r"e^{-s}/(1+sT)",
    2: r"e^{-s}/(1+sT)^2",
    3: r"1/((s+1)(1+sT)^2)",
    4: r"1/(s+1)^n",
    5: r"1/((1+s)(1+as)(1+a^2s)(1+a^3s))",
    6: r"e^{-sL_1}/(s(1+sT_1)),\ T_1+L_1=1",
    7: r"Te^{-sL_1}/((1+sT)(1+sT_1)),\ T_1+L_1=1",
    8: r"(1-as)/(s+1)^3",
    9: r"1/((s+1)((sT)^2+1.4sT+1))",
}


def lags(*times: float) -> tuple[float, ...]:
    """The denominator prod(1 + T_i s), descending coefficients.

    >>> lags(1, 2)
    (2.0, 3.0, 1.0)
    """
    den: np.ndarray = np.ones(1)
    for time in times:
        den = np.polymul(den, [time, 1.0])
    return tuple(float(c) for c in den)


def four_lags(a: float) -> Process:
    """1/((1+s)(1+as)(1+a^2 s)(1+a^3 s)); a = 0.1 is the process behind the example of section 5.4."""
    return Process((1.0,), lags(1, a, a**2, a**3))


def _families() -> Iterator[tuple[int, dict[str, float], Process]]:
    for T in LAGS:
        yield 1, {"T": T}, Process((1.0,), lags(T), 1.0)
    for T in DOUBLE_LAGS:
        yield 2, {"T": T}, Process((1.0,), lags(T, T), 1.0)
    for T in FAST_LAGS:
        yield 3, {"T": T}, Process((1.0,), lags(1, T, T))
    for n in range(3, 9):
        yield 4, {"n": n}, Process((1.0,), lags(*[1] * n))
    for a in TENTHS[:9]:
        yield 5, {"a": a}, four_lags(a)
    for L1 in DEAD_TIMES:
        yield 6, {"L1": L1}, Process((1.0,), (*lags(round(1 - L1, 2)), 0.0), L1)
    for T in (1, 2, 5, 10):
        for L1 in DEAD_TIMES:
            yield 7, {"T": T, "L1": L1}, Process((float(T),), lags(T, round(1 - L1, 2)), L1)
    for a in TENTHS:
        yield 8, {"a": a}, Process((-a, 1.0), lags(1, 1, 1))
    for T in TENTHS[:10]:
        den = np.polymul([1.0, 1.0], [T**2, 1.4 * T, 1.0])
        yield 9, {"T": T}, Process((1.0,), tuple(den))


@cache
def batch() -> tuple[Member, ...]:
    """All 133 processes, in the order of the families.

    >>> len(batch())
    133
    """
    return tuple(Member(family, tuple(p.items()), process) for family, p, process in _families())
