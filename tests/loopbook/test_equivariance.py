"""The same loop in other units of time, of y and of u gives the same answers, to a relative 1e-9, refusals included.

A share of what `make prove-scaling` asks of 2,000 seeded loops: stability, margins, peaks, metrics and integrals,
sampled models and their margins of each, every tuning rule of some.
"""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent / "scaling"))
from answers import ASKED, compare, of_tuning

pytestmark = pytest.mark.long

LOOPS, CHUNK, TUNED = 150, 10, 6


@pytest.mark.parametrize("first", range(0, LOOPS, CHUNK))
def test_the_same_answers_in_every_unit(first):
    quick = [question for question in ASKED if question is not of_tuning]
    found = [compare(seed, ASKED if seed % TUNED == 0 else quick) for seed in range(first, first + CHUNK)]
    assert not [line for each in found for line in each.differences]
    assert sum(each.border for each in found) <= 1 and sum(each.stable for each in found) >= 2


def test_a_difference_is_seen(monkeypatch):
    """An absolute tolerance, as they were: a dead time below a millisecond forgotten."""
    from loopbook.loop.transfer import LoopTransfer

    whole = LoopTransfer.__post_init__

    def forgetful(self):
        object.__setattr__(self, "delay", self.delay if self.delay > 1e-3 else 0.0)
        whole(self)

    monkeypatch.setattr(LoopTransfer, "__post_init__", forgetful)
    assert any(compare(seed).differences for seed in range(20))
