"""A cell's matrix: both ways to it agree, and it solves x' = A x + b v + e."""

import numpy as np
import pytest
from scipy.linalg import expm

from loopbook.numerics import collocation
from loopbook.numerics.collocation import DelayEquation, cell_operator, radau


def equation(n: int, seed: int) -> DelayEquation:
    draw = np.random.default_rng(seed).normal
    A = draw(size=(n, n)) / np.sqrt(n) - 2 * np.eye(n)
    return DelayEquation(A, draw(size=n), draw(size=n), draw(size=(2, n)), draw(size=2), draw(size=2), 1.0)


@pytest.mark.parametrize(("n", "seed"), [(1, 0), (2, 1), (5, 2), (12, 3)])
def test_one_system_and_node_by_node_give_one_operator(monkeypatch, n, seed):
    system, found = equation(n, seed), []
    for most in (0, n):
        monkeypatch.setattr(collocation, "MANY_STATES", most)
        found.append(cell_operator(system, 0.8))
    assert found[0] == pytest.approx(found[1], abs=1e-13 * abs(found[1]).max())


@pytest.mark.parametrize("n", [3, 20])
def test_a_constant_input_gives_what_the_matrix_exponential_gives(n):
    system, length = equation(n, n), 0.8
    x = np.linspace(1, 2, n)
    whole = np.block([[system.A, (0.7 * system.b + system.e)[:, None]], [np.zeros((1, n + 1))]])
    known = np.concatenate([x, np.full(collocation.DEGREE, 0.7), [1.0]])
    seen = cell_operator(system, length) @ known
    for node, value in zip(radau()[0], seen, strict=True):
        assert value == pytest.approx((expm(whole * length * (node + 1) / 2) @ np.append(x, 1.0))[:n], abs=1e-12)
