"""The sampled numerator in powers of z - 1: the exact one, and the continuous zeros under the fastest sampling."""

import mpmath
import numpy as np
import pytest

from loopbook.process.near_one import numerator_near_one, zeros_near_one
from loopbook.process.sampled import exact_polynomials, sample
from loopbook.process.transfer_function import Process

PROCESSES = [
    Process([2], [1, 3, 2, 0]),
    Process([2, 3], [1, 0.4, 4], 0.137),
    Process([1, 2, 5], [1, 0.1, 4], 0.03),
    Process([1], np.poly([-1.0] * 6), 0.61),
    Process([1, 0.2], [1, -0.5, 3, 1], 1.0),
    Process([3], [1]),
    Process([3], [1], 0.4),
]


@pytest.mark.parametrize("process", PROCESSES, ids=str)
@pytest.mark.parametrize("h", [1.0, 0.1, 1e-3])
def test_it_is_the_exact_one(process, h):
    sampled = sample(process, h)
    exact = exact_polynomials(process, h, sampled.tau)[2]
    assert numerator_near_one(sampled) == pytest.approx(exact, rel=1e-11, abs=1e-13 * abs(exact).max())


@pytest.mark.parametrize("h", [1e-2, 1e-5, 1e-8])
def test_zeros_of_fast_sampling_lie_where_the_continuous_ones_do(h):
    """z - 1 = h s but for the zeros that sampling adds, here one near -1: to nine digits, however near 1 they lie."""
    process = Process(np.poly([-0.3, -0.7]), np.poly([-1.0, -2.0, -3.0, -5.0]))
    zeros = zeros_near_one(sample(process, h))
    near = np.sort((zeros[abs(zeros - 1) < 0.1].real - 1) / h)
    assert near == pytest.approx(np.expm1(h * np.array([-0.7, -0.3])) / h, rel=3 * h)


def test_a_value_close_to_one_keeps_its_digits():
    """Seven poles sampled 1,000 times in the fastest time constant: B(1) is 1e-20 of its coefficients."""
    process = Process([1], np.poly([-0.3, -0.5, -1, -1.2, -1.5, -1.8, -2.0]))
    h, z = 1e-3, np.exp(1e-5j)
    N = numerator_near_one(sample(process, h))
    with mpmath.workdps(60):
        poles = [mpmath.mpf(str(p)) for p in ("-0.3", "-0.5", "-1", "-1.2", "-1.5", "-1.8", "-2.0")]
        at = mpmath.mpc(0, mpmath.mpf("1e-5"))
        point, expected = mpmath.exp(at), mpmath.mpf(0)
        for p in poles:  # partial fractions: each mode r/(s - p) becomes r (e^(ph) - 1)/(p (z - e^(ph)))
            r = 1 / mpmath.fprod(p - q for q in poles if q != p)
            expected += r * mpmath.expm1(p * h) / (p * (point - mpmath.exp(p * h)))
        below = mpmath.fprod(point - mpmath.exp(p * h) for p in poles)
        expected = complex(expected * below * point)
    assert np.polyval(N, z - 1) == pytest.approx(expected, rel=1e-10)
