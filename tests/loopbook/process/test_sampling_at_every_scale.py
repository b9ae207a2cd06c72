"""Sampled models and step responses of processes with many lags, integrators and poles far apart, against 60 digits."""

import mpmath
import numpy as np
import pytest

from loopbook.process.sampled import exact_polynomials, sample
from loopbook.process.transfer_function import Process, ProcessError

pytestmark = pytest.mark.long

SIX_LAGS = np.append(np.array([1.0]), [])
for lag in (9000, 9500, 1e4, 1.05e4, 1.1e4, 1.2e4):
    SIX_LAGS = np.polymul(SIX_LAGS, [lag, 1])
SIX_LAGS = np.append(SIX_LAGS, 0.0)


def reference(process, h):
    """(B, A) by a plain companion form and mpmath's exponential; B by A times the Markov parameters."""
    with mpmath.workdps(80):
        n = process.order
        a = [mpmath.mpf(c) / mpmath.mpf(process.den[0]) for c in process.den]
        b = [mpmath.mpf(0)] * (n + 1 - len(process.num)) + [
            mpmath.mpf(c) / mpmath.mpf(process.den[0]) for c in process.num
        ]
        M = mpmath.zeros(n + 1)
        for i in range(n):
            if i + 1 < n:
                M[i, i + 1] = 1
            M[n - 1, i] += -a[n - i]
        M[n - 1, n] = 1
        C = [b[n - i] - b[0] * a[n - i] for i in range(n)]
        whole = mpmath.floor(mpmath.mpf(process.delay) / h)
        tau = mpmath.mpf(process.delay) - whole * h
        if tau < mpmath.mpf(10) ** -12 * h or h - tau < mpmath.mpf(10) ** -12 * h:
            whole, tau = mpmath.nint(mpmath.mpf(process.delay) / h), mpmath.mpf(0)
        late, early = mpmath.expm(M * (h - tau), method="taylor"), mpmath.expm(M * tau, method="taylor")
        Phi = late[:n, :n] * early[:n, :n] if n else mpmath.zeros(0)
        newer, older = late[:n, n], late[:n, :n] * early[:n, n]
        poly = [mpmath.mpf(1)]
        m = mpmath.eye(n)
        for k in range(1, n + 1):
            m = Phi * m
            poly.append(-sum(m[i, i] for i in range(n)) / k)
            m = m + mpmath.eye(n) * poly[-1]
        g = [[mpmath.mpf(0)] * (n + 1) for _ in range(2)]
        for row, state in zip(g, (newer, older), strict=True):
            for i in range(1, n + 1):
                row[i] = sum(C[j] * state[j] for j in range(n))
                state = Phi * state
        g[1 if tau else 0][0] = b[0]
        B = [mpmath.mpf(0)] * (n + 2)
        for shift in range(2):
            for i in range(n + 1):
                for j in range(n + 1 - i):
                    B[i + j + shift] += poly[i] * g[shift][j]
        B = B if tau else B[: n + 1]
        return np.array([0.0] * int(whole) + [float(x) for x in B]), np.array([float(x) for x in poly])


@pytest.mark.parametrize("h", [1.0, 100.0, 1e3, 1e4, 6e4])
@pytest.mark.parametrize("delay", [0.0, 0.37, 2.0])
def test_six_lags_of_hours_and_an_integrator(h, delay):
    process = Process([1], SIX_LAGS, delay * h)
    B, A = sample(process, h).polynomials
    b, a = reference(process, h)
    assert np.allclose(B, b, rtol=1e-10, atol=0)
    assert np.allclose(A, a, rtol=1e-12, atol=0)


@pytest.mark.parametrize("t", [10.0, 1e3, 1e4, 1e5, 1e6])
def test_its_step_response(t):
    """By the residues of G/s with 60 digits."""
    with mpmath.workdps(60):
        c = [mpmath.mpf(x) for x in SIX_LAGS[:-1]]
        poles = mpmath.polyroots(c, maxsteps=500, extraprec=500)
        value = mpmath.mpf(t) / c[-1] - c[-2] / c[-1] ** 2
        for p in poles:
            value += mpmath.exp(p * t) / (p**2 * c[0] * mpmath.fprod(p - q for q in poles if q is not p))
    assert Process([1], SIX_LAGS).step([0.0, t])[1] == pytest.approx(float(mpmath.re(value)), rel=1e-12)


CASES = [
    (Process([1], np.poly([-1.0] * 7)), 0.01),
    (Process([1, 0.3], np.poly([-1.0] * 5), 0.025), 0.1),
    (Process([1], [1, 0, 0, 0]), 1e-3),
    (Process([1], [1, 0, 0, 0]), 1e6),
    (Process([2, 1], [1, 1], 2.05), 0.1),
    (Process([1, 2, 5], [1, 0.1, 4], 0.33), 0.1),
    (Process([1], np.polymul([1e-6, 1], [1e6, 1]), 1e-7), 1e-3),
    (Process([1], [1, -3, 1]), 0.5),
    (Process([1e12], [1e-9, 1, 0], 3e-10), 1e-10),
    (Process([1], np.polymul(np.poly([-1.0] * 4), [1, 0.02, 9])), 0.02),
    (Process([5], [1], 0.3), 1.0),
]


@pytest.mark.parametrize("case", range(len(CASES)))
def test_each_coefficient_has_its_digits(case):
    process, h = CASES[case]
    B, A = sample(process, h).polynomials
    b, a = reference(process, h)
    assert np.allclose(B, b, rtol=2e-10, atol=1e-15 * abs(b).max())
    assert np.allclose(A, a, rtol=1e-11, atol=1e-60)


@pytest.mark.parametrize("seed", range(30))
def test_sampling_is_the_same_in_every_unit(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 7))
    poles = [*(-np.exp(rng.uniform(-2, 1.5, n - 1))), float(rng.choice([0.0, -0.3, 0.2]))]
    zeros = -np.exp(rng.uniform(-1, 1, int(rng.integers(0, n))))
    num, den = np.atleast_1d(np.poly(zeros)), np.poly(poles)
    delay, h = float(rng.choice([0.0, rng.uniform(0, 3)])), float(np.exp(rng.uniform(-4, 1)))
    k, gain = float(np.exp(rng.uniform(-20, 20))), float(np.exp(rng.uniform(-20, 20)))
    stretched = Process(
        gain * num * k ** np.arange(len(num) - 1, -1, -1.0), den * k ** np.arange(n, -1, -1.0), delay * k
    )
    (B, A), (b, a) = sample(Process(num, den, delay), h).polynomials, sample(stretched, h * k).polynomials
    assert np.allclose(b, gain * B, rtol=1e-9, atol=1e-15 * gain * abs(B).max())
    assert np.allclose(a, A, rtol=1e-11, atol=0)


def test_the_exact_route_is_that_of_the_reference():
    process = Process([1, 2, 5], [1, 0.1, 4])
    for mine, theirs in zip(
        exact_polynomials(process, 0.1, 0.03)[:2], reference(process.delayed(0.03), 0.1), strict=True
    ):
        assert np.allclose(mine, theirs, rtol=4e-16, atol=0)


def test_what_outgrows_all_numbers_is_said():
    with pytest.raises(ProcessError, match=r"grows by exp\(800\).*pole is 1 1/s: sample faster"):
        sample(Process([1], [1, -1]), 800.0)
    B, A = sample(Process([1], [1, -1]), 100.0).polynomials
    assert B[1] == pytest.approx(float(mpmath.exp(100)), rel=1e-12) and A[1] == pytest.approx(-B[1], rel=1e-12)
    assert np.isfinite(sample(Process([1], [1, 1]), 1e9).polynomials[0]).all()
