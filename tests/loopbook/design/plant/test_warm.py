"""What a process derives before its first design: afterwards the caches of the functions hold it."""

import importlib

import pytest

from loopbook.design import ready
from loopbook.design.plant import warm

pytestmark = [pytest.mark.builds, pytest.mark.long]


def test_importing_it_derives(monkeypatch):
    derived = []
    monkeypatch.setattr(ready, "derive", lambda: derived.append(True))
    importlib.reload(warm)
    assert derived == [True]
