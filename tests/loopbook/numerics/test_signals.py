"""Piecewise polynomials of time: evaluation, jumps, roots, turning points, integrals."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.polynomial import legendre

from loopbook.numerics.signals import HorizonError, Signal
from loopbook.numerics.step_response import open_loop_step
from loopbook.process.transfer_function import Process


def sampled(function, edges, degree=24):
    """A signal that follows a smooth function in each cell."""
    nodes = legendre.leggauss(degree)[0]
    to_coefficients = np.linalg.inv(legendre.legvander(nodes, degree - 1))
    t = (edges[:-1, None] + edges[1:, None]) / 2 + np.diff(edges)[:, None] / 2 * nodes
    return Signal(edges, function(t) @ to_coefficients.T)


SINE = sampled(np.sin, np.linspace(0, 10, 6))


def test_values_roots_and_turning_points_of_a_sine():
    t = np.linspace(0, 10, 101)
    assert np.abs(SINE(t) - np.sin(t)).max() < 1e-14
    assert SINE.roots(0.5) == pytest.approx([np.pi / 6, 5 * np.pi / 6, 13 * np.pi / 6, 17 * np.pi / 6], abs=1e-12)
    assert SINE.maximum() == pytest.approx((np.pi / 2, 1), abs=1e-7)
    assert SINE.minimum() == pytest.approx((3 * np.pi / 2, -1), abs=1e-7)


def test_integrals_of_a_sine():
    assert SINE.integral() == pytest.approx(1 - np.cos(10), rel=1e-14)
    assert SINE.integral_of_square() == pytest.approx(5 - np.sin(20) / 4, rel=1e-14)
    assert SINE.integral_of_magnitude() == pytest.approx(6 + (1 + np.cos(10)), rel=1e-13)


def test_a_jump_counts_from_its_instant_on_and_is_a_root_of_what_it_crosses():
    stairs = Signal(np.array([1.0, 2.0, 3.0]), np.array([[1.0], [-2.0]]))
    assert stairs([0.5, 1.0, 1.999, 2.0, 3.0]).tolist() == [0, 1, 1, -2, -2]
    assert stairs.roots(0.5).tolist() == [1, 2]
    assert stairs.peak() == (2, -2)
    assert stairs.integral_of_magnitude() == 3


@settings(max_examples=50)
@given(st.lists(st.floats(0.1, 3), min_size=1, max_size=4), st.lists(st.floats(0.1, 3), min_size=1, max_size=4))
def test_sums_of_signals_on_different_cells(one, two):
    f, g = (sampled(h, np.concatenate([[0], np.cumsum(d)])) for h, d in ((np.cos, one), (np.exp, two)))
    total = f - 2.0 * g + 0.25
    t = np.linspace(0, total.end, 57)
    assert np.abs(total(t) - (np.cos(t) - 2 * np.exp(t) + 0.25)).max() < 1e-11 * np.exp(total.end)


def test_shifted_and_cut():
    later = SINE.delayed(1.5)
    assert later([1.0, 2.5]) == pytest.approx([0, np.sin(1)])
    short = SINE.until(2.5)
    assert short.end == 2.5
    assert short.integral() == pytest.approx(1 - np.cos(2.5), rel=1e-13)
    assert SINE.derivative()(1.0) == pytest.approx(np.cos(1), rel=1e-12)


@pytest.mark.parametrize(
    ("ask", "error", "says"),
    [
        (lambda: SINE(10.1), HorizonError, "beyond the horizon"),
        (lambda: SINE.until(11), HorizonError, "beyond the horizon"),
        (lambda: SINE(np.nan), ValueError, "NaN"),
        (lambda: Signal(np.array([0.0, 1.0]), np.zeros((2, 3))), ValueError, "2 cells need 3 edges"),
    ],
)
def test_errors(ask, error, says):
    with pytest.raises(error, match=says):
        ask()


@settings(max_examples=80, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(1, 25), st.floats(0.0, 2.0), st.floats(-1, 1))
def test_roots_against_those_of_each_polynomial(seed, count, decay, level):
    """Proved brackets and Newton's method give what the eigenvalues of the companion matrix give."""
    rows = np.random.default_rng(seed).normal(size=(6, count)) * np.exp(-decay * np.arange(count))
    edges = np.arange(7.0)
    expected = []
    for i, row in enumerate(rows):
        x = np.atleast_1d(legendre.legroots(row - level * (np.arange(count) == 0))) if count > 1 else np.zeros(0)
        expected.extend(i + (x[(abs(x.imag) < 1e-9) & (abs(x.real) < 1)].real + 1) / 2)
    found = Signal(edges, rows).roots(level)
    inside = found[~np.isin(found, edges)]
    assert inside == pytest.approx(sorted(expected), abs=1e-8)
    jumps = [j for j in range(1, 6) if (rows[j - 1].sum() - level) * (rows[j] @ (-1.0) ** np.arange(count) - level) < 0]
    assert set(jumps) <= set(found)


def test_a_delay_that_swallows_cells_leaves_them_out():
    signal = Signal(np.array([0.0, 1e-12, 1.0]), np.array([[1.0, 0.0], [2.0, 0.5]]))
    late = signal.delayed(1e6)
    assert len(late.coefficients) == 1 and np.isfinite(late.derivative().coefficients).all()
    assert late(1e6 + 0.5) == pytest.approx(float(signal(0.5)), rel=1e-11) and late(5.0) == 0.0


@pytest.mark.parametrize("delay", [0.1, 1.1997736253208586, 3.1e3])
def test_no_cell_of_a_step_response_is_a_sliver(delay):
    for horizon in np.linspace(0.5, 5, 200):
        response = open_loop_step(Process([0.37, 1.74], [1, 16.3, 271.7]), horizon).delayed(delay)
        assert response.lengths.min() > 1e-7 * horizon


def test_times_before_a_signal_of_almost_no_length_leave_no_warning():
    tiny = Signal(np.array([0.0, 1e-308]), np.ones((1, 3)))
    with np.errstate(all="raise"):
        assert tiny([-1.0, -1e300, 0.0]).tolist() == [0.0, 0.0, 1.0]


@pytest.mark.parametrize("beyond", [0.0, 1e-16, 3e-16, 1e-15, 1e-13, 1e-11])
def test_a_horizon_just_beyond_whole_cells_makes_no_cell_of_noise(beyond):
    """The slope's maximum was sought in a last cell of 3e-14 s, where the polynomial is rounding over rounding."""
    y = open_loop_step(Process([1], [4, 1, 1]), 96.0 * (1 + beyond))
    when, slope = y.derivative().maximum()
    assert (when, slope) == pytest.approx((2.7226888500692, 0.355765566250669), rel=1e-9)
