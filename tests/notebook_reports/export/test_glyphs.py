"""Characters that no font has: remembered once found, and named in their place."""

import pytest

from notebook_reports.export.write import glyphs


@pytest.fixture(autouse=True)
def nothing_known(monkeypatch):
    monkeypatch.setattr(glyphs, "ABSENT", {})


def test_what_a_font_has_is_not_suspected_beside_what_none_has():
    assert glyphs.note_absent("α and 水, 水") and list(glyphs.ABSENT) == ["水"]
    assert not glyphs.note_absent("水"), "known already"


def test_names_stand_where_the_characters_stood():
    glyphs.note_absent("🎉水")
    assert glyphs.without_absent("a 🎉 b 水") == "a ‹party popper› b ‹U+6C34›"
    assert glyphs.without_absent("a 水", "?") == "a ?" and glyphs.without_absent("あ") == "あ"
    assert glyphs.latex_without_absent("x_{水}") == r"x_{\text{‹U+6C34›}}"
