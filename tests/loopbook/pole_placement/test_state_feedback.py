"""State feedback and observers: printed gains, the eigenvalues, python-control, and the regulator they make."""

from fractions import Fraction as F

import control
import numpy as np
import pytest
import sympy as sp

from loopbook.controllers.rst import PlacementError, Rst
from loopbook.loop.continuous import Loop
from loopbook.loop.discrete import DiscreteLoop
from loopbook.loop.roots import poles as poles_of
from loopbook.pole_placement.state_feedback import observer, state_feedback, state_regulator
from loopbook.process.discretise import c2d
from loopbook.process.state_space_in import ss
from loopbook.process.transfer_function import Process

A, B, C = [[0, 1], [3, 2]], [0, 1], [1, 0]


def eigenvalues(matrix):
    return np.sort_complex(np.linalg.eigvals(np.asarray(matrix, dtype=float)))


def test_the_printed_gain():
    assert state_feedback(A, B, [-1, F(-1, 2)]) == (F(7, 2), F(7, 2))
    assert np.allclose(state_feedback(A, B, [-1, -0.5]), [[3.5, 3.5]], rtol=1e-14)


def test_in_letters():
    w, zeta, a = sp.symbols("omega zeta a", positive=True)
    root = sp.I * w * sp.sqrt(1 - zeta**2)
    assert state_feedback([[0, 1], [0, -a]], B, [-w * zeta + root, -w * zeta - root]) == (w**2, 2 * w * zeta - a)
    assert state_feedback(sp.Matrix([[0, 1], [0, 0]]), B, [-1, -2]) == (2, 3)


@pytest.mark.parametrize("seed", range(12))
def test_random_pairs_by_their_eigenvalues_and_by_python_control(seed):
    rng = np.random.default_rng(seed)
    n = int(rng.integers(1, 7))
    a, b = rng.normal(size=(n, n)), rng.normal(size=(n, 1))
    pairs = [
        p
        for _ in range(n // 2)
        for z in [complex(-rng.uniform(0.5, 2), rng.uniform(0.1, 2))]
        for p in (z, z.conjugate())
    ]
    wanted = pairs + [-rng.uniform(0.5, 2)] * (n % 2)
    K = state_feedback(a, b, wanted)
    assert np.allclose(eigenvalues(a - b @ K), np.sort_complex(wanted), atol=1e-6)
    assert np.allclose(K, control.acker(a, b, wanted), rtol=1e-6)
    L = observer(a, b.T, wanted)
    assert L.shape == (n, 1) and np.allclose(eigenvalues(a - L @ b.T), np.sort_complex(wanted), atol=1e-6)


def test_a_pole_of_any_multiplicity():
    n = 5
    chain = np.eye(n, k=1)
    K = state_feedback(chain, np.eye(n)[-1], [-2.0] * n)
    assert np.allclose(K[0], np.poly([-2.0] * n)[:0:-1], rtol=1e-13)
    exact = state_feedback(np.eye(n, k=1, dtype=int), [0] * (n - 1) + [1], [-2] * n)
    assert exact == (32, 80, 80, 40, 10)


def test_several_inputs():
    rng = np.random.default_rng(3)
    a, b = rng.normal(size=(4, 4)), rng.normal(size=(4, 2))
    K = state_feedback(a, b, [-1, -1, -2, -2])
    assert K.shape == (2, 4) and np.allclose(eigenvalues(a - b @ K), [-2, -2, -1, -1], atol=1e-6)
    with pytest.raises(PlacementError, match="cannot be placed"):
        state_feedback(a, b, [-1, -1, -1, -2])


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (([[1, 0], [0, 2]], [1, 0], [-1, -2]), "not controllable"),
        (([[1.0, 0], [0, 2]], [1, 0], [-1, -2]), "not controllable"),
        ((sp.Matrix([[sp.Symbol("a"), 0], [0, 2]]), [1, 0], [-1, -2]), "not controllable"),
        ((A, B, [-1]), "1 poles for 2 states"),
        ((A, B, [-1 + 1j, -2]), "lacks its conjugate"),
        (([[1, 2]], B, [-1, -2]), "a square A"),
        ((A, ["x", 1], [-1, -2.0]), "no finite real number"),
    ],
)
def test_what_has_no_feedback_is_said(arguments, says):
    with pytest.raises(PlacementError, match=says):
        state_feedback(*arguments)
    if says == "not controllable":
        with pytest.raises(PlacementError, match=r"the pair \(A, C\) is not observable"):
            observer(*(np.asarray(m).T for m in arguments[:2]), arguments[2])


@pytest.mark.parametrize("integral", [False, True])
def test_the_regulator_has_both_sets_of_poles(integral):
    process = Process([1, 2], [1, 1, 3])
    wanted, seen = [-1 + 1j, -1 - 1j] + [-1.5] * integral, [-4, -5]
    regulator = state_regulator(process, poles=wanted, observer_poles=seen, integral=integral)
    loop = Loop(process, regulator)
    assert np.allclose(np.sort_complex(np.asarray(poles_of(loop))), np.sort_complex([*wanted, *seen]), atol=1e-7)
    assert loop.final_values("reference")[0] == pytest.approx(1, rel=1e-9)
    assert (abs(loop.final_values("load")[0]) < 1e-9) == integral
    direct = state_regulator([[-1, -3], [1, 0]], [1, 0], [1, 2], poles=wanted, observer_poles=seen, integral=integral)
    assert np.allclose(direct.S, regulator.S) and np.allclose(direct.R, regulator.R)


@pytest.mark.parametrize("integral", [False, True])
def test_a_sampled_one(integral):
    a, b = np.array([[1.0, 0.1], [0.0, 0.9]]), np.array([0.005, 0.1])
    wanted, seen = [0.7, 0.8] + [0.75] * integral, [0.3, 0.35]
    regulator = state_regulator(a, b, [1, 0], poles=wanted, observer_poles=seen, integral=integral, h=0.1)
    assert isinstance(regulator, Rst)
    loop = DiscreteLoop(ss(a, b, [1, 0], h=0.1), regulator)
    found = np.sort_complex(loop.poles[np.argsort(-abs(loop.poles))][: len(wanted) + 2])
    assert np.allclose(found, np.sort_complex(np.array([*wanted, *seen], dtype=complex)), atol=1e-7)
    assert loop.closed("reference", "y").static_gain == pytest.approx(1, rel=1e-8)


def test_what_makes_no_regulator_is_said():
    with pytest.raises(PlacementError, match="strictly proper"):
        state_regulator(Process([1], [1, 1], 1), poles=[-1], observer_poles=[-2])
    with pytest.raises(PlacementError, match="blocks constant inputs"):
        state_regulator(Process([1, 0], [1, 1, 3]), poles=[-1, -1], observer_poles=[-2, -2])
    with pytest.raises(PlacementError, match="not controllable"):
        state_regulator(Process([1, 0], [1, 1, 3]), poles=[-1, -1, -2], observer_poles=[-2, -2], integral=True)
    assert c2d(Process([1], [1, 1]), 0.1).h == 0.1
