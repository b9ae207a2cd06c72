"""Sampling by name: published coefficients, python-control and scipy, and the defining property of each method."""

import control
import numpy as np
import pytest
from scipy.signal import cont2discrete

from loopbook.process.construct import tf
from loopbook.process.discrete import DiscreteProcess
from loopbook.process.discretise import c2d
from loopbook.process.pade import pade
from loopbook.process.rows import ProcessError
from loopbook.process.sampled import sample
from loopbook.process.state_space_in import ss
from loopbook.process.thiran import thiran
from loopbook.process.transfer_function import Process

PROCESSES = [Process([1], [1, 1]), Process([1, 3], [1, 2, 5]), Process([2], [1, 3, 2, 0]), Process([1, 2], [1, 4])]


def test_a_fractional_delay_held_as_matlab_prints_it():
    """10 e^(-0.25 s)/(s^2 + 3 s + 10), Ts = 0.1 (MATLAB, c2d): z^-3 (.01187 z^2 + .06408 z + .009721)/(...)."""
    found = c2d(Process([10], [1, 3, 10], 0.25), 0.1)
    assert [float(f"{b:.4g}") for b in found.num] == [0, 0, 0, 0.01187, 0.06408, 0.009721]
    assert [float(f"{a:.4g}") for a in found.den] == [1, -1.655, 0.7408]


@pytest.mark.parametrize(
    ("process", "num", "den"),
    [  # harold's tests
        (Process([1], [1, 1]), [0.04837418, 0.0467884], [1, -0.90483742]),
        (Process([1], [1, 0, 0]), [5 / 3000, 20 / 3000, 5 / 3000], [1, -2, 1]),
    ],
)
def test_first_order_hold_as_printed(process, num, den):
    found = c2d(process, 0.1, "foh")
    assert np.allclose(found.num, num, rtol=0, atol=5e-9) and np.allclose(found.den, den, rtol=0, atol=5e-9)


@pytest.mark.parametrize("delay", [0.0, 0.3, 0.37])
@pytest.mark.parametrize("process", PROCESSES)
def test_first_order_hold_is_exact_for_what_is_linear_between_the_samples(process, delay):
    """u rises by one per h up to k = 4 and stays: in continuous time a ramp less the same one later."""
    h, process = 0.1, process.delayed(delay)
    k = np.arange(60)
    expected = (process.ramp(k * h) - process.ramp(np.maximum(k - 4, 0) * h)) / h
    assert np.allclose(c2d(process, h, "foh").response(np.minimum(k, 4)), expected, rtol=1e-11, atol=1e-12)


@pytest.mark.parametrize("process", PROCESSES)
@pytest.mark.parametrize("method", ["tustin", "euler", "backward", "foh"])
def test_as_scipy_does(process, method):
    name = {"tustin": "bilinear", "euler": "euler", "backward": "backward_diff", "foh": "foh"}[method]
    num, den, _ = cont2discrete((process.num, process.den), 0.2, method=name)
    found = c2d(process, 0.2, method)
    z = np.exp(1j * np.array([0.1, 0.7, 2.0]))
    assert np.allclose(found(z), np.polyval(num[0], z) / np.polyval(den, z), rtol=1e-9)


@pytest.mark.parametrize("process", PROCESSES)
def test_tustin_is_exact_at_the_prewarped_frequency(process):
    found = c2d(process, 0.2, "tustin", prewarp=3.0)
    assert found.error(3.0) < 1e-13 and found.error(2.0) > 1e-4
    theirs = control.sample_system(process.to_control(), 0.2, method="tustin", prewarp_frequency=3.0)
    z = np.exp(1j * np.array([0.1, 0.7, 2.0]))
    assert np.allclose(found(z), theirs(z), rtol=1e-10)
    assert found.method == "tustin, exact at 3 rad/s"


@pytest.mark.parametrize("process", PROCESSES)
def test_matched_maps_poles_and_zeros_and_keeps_the_static_gain(process):
    h = 0.1
    found = c2d(process, h, "matched")
    assert np.allclose(np.sort_complex(found.poles), np.sort_complex(np.exp(process.poles * h)), atol=1e-12)
    finite = np.exp(process.zeros * h)
    expected = np.concatenate([finite, -np.ones(max(process.relative_degree - 1, 0))])
    assert np.allclose(np.sort_complex(found.zeros), np.sort_complex(expected), atol=1e-9)
    if np.isfinite(process.static_gain):
        assert found.static_gain == pytest.approx(process.static_gain, rel=1e-12)
    else:
        assert found.error(1e-3) < 1e-3
    theirs = control.sample_system(PROCESSES[0].to_control(), h, method="matched")
    assert np.allclose(c2d(PROCESSES[0], h, "matched")(2.0), theirs(2.0), rtol=1e-12)


def test_dead_times_where_a_method_has_no_fraction():
    P = Process([1], [1, 1], 0.3)
    assert c2d(P, 0.1, "tustin").num[:3] == (0.0, 0.0, 0.0) and c2d(P, 0.1, "tustin").num[3] != 0
    with pytest.raises(ProcessError, match=r"is 3.7 samples, and matched has no form for a fraction"):
        c2d(P.delayed(0.07), 0.1, "matched")
    with_thiran = c2d(P.delayed(0.07), 0.1, "tustin", fraction=4)
    assert with_thiran.method == "tustin, Thiran of order 4 for the dead time"
    assert with_thiran.error(1.0) < 2e-3


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"method": "nearest"}, "one of zoh, foh, tustin"),
        ({"method": "foh", "prewarp": 1.0}, "an option of tustin"),
        ({"method": "tustin", "prewarp": 40.0}, "between 0 and pi/h"),
    ],
)
def test_what_cannot_be_sampled_is_said(options, says):
    with pytest.raises(ProcessError, match=says):
        c2d(Process([1], [1, 1]), 0.1, **options)


def test_pade_as_printed_and_as_python_control():
    found = pade(1.5, (2, 5))
    assert np.allclose(found.num, [0.053571, -0.428571, 1], rtol=0, atol=5e-7)
    printed = [0.00301339, 0.03013393, 0.16071429, 0.53571429, 1.07142857, 1]
    assert np.allclose(found.den, printed, rtol=0, atol=5e-9)
    for order in (1, 3, 7):
        num, den = control.pade(0.8, order)
        s = np.array([0.3j, 2 + 1j])
        assert np.allclose(pade(0.8, order)(s), np.polyval(num, s) / np.polyval(den, s), rtol=1e-12)


@pytest.mark.parametrize("order", [(0, 1), (1, 1), (2, 5), (6, 6), (20, 20)])
def test_pade_touches_the_dead_time_to_its_order(order):
    """Halving s divides the error by 2^(m + n + 1)."""
    found, (m, n) = pade(1.0, order), order
    near = 0.3 * (m + n + 1) / 3
    if found.error(near / 2) > 1e-12:
        ratio = found.error(near) / found.error(near / 2)
        assert ratio == pytest.approx(2 ** (m + n + 1), rel=0.25)
    if m == n:
        assert abs(abs(found(1j * np.array([0.3, 5.0]))) - 1).max() < 1e-12, "an all-pass"


def test_an_approximation_is_a_process_that_knows_its_error():
    exact = Process([2], [10, 1], 3)
    found = pade(exact, 2)
    assert isinstance(found, Process) and found.delay == 0 and found.exact is exact
    assert found.error(0.5) == pytest.approx(abs(found(0.5j) / exact(0.5j) - 1))
    edge = found.good_to(0.05)
    assert found.error(edge) == pytest.approx(0.05, rel=1e-9) and found.error(0.99 * edge) < 0.05
    assert found.said().startswith("Padé of order 2: within 5 % of the exact one below ")
    assert isinstance(found * 2, Process)
    with pytest.raises(ProcessError, match="whole number from 1 to 60"):
        pade(exact, (3, 2))
    with pytest.raises(ProcessError, match="no dead time"):
        pade(Process([1], [1, 1]), 2)


def test_thiran_as_printed_and_flat():
    found = thiran(2.4, 1.0)  # Octave
    assert [float(f"{c:.4g}") for c in found.den] == [1, 0.5294, -0.04813, 0.004159]
    w = np.array([0.3, 1.1, 3.0])
    assert np.allclose(abs(found.frequency_response(w)), 1, rtol=1e-13)
    low = np.array([1e-3, 2e-3])
    delay = -np.diff(np.unwrap(np.angle(found.frequency_response(low)))) / np.diff(low)
    assert delay == pytest.approx(2.4, rel=1e-9)
    assert found.is_stable and thiran(0.24, 0.1).den == pytest.approx(found.den, rel=1e-12)
    assert thiran(3.0, 1.0).num == (0, 0, 0, 1) and thiran(3.0, 1.0).error(2.0) < 1e-14
    with pytest.raises(ProcessError, match=r"a whole number from 1 to 3 for 2\.4 samples"):
        thiran(2.4, 1.0, 4)


def test_a_z_domain_plant_and_its_algebra():
    G, H = tf([0.5], [1, -0.5], h=0.1), tf([1, 0.2], [1, 0.3, 0.1], h=0.1)
    assert G == DiscreteProcess((0, 0.5), (1, -0.5), 0.1)
    z = np.exp(1j * np.array([0.3, 1.0, 2.5]))
    cases = {
        "G + H": (G + H, G(z) + H(z)),
        "G - H": (G - H, G(z) - H(z)),
        "G * H": (G * H, G(z) * H(z)),
        "2 - G/4": (2 - G / 4, 2 - G(z) / 4),
        "1/(1 + H)": (1 / (1 + H), 1 / (1 + H(z))),
        "feedback": (G.feedback(H), G(z) / (1 + G(z) * H(z))),
        "with a sampled process": (G * sample(Process([1], [1, 1]), 0.1), G(z) * sample(Process([1], [1, 1]), 0.1)(z)),
    }
    for name, (ours, expected) in cases.items():
        assert np.allclose(ours(z), expected, rtol=1e-13), name
    assert G.poles.tolist() == [0.5] and H.zeros.tolist() == [-0.2] and G.static_gain == 1
    assert tf([1], [1, -1], h=1).static_gain == float("inf")
    with pytest.raises(ProcessError, match="two sampling intervals"):
        G + tf([1], [1, 0], h=0.2)
    with pytest.raises(ProcessError, match="need the future"):
        1 / G
    with pytest.raises(ProcessError, match="precede u"):
        tf([1, 0, 0], [1, 1], h=1)
    with pytest.raises(ProcessError, match="approximates nothing"):
        G.error(1.0)
    with pytest.raises(TypeError):
        G + "x"
    assert len(repr(thiran(25.5, 1.0))) < 300 and r"\frac" in G._repr_latex_()


@pytest.mark.parametrize("n", [0, 1, 3, 5, 8, 14])
def test_state_space_in(n):
    rng = np.random.default_rng(n)
    A, B, C, D = rng.normal(size=(n, n)), rng.normal(size=n), rng.normal(size=n), rng.normal()
    found, s = ss(A, B, C, D, delay=0.3), 0.4 + 1.3j
    expected = (C @ np.linalg.solve(s * np.eye(n) - A, B) + D) * np.exp(-0.3 * s)
    assert found(s) == pytest.approx(expected, rel=1e-10)
    assert ss(A, B, C, D, h=0.1)(s) == pytest.approx(expected * np.exp(0.3 * s), rel=1e-10)


def test_state_space_cancels_exactly():
    """A chain of six integrators has no trace of rounding in its numerator, and fractions stay what they are."""
    from fractions import Fraction

    A = np.diag(np.full(5, 0.1), 1)
    assert ss(A, [0, 0, 0, 0, 0, 0.7], [0.3, 0, 0, 0, 0, 0]).num == pytest.approx((0.3 * 0.7 * 0.1**5,), rel=1e-14)
    assert len(ss(A, [0, 0, 0, 0, 0, 0.7], [0.3, 0, 0, 0, 0, 0]).num) == 1
    third = Fraction(1, 3)
    assert ss([[-third]], [third], [3]).den == (1.0, 1 / 3)
    for wrong in (([[1, 2]], [1], [1]), ([[1]], [[1, 2]], [1]), ([[np.inf]], [1], [1]), ([["a"]], [1], [1])):
        with pytest.raises(ProcessError):
            ss(*wrong)
