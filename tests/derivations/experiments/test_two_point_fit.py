"""The fit through two points: the factor 3/2, its inverse, and the double lag in closed form."""

import pytest
import sympy as sp

from derivations.experiments import two_point_fit as f


def test_factor_is_exactly_three_halves_for_the_two_exponentials():
    fit = f.fit_283_632()
    assert sp.simplify(fit[f.T] - sp.Rational(3, 2) * (f.t1 - f.t2)) == 0
    assert sp.simplify(fit[f.T0] - (f.t1 - fit[f.T])) == 0


def test_the_rounded_per_cents_belong_to_the_two_exponentials():
    assert round(100 * float(f.FRACTIONS[f.p1]), 1) == 63.2
    assert round(100 * float(f.FRACTIONS[f.p2]), 1) == 28.3


def test_the_fit_of_a_first_order_model_with_dead_time_returns_the_model():
    for p1, p2 in (("7/10", "1/5"), ("1/2", "1/4")):
        p1, p2 = sp.Rational(p1), sp.Rational(p2)
        found = {n: e.subs({f.p1: p1, f.p2: p2}) for n, e in f.fit().items()}
        times = {f.t1: f.rise(p1), f.t2: f.rise(p2)}
        assert float(found[f.T].subs(times).subs({f.T: 3, f.T0: 2})) == pytest.approx(3, rel=1e-12)
        assert float(found[f.T0].subs(times).subs({f.T: 3, f.T0: 2})) == pytest.approx(2, rel=1e-12)


def test_without_dead_time_the_fit_finds_none():
    fit = f.fit_283_632()
    times = {f.t1: -f.T * sp.log(1 - f.FRACTIONS[f.p1]), f.t2: -f.T * sp.log(1 - f.FRACTIONS[f.p2])}
    assert sp.simplify(sp.expand_log(fit[f.T0].subs(times), force=True)) == 0


@pytest.mark.parametrize("p", [sp.Rational(283, 1000), sp.Rational(632, 1000), sp.Rational(1, 20)])
def test_the_double_lag_is_at_p_at_the_instant_in_closed_form(p):
    at = f.double_lag_instant(p).subs(f.tau, 2)
    s, t = sp.symbols("s t", positive=True)
    step = sp.inverse_laplace_transform(1 / (s * (1 + 2 * s) ** 2), s, t)
    rest = (1 - step).subs(t, at)
    assert abs(sp.N(rest - (1 - p), 30)) < sp.Float("1e-25")


@pytest.mark.parametrize("order", [1, 2, 3, 4])
def test_each_lag_of_a_row_is_driven_by_the_one_before(order):
    before, y = f.equal_lags(order - 1), f.equal_lags(order)
    assert sp.simplify(sp.diff(y, f.x) - (before - y)) == 0 and y.subs(f.x, 0) == 0


def test_the_instant_in_closed_form_belongs_to_two_equal_lags():
    x = f.double_lag_instant(sp.Rational(283, 1000)) / f.tau
    assert float(f.equal_lags(2).subs(f.x, x)) == pytest.approx(0.283, rel=1e-12)
