"""Areas under the impulse response give what the quick way to sample gives, for every kind of pole."""

import pytest
import sympy as sp

from derivations.algebra.delay_polynomials import coefficients
from derivations.sampling.by_areas import INDEX, area, numerator
from derivations.sampling.zero_order_hold import S, T, impulse_response, two_lags, zero_order_hold

T_1, T_2, K, h = sp.symbols("T_1 T_2 K h", positive=True)
PROCESSES = {
    "one lag": K / (1 + T_1 * S),
    "two lags": two_lags(T_1, T_2, K),
    "equal lags": two_lags(T_1, T_1, K),
    "integrator": K / S,
    "integrator and lag": K / (S * (1 + T_1 * S)),
}


@pytest.mark.parametrize("name", PROCESSES)
def test_the_numerator_is_that_of_the_quick_way_and_ends(name):
    G = PROCESSES[name]
    model = zero_order_hold(G, h)
    order = len(coefficients(model.A)) - 1
    found = numerator(G, model.A, h, order + 2)
    expected = coefficients(model.B)[1:]
    assert [sp.simplify(x - y) for x, y in zip(found, [*expected, 0, 0], strict=True)] == [0] * (order + 2)


@pytest.mark.parametrize("name", PROCESSES)
def test_an_area_is_the_integral(name):
    G, third = PROCESSES[name], {K: 2, T_1: 5, T_2: 7, h: 1, INDEX: 3}
    law = area(G, h)
    numbers = impulse_response(G).subs(third)
    assert float(law.rhs.subs(third)) == pytest.approx(float(sp.Integral(numbers, (T, 2, 3)).evalf()), rel=1e-12)
    assert law.lhs.has(sp.Integral) and law.lhs.limits == ((T, h * (INDEX - 1), h * INDEX),)
