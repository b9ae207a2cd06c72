"""Aliases by sampling a sine, converters by counting levels."""

import numpy as np
import pytest

from loopbook.documents.pid_report.aliasing import alias, phase_at, resolution, samples_of_delay


@pytest.mark.parametrize("frequency", [0.3, 4.9, 5.1, 9.0, 12.5, 31.0])
def test_samples_of_a_sine_and_of_its_alias_are_the_same(frequency):
    k = np.arange(40)
    seen = alias(frequency, 0.1)
    assert 0 <= seen <= 5
    assert np.allclose(np.cos(2 * np.pi * frequency * k * 0.1), np.cos(2 * np.pi * seen * k * 0.1))


def test_resolution_counts_levels():
    assert resolution(0.0, 3.0, 2) == 1.0
    with pytest.raises(ValueError, match="bits = 0"):
        resolution(0.0, 1.0, 0)
    with pytest.raises(ValueError, match="h = 0"):
        alias(1.0, 0)


def test_delay_of_the_anti_alias_filter():
    """16 times at half the sampling frequency: sqrt(255)/pi = 5.08 samples for one filter, 2.47 for two."""
    assert abs(samples_of_delay(16) - np.sqrt(255) / np.pi) < 1e-12
    assert abs(samples_of_delay(16, 2) - 2 * np.sqrt(15) / np.pi) < 1e-12
    assert abs(phase_at(1.0, 1 / (2 * np.pi)) + 45) < 1e-12
    with pytest.raises(ValueError, match="attenuation = 1"):
        samples_of_delay(1)
