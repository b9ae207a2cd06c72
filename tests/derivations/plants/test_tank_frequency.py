"""Gain and phase of the tanks are those of their transfer function."""

import cmath

import pytest

from derivations.plants import heated_tanks as tanks

NUMBERS = {tanks.V1: 0.01, tanks.Vr: 0.004, tanks.V2: 0.014, tanks.Q: 0.002, tanks.c: 4180.0, tanks.rho: 1000.0}


@pytest.mark.parametrize("source", [tanks.U, tanks.V])
@pytest.mark.parametrize("w", [0.01, 0.2, 1.0])
def test_gain_and_phase_make_the_number(source, w):
    gain, phase = (float(x.subs(NUMBERS).subs(tanks.w, w)) for x in tanks.gain_and_phase(source))
    value = complex(tanks.path(source).subs(NUMBERS).subs(tanks.s, 1j * w).evalf())
    assert gain * cmath.exp(1j * phase) == pytest.approx(value, rel=1e-12)
