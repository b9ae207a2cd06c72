"""A seeded share of the plants that `make prove-identification` makes: one of each kind, its truth in the intervals."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent / "acceptance"))
from plants import KINDS, make
from prove_identification import judge, shares

pytestmark = pytest.mark.long


@pytest.mark.parametrize("kind", KINDS)
def test_one_plant_of_each_kind_is_identified(kind):
    outcome = judge(kind, 2)
    assert set(outcome.held) >= set(outcome.case.truth) and sum(outcome.held.values()) >= len(outcome.held) - 1, outcome


def test_a_refusal_and_another_structure_count_as_a_miss(monkeypatch):
    flat = make("first", 0)
    flat.records = [(t, u, 0 * y) for t, u, y in flat.records]
    monkeypatch.setattr("prove_identification.make", lambda kind, seed: flat)
    refused = judge("first", 0)
    assert not any(refused.held.values()) and refused.said.startswith("refused")
    ramp = make("integrating", 1)
    ramp.structure = "first order"
    monkeypatch.setattr("prove_identification.make", lambda kind, seed: ramp)
    assert shares([judge("integrating", 1), refused]) == {"Kv": 0.0, "L": 0.0, "Kp": 0.0, "T": 0.0}
