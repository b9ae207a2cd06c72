"""Multiple roots are found as such, in any unit of time, and roots that are near but apart stay apart."""

import numpy as np
import pytest

from loopbook.numerics.multiple_roots import put_together
from loopbook.process.transfer_function import Process

PAIR = [complex(-0.3, 0.5), complex(-0.3, -0.5)]
MULTIPLE = {
    "twenty lags": [-1.0] * 20,
    "neighbours": [-1.0] * 3 + [-1.1] * 2,
    "with oscillators and integrators": [-1.0] * 3 + [-1.1] * 2 + PAIR * 2 + [0.0, 0.0],
    "oscillators": PAIR * 3,
    "three groups": [-5.0] * 2 + [-1.0] * 4 + [-0.2] * 2,
    "unstable": [2.0] * 3 + [-2.0] * 2,
}


@pytest.mark.parametrize("roots", MULTIPLE.values(), ids=MULTIPLE)
@pytest.mark.parametrize("k", [1.0, 0.0037, 7.3e8, 2.9e-9])
def test_each_root_is_found_once_and_right(roots, k):
    p = np.real(np.poly(roots)) * k ** np.arange(len(roots), -1, -1.0)
    found = Process([1], p).poles * k
    assert len(set(found.tolist())) == len(set(roots))
    for root in set(roots):
        same = found[abs(found - root) < 0.02]
        assert len(same) == roots.count(root) and same == pytest.approx(root, rel=1e-11)


@pytest.mark.parametrize("roots", [[-1, -1.001, -3], [-1, -1 - 1e-6, -2], [-1, -1.2, -1.3, -1.5], [-1, -1e6], [-1]])
def test_roots_that_are_apart_stay_as_they_are(roots):
    p = np.poly(roots)
    assert (put_together(p, np.roots(p)) == np.roots(p)).all()


def test_random_polynomials_keep_their_roots():
    rng = np.random.default_rng(3)
    for _ in range(200):
        p = np.poly(-np.exp(rng.uniform(-2, 2, rng.integers(1, 8))))
        roots = np.roots(p)
        back = p[0] * np.poly(put_together(p, roots))
        assert abs(back - p).max() <= 1e-13 * abs(p).max()


def test_crowded_roots_whose_product_is_too_small_for_a_number_stay_as_they_are():
    roots = 1e-6 * (1 + 1e-9 * np.arange(60)) + 0j
    assert put_together(np.poly(roots).real, roots).tolist() == roots.tolist()
