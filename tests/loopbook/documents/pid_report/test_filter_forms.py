"""Forms of the digital filter: poles, order of their error, exactness where they promise it."""

import numpy as np
import pytest

from derivations.pid import exact_filters, pid_updates
from loopbook.documents.pid_report.filter_forms import (
    FILTERS,
    error,
    filtered,
    newest_gain,
    pole,
    response,
    time_constant,
)


@pytest.mark.parametrize(("name", "order"), [("backward (4.9)", 1), ("Tustin", 2), ("exact, straight y", 2)])
def test_order_of_the_error(name, order):
    """Halving h halves the error of the backward difference and quarters that of the other two."""
    ratio = error(name, 0.7, 0.02, 1.0) / error(name, 0.7, 0.01, 1.0)
    assert abs(ratio - 2**order) < 0.1


def test_exact_for_a_straight_line():
    t = np.arange(50) * 0.3
    assert np.allclose(filtered("exact, straight y", t, 0.3, 0.8), t - 0.8 * (1 - np.exp(-t / 0.8)))


@pytest.mark.parametrize("name", FILTERS)
def test_every_form_keeps_a_constant(name):
    assert abs(response(name, 1e-9, 0.5, 0.7) - 1) < 1e-8
    assert abs(filtered(name, np.ones(200), 0.5, 0.7)[-1] - 1) < 1e-9


def test_poles():
    assert abs(pole("backward (4.9)", 1.0, 1.0) - 0.5) < 1e-15
    assert abs(pole("Tustin", 3.0, 1.0) + 0.2) < 1e-15
    assert abs(time_constant("exact, newest y", 0.3, 0.8) - 0.8) < 1e-12
    assert np.isnan(time_constant("Tustin", 3.0, 1.0))
    with pytest.raises(ValueError, match="'forward' is not a form of the filter; one of backward"):
        pole("forward", 1.0, 1.0)


def test_a_step_of_the_measurement_moves_the_backward_derivative_least():
    """Exact for a held y it moves by K Td/Tf at once, whatever h is."""
    held = newest_gain(exact_filters.filtered_derivative_held(), [0.1, 1.0])
    backward = newest_gain(pid_updates.filtered_derivative().full(), [0.1, 1.0])
    assert held == pytest.approx([1.0, 1.0])
    assert backward == pytest.approx([1 / 1.1, 0.5])
