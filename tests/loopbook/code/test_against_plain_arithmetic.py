"""The emitted program in fractions against the textbook's controller in fractions: not one number may differ."""

from fractions import Fraction
from random import Random

import pytest
from plain_pid import PlainPid

from loopbook.code import pid_block
from loopbook.code.running import controller

NAMES = ("K", "Ti", "Td", "Tf", "b", "c", "Tt", "h", "u_low", "u_high", "rate")


def some_settings(draw: Random) -> dict[str, Fraction]:
    """Settings whose filter is a dyadic fraction, so that the numbers stay short."""
    h = Fraction(draw.choice([1, 2]), draw.choice([1, 2, 4]))
    pick = {
        "K": Fraction(draw.choice([-3, -1, 1, 2, 5]), draw.choice([1, 2, 4])),
        "Ti": h * draw.choice([0, 1, 4, 16]),
        "Td": h * draw.choice([0, 1, 3]),
        "Tf": h * draw.choice([0, 1, 3]),
        "b": Fraction(draw.choice([0, 1, 2]), 2),
        "c": Fraction(draw.choice([0, 0, 1, 2]), 2),
        "Tt": h * draw.choice([0, 1, 2, 8]),
        "h": h,
        "u_low": Fraction(-draw.choice([2, 20])),
        "u_high": Fraction(draw.choice([3, 30])),
        "rate": Fraction(draw.choice([0, 0, 1, 8])),
    }
    return {name: pick[name] for name in NAMES}


@pytest.mark.parametrize("seed", range(60))
def test_the_emitted_program_is_the_textbooks_controller(seed):
    draw = Random(seed)
    settings = some_settings(draw)
    emitted = controller(pid_block(K=1.0, Ti=1.0, h=1.0), Fraction, **settings)
    plain = PlainPid(**settings)
    y = sp = ff = Fraction(0)
    for _ in range(150):
        y += Fraction(draw.randint(-8, 8), 8)
        if draw.random() < 0.05:
            sp, ff = Fraction(draw.randint(-10, 10)), Fraction(draw.randint(-2, 2))
        event = draw.random()
        if event < 0.02:
            emitted.reset()
            plain.reset()
        elif event < 0.05:
            u = Fraction(draw.randint(-25, 35))
            emitted.start(y, sp, u, ff)
            plain.start(y, sp, u, ff)
        elif event < 0.12:
            on, u = draw.random() < 0.6, Fraction(draw.randint(-25, 35))
            emitted.manual(on, u)
            plain.set_manual(on, u)
        elif event < 0.17:
            settings = some_settings(draw)
            assert emitted.change(*settings.values())
            plain.change(**settings)
        assert emitted.step(sp, y, ff) == plain.step(sp, y, ff)
        assert (emitted.I, emitted.v, emitted.e) == (plain.I, plain.v, plain.e)
