"""Loops in the z domain: MATLAB's printed margins, the sampled loop of a continuous process, unstable loops."""

import mpmath
import numpy as np
import pytest

from loopbook.controllers.rst import Rst
from loopbook.loop.continuous import Loop
from loopbook.loop.crossovers import crossovers
from loopbook.loop.diagrams import bode, margins, nyquist
from loopbook.loop.discrete import DiscreteLoop
from loopbook.loop.sampled import SampledLoop
from loopbook.pole_placement.place import place
from loopbook.process.construct import tf
from loopbook.process.sampled import sample
from loopbook.process.transfer_function import Process

MATLAB = tf([0.04798, 0.0464], [1, -1.81, 0.9048], h=0.1)


def test_margins_of_a_z_domain_plant_as_matlab_prints_them():
    """MATLAB, `margin`: GM 2.0517 at 5.4374 rad/s, PM 13.5711 at 4.3544 (interpolated; to rounding 13.57116)."""
    found = margins(MATLAB)
    assert found.gain == pytest.approx(2.0517, abs=5e-5) and found.phase == pytest.approx(13.5711, abs=1e-4)
    at_gain, at_phase = found.gain_crossovers, found.phase_crossovers
    assert next(c.w for c in at_gain if c.phase_margin == found.phase) == pytest.approx(4.3544, abs=5e-5)
    assert min(c.w for c in at_phase if c.gain == found.gain) == pytest.approx(5.4374, abs=5e-5)


def test_the_same_with_thirty_digits():
    with mpmath.workdps(30):
        b1, b0, a1, a0 = map(mpmath.mpf, ("0.04798", "0.0464", "-1.81", "0.9048"))

        def G(w):
            z = mpmath.expj(w / 10)
            return (b1 * z + b0) / (z**2 + a1 * z + a0)

        w = mpmath.findroot(lambda w: abs(G(w)) - 1, 4.35)
        phase = float(mpmath.degrees(mpmath.arg(-G(w))))
    assert margins(MATLAB).phase == pytest.approx(phase, rel=1e-12)


def test_a_sampled_loop_seen_at_the_samples_only():
    process, h = Process([1], [10, 1], 1.5), 1.0
    rst = Rst((1, -1), (2.0, -1.7), (0.3,), h)
    between, at_samples = SampledLoop(process, rst), DiscreteLoop(sample(process, h), rst)
    a, b = between.margins(), at_samples.margins()
    assert (b.gain, b.phase, b.Ms.value, b.Mt.value) == pytest.approx((a.gain, a.phase, a.Ms.value, a.Mt.value))
    assert (b.Ms.w, b.Mt.w) == pytest.approx((a.Ms.w, a.Mt.w))
    for source in ("reference", "load"):
        run = between.step(source, 40)
        assert np.allclose(at_samples.closed(source, "y").response(np.ones(41)), run.y, atol=1e-12)
        assert np.allclose(at_samples.closed(source, "u").response(np.ones(41)), run.u, atol=1e-12)
    noisy = at_samples.closed("noise", "u").response(np.ones(41))
    assert np.allclose(noisy, between.step("noise", 40).u, atol=1e-12)


def test_margins_are_where_the_loop_becomes_unstable():
    loop = DiscreteLoop(MATLAB)
    limit = loop.margins().gain
    assert DiscreteLoop(MATLAB, 0.999 * limit).is_stable and not DiscreteLoop(MATLAB, 1.001 * limit).is_stable
    with pytest.raises(ValueError, match="unstable"):
        DiscreteLoop(MATLAB, 1.001 * limit).margins()


def test_an_unstable_loop_keeps_the_sign_of_its_angle():
    """ControlSystems.jl: 50/(5 s^3 + 10.25 s^2 + 6.25 s + 1) has -35.1 degrees, and is unstable."""
    found = crossovers(Process([50], [5, 10.25, 6.25, 1]))
    assert not found.stable and round(found.phase, 1) == -35.1
    assert "no margins" in str(found) and "-35.06" in str(found)
    with pytest.raises(ValueError, match="unstable"):
        margins(Process([50], [5, 10.25, 6.25, 1]))


@pytest.mark.parametrize("system", [Process([2], [10, 1], 3), MATLAB, Loop(Process([2], [10, 1], 3), 0.5)])
def test_crossovers_of_a_stable_loop_are_its_margins(system):
    found, m = crossovers(system), margins(system)
    assert found.stable and found.phase == m.phase
    assert found.gain_crossovers == m.gain_crossovers
    assert m.gain in [c.gain for c in found.phase_crossovers]


def test_they_are_drawn():
    for system in (MATLAB, DiscreteLoop(MATLAB)):
        assert len(bode(system).axes) == 2 and len(nyquist(system).axes) == 1


def test_what_makes_no_loop_is_said():
    with pytest.raises(ValueError, match="sampled every"):
        DiscreteLoop(MATLAB, Rst((1,), (1,), (1,), 0.2)).margins()
    with pytest.raises(ValueError, match="no regulator"):
        DiscreteLoop(MATLAB, "x").margins()
    with pytest.raises(ValueError, match="to y or u"):
        DiscreteLoop(MATLAB).closed("output", "y")
    with pytest.raises(ValueError, match="no crossovers"):
        crossovers("x")


def test_a_sampled_process_with_many_samples_of_dead_time_is_as_quick_in_z():
    """Its poles and zeros are known to all digits there too: margins as of the sampled loop, in a moment."""
    process = Process([1], [1, 1], 2.7)
    plant = sample(process, 0.1)
    regulator = place(plant, 0.9).regulator
    here, there = DiscreteLoop(plant, regulator).margins(), SampledLoop(process, regulator).margins()
    for name in ("gain", "gain_low", "phase", "Ms", "Mt"):
        assert getattr(here, name) == pytest.approx(getattr(there, name), rel=1e-9), name
