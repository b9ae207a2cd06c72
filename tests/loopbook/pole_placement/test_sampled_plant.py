"""The sampled tanks in numbers: printed coefficients, placed poles, what rounding does, refusals."""

from fractions import Fraction as F
from itertools import zip_longest

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.signal import cont2discrete

from derivations.pole_placement.diophantine import CommonFactor
from derivations.sampling.zero_order_hold import SamplingError
from loopbook.documents.open import printed as load
from loopbook.pole_placement.exact_placement import place_poles
from loopbook.pole_placement.sampled_plant import SampledPlant, sample_two_lags
from notebook_reports.ledger.verdicts import rounds_to

TANKS = sample_two_lags(5, 7, F(1, 8360), 2, 1)
DOCUMENT = load("double-tank")


def test_the_printed_coefficients_follow_exactly():
    for name, value in TANKS.values.items():
        assert rounds_to(value, DOCUMENT.values[f"sampled-{name.replace('_', '')}"].printed), name
    assert {
        n: DOCUMENT.values[f"sampled-{n.replace('_', '')}"].fraction for n in TANKS.values
    } == TANKS.rounded().values


def test_second_route_scipy_matrix_exponential():
    num, den, _ = cont2discrete(([1 / 8360], np.polymul([5, 1], [7, 1])), 1, method="zoh")
    assert [1, *map(float, TANKS.a)] == pytest.approx(den, rel=1e-13)
    assert [float(c) for c in TANKS.b] == pytest.approx([0, 0, *num[0][1:]], rel=1e-9)


def test_static_gain_and_what_rounding_does_to_it():
    assert float(TANKS.static_gain * 8360) == pytest.approx(1, abs=1e-30)
    assert 1 / TANKS.rounded().static_gain == F("0.0237") / F("2.887e-6")  # 8209.2 W instead of 8360 W


PRINTED = [i for i in DOCUMENT.values if i.startswith("regulator-")]


def test_all_21_parameters_are_transcribed():
    assert len(PRINTED) == 21


@pytest.mark.parametrize("id", PRINTED)
def test_regulator_parameter(id):
    """Each number of the regulator table follows from the printed, rounded, plant coefficients."""
    _, name, q = id.split("-")
    name = "K_r" if name == "Kr" else f"{name[0]}_{name[1]}"
    assert rounds_to(place_poles(TANKS.rounded(), q.removeprefix("q")).parameters[name], DOCUMENT.values[id].printed)


@settings(deadline=None, max_examples=15)
@given(
    q=st.decimals(0, "0.95", places=2).map(str),
    t1=st.integers(1, 9),
    t2=st.integers(1, 9),
    dead=st.sampled_from(["0", "0.5", "1", "2.25"]),
)
@pytest.mark.long
def test_closed_loop_polynomial_is_the_one_asked(q, t1, t2, dead):
    plant = sample_two_lags(t1, t2, 2, dead, 1)
    x = place_poles(plant, q).parameters
    c = [v for n, v in x.items() if n.startswith("c")]
    d = [v for n, v in x.items() if n.startswith("d")]
    C = times([1, *c], [1, -1])
    total = [a + b for a, b in zip_longest(times([1, *plant.a], C), times([0, *plant.b], d), fillvalue=0)]
    wanted = [1, -3 * F(q), 3 * F(q) ** 2, -(F(q) ** 3)]
    assert total == wanted + [0] * (len(total) - 4)


def times(p, q):
    return [sum(p[j] * q[i - j] for j in range(len(p)) if 0 <= i - j < len(q)) for i in range(len(p) + len(q) - 1)]


def test_equal_lags_have_a_regulator_too():
    x = place_poles(sample_two_lags(5, 5, 1, 2, 1), 0.5).parameters
    assert len(x) == 7


@pytest.mark.parametrize(
    "call, error, text",
    [
        (lambda: place_poles(TANKS, 1.0), ValueError, r"q = 1.0: the pole must lie in \[0, 1\)"),
        (lambda: place_poles(TANKS, -0.1), ValueError, "makes the input alternate"),
        (lambda: sample_two_lags(5, 7, 1, 2, 0), ValueError, "h = 0: the sampling interval must be > 0 s"),
        (lambda: sample_two_lags(-5, 7, 1, 2, 1), ValueError, "T1 = -5: a time constant must be > 0 s"),
        (lambda: sample_two_lags(5, 7, 1, -2, 1), SamplingError, "cannot be negative"),
        (lambda: place_poles(SampledPlant((F(-1, 2),), (F(1), F(-1)), F(1)), 0.5), CommonFactor, r"\(z = 1\)"),
    ],
)
def test_refusals(call, error, text):
    with pytest.raises(error, match=text):
        call()
