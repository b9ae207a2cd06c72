"""Poles of loops with dead time: Lambert's W where it knows them, Padé and Newton elsewhere, counts that add up."""

import control
import numpy as np
import pytest
from scipy.special import lambertw

from loopbook.controllers.pid_forms import PidStandard
from loopbook.loop.continuous import Loop
from loopbook.loop.roots import poles, zeros
from loopbook.numerics.argument_principle import Rectangle, zeros_inside
from loopbook.numerics.characteristic_roots import zeros_in
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial
from loopbook.numerics.right_half_plane import RootsError
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process

of = ExponentialPolynomial.of


def right_of(values, line):
    values = values[values.real > line]
    return values[np.lexsort((values.imag, values.real))]


def agree(found, expected, within):
    """Are they the same numbers, as many times?"""
    found, left = np.asarray(found), list(np.asarray(expected))
    assert len(found) == len(left)
    for value in found:
        nearest = min(left, key=lambda other: abs(other - value))
        assert abs(nearest - value) <= within * max(1.0, abs(value)), (value, nearest)
        left.remove(nearest)


@pytest.mark.parametrize("seed", range(30))
def test_a_lag_and_a_gain_by_lamberts_w(seed):
    """T s + 1 + K exp(-L s) = 0: s = W_k(-K L/T exp(L/T))/L - 1/T on every branch k."""
    rng = np.random.default_rng(seed)
    T, L = 10 ** rng.uniform(-4, 4) * np.array([1.0, 10 ** rng.uniform(-1, 1)])
    K = rng.uniform(-3, 3)
    expected = np.array([lambertw(-K * L / T * np.exp(L / T), k) / L - 1 / T for k in range(-60, 61)])
    line = np.sort(expected.real)[::-1][15] * 1.0000001 - 1e-6 / L
    found = poles(Loop(Process([K], [T, 1], L), 1.0), right_of=line)
    agree(np.asarray(found) * L, right_of(expected, line) * L, 1e-10)


def random_loop(rng):
    n = int(rng.integers(1, 5))
    lags = 10 ** rng.uniform(-1, 1, n)
    den = np.ones(1)
    for T in lags:
        den = np.convolve(den, [T, 1])
    if rng.random() < 0.3:
        den = np.convolve(den, [1, 0])
    L = 10 ** rng.uniform(-1, 0.7)
    Td = rng.uniform(0, 1) * (rng.random() < 0.5)
    return Loop(Process([1], den, L), PidStandard(rng.uniform(0.1, 2.5), rng.uniform(1, 20), Td, N=5))


def by_pade(loop, line):
    """The zeros right of a line by Padé approximations of order 12 to 17 and Newton's method on the equation itself."""
    f, slope = loop.characteristic, loop.characteristic.derivative()
    (_, first), (L, second) = f.terms
    found = []
    for order in (12, 14, 17):
        above, below = control.pade(L, order)
        s = np.roots(np.polyadd(np.polymul(first, below), np.polymul(second, above))).astype(complex)
        s = s[np.abs(s) * L < 16]
        for _ in range(50):
            s = s - f(s) / slope(s)
        found.extend(s[np.isfinite(s) & (np.abs(f(s) / slope(s)) < 1e-9 * (1 + abs(s)))])
    found = np.array(found)
    found = found[(found.real > line) & (np.abs(found) * L < 14)]
    kept = []
    for value in found:
        if not any(abs(value - other) < 1e-6 * (1 + abs(value)) for other in kept):
            kept.append(value)
    return np.array(kept)


@pytest.mark.parametrize("seed", range(60))
def test_sixty_random_loops_by_pade_and_newton(seed):
    loop = random_loop(np.random.default_rng(seed))
    L = loop.process.delay
    reach, line = 10 / L, -1.5 / L
    found = poles(loop, box=(line, reach, -reach, reach))
    expected = by_pade(loop, line)
    agree(found, expected[np.abs(expected.imag) < reach], 1e-8)
    rightmost = poles(loop)
    assert loop.is_stable == (rightmost[0].real < 0)
    assert loop.unstable_roots == len(poles(loop, right_of=0.0))
    if loop.is_stable:
        assert loop.decay_rate == pytest.approx(-rightmost[0].real, rel=2e-6)


def test_a_half_plane_holds_what_its_boxes_hold():
    loop = Loop(Process([2], [10, 1], 3), PidStandard(0.8, 10))
    whole = poles(loop, right_of=-2.2)
    parts = [poles(loop, box=(-2.2, 1.0, low, low + 20.0)) for low in np.arange(-130.0, 130.0, 20.0)]
    assert len(whole) == sum(map(len, parts)) > 20
    agree(whole, np.concatenate([np.asarray(part) for part in parts]), 1e-9)
    assert np.abs(loop.characteristic(whole.values)).max() < 1e-6 * np.abs(whole.values).max() ** 2


def test_multiple_roots_are_counted():
    double = zeros_in(of([1.0, 0.0]) + of([np.exp(-1.0)], 1.0), right_of=-3.0)[0]  # (s e^s + 1/e)'' at s = -1
    assert (double.values.tolist(), double.multiplicity.tolist()) == ([-1 + 0j], [2])
    triple = zeros_in(of([1.0, 3.0, 3.0, 1.0]))[0]
    assert triple.multiplicity.tolist() == [3] and abs(triple.values[0] + 1) < 1e-12
    assert len(np.asarray(poles(Process([1], [1, 3, 3, 1])))) == 3


@pytest.mark.parametrize("k", [3.7e-9, 8.1e5])
def test_the_same_in_every_unit_of_time(k):
    loop, slower = (Loop(Process([2], [10 * f, 1], 3 * f), PidStandard(0.8, 10 * f)) for f in (1.0, k))
    agree(np.asarray(poles(slower)) * k, poles(loop), 1e-9)


def test_a_neutral_equation_has_a_chain():
    neutral = of([1.0, 1.0]) + of([0.5, 0.2], 1.0)
    with pytest.raises(RootsError, match=r"infinitely many roots come near Re s = -0.693147 1/s"):
        zeros_in(neutral, right_of=-0.8)
    assert len(zeros_in(neutral, right_of=-0.68)[0].values) == 0
    with pytest.raises(RootsError, match="ask for those farther right"):
        zeros_in(neutral, right_of=-0.69314)
    box = Rectangle(-0.8, 0.0, -20.0, 20.0)
    assert len(zeros_in(neutral, box=box)[0].values) == zeros_inside(neutral, box) == 7


def test_zeros_of_a_sum_that_go_to_the_right():
    """exp(-2 s) (s + 1) + 1: mirrored, an equation of a loop."""
    f = of([1.0]) + of([1.0, 1.0], 2.0)
    found, _ = zeros_in(f, box=Rectangle(-3.0, 3.0, -10.0, 10.0))
    assert len(found.values) == zeros_inside(f, Rectangle(-3.0, 3.0, -10.0, 10.0)) > 0
    assert np.abs(f(found.values)).max() < 1e-10
    with pytest.raises(RootsError, match="beyond all bounds"):
        zeros_in(f, right_of=-1.0)


def test_zeros_and_poles_of_everything():
    P = Process([1, 3], [1, 2, 5])
    agree(poles(P), np.roots([1, 2, 5]), 1e-12)
    agree(zeros(P), [-3], 1e-12)
    assert len(zeros(Process([2], [1, 1]))) == 0
    agree(poles(P.feedback()), np.roots([1, 3, 8]), 1e-12)
    agree(poles(sample(Process([1], [1, 1]), 0.5)), [np.exp(-0.5)], 1e-12)
    loop = Loop(Process([1, 3], [1, 2, 5], 0.3), PidStandard(0.5, 2))
    agree(zeros(loop), [-3, -0.5], 1e-12)
    echo = Process([1], [1]) - Process([1], [1], 2)  # 1 - exp(-2 s): k pi i
    agree(zeros(echo, box=(-1, 1, -10, 10)), [1j * np.pi * k for k in range(-3, 4)], 1e-10)


def test_it_shows_itself():
    found = poles(Loop(Process([2], [10, 1], 3), PidStandard(0.8, 10)), right_of=-1.0)
    assert "damping" in str(found) and "from -1 1/s on" in str(found)
    assert len(repr(poles(Process([1], np.poly(-np.arange(1.0, 21)))))) < 300
    with pytest.raises(RootsError, match="give one of them"):
        poles(Process([1], [1, 1]), right_of=-1.0, box=(-1, 0, -1, 1))
    with pytest.raises(RootsError, match="left < right"):
        poles(Process([1], [1, 1]), box=(1, 0, -1, 1))
    with pytest.raises(RootsError, match="no poles"):
        poles("x")
