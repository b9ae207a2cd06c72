"""Kept forms are what the derivations give, and nothing but that is ever answered."""

import subprocess
import sys

import pytest

from loopbook.printed import store


@pytest.mark.long
def test_what_is_kept_is_what_the_derivations_give():
    assert store.FILE.read_text(encoding="utf-8") == store.forms_text(), "make printed"


def test_what_is_older_than_its_sources_is_not_believed(monkeypatch):
    from loopbook.identification import models

    store.kept.cache_clear()
    monkeypatch.setattr(store, "sources", lambda: "changed since")
    try:
        assert store.kept() == {}
        asked = store.kept_for(("first_order",))(models._text.__wrapped__)
        assert "exp" in asked("first_order")
    finally:
        store.kept.cache_clear()


def test_a_byte_of_a_derivation_counts(tmp_path, monkeypatch):
    before = store.sources()
    (tmp_path / "one.py").write_text("x = 1\n")
    monkeypatch.setattr(store, "DERIVATIONS", tmp_path)
    one = store.sources()
    (tmp_path / "one.py").write_text("x = 2\n")
    assert len({before, one, store.sources()}) == 3


def test_a_design_needs_no_sympy(tmp_path):
    model = tmp_path / "model.toml"
    model.write_text("[process]\ngain = 2.0\ntime_constants = [10.0, 4.0]\ndelay = 3.0\n")
    code = (
        "import sys\nfrom loopbook.design.study import Study\nfrom loopbook.design import page\n"
        f"study = Study({str(model)!r})\nstudy.results(), page.entered(study), page.switched_on(study)\n"
        "sys.exit('sympy' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=60, check=False).returncode == 0
