"""References resolved against what the numbered things show; a reference to nothing leads to nothing."""

import pytest

from loopbook.documents.open import printed
from loopbook.documents.references import label, resolves, stands_for, transcribed


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("see figure 3.12", ("figure", "3.12")),
        ("Figure 4.6 shows", ("figure", "4.6")),
        ("F3.10 for v", ("figure", "3.10")),
        ("equation 4.14, x", ("equation", "4.14")),
        ("4.20 for v", None),
        ("E.13", None),
        ("[5, 264]", None),
    ],
)
def test_the_first_label_of_a_text(text, found):
    assert label(text) == found


def test_an_unknown_figure_is_nothing():
    assert stands_for("pid-report", "figure 9.9") == ""


def test_every_figure_is_told_apart_from_the_others():
    figures = transcribed("pid-report")["figure"]
    assert len(set(figures.values())) == len(figures) >= 20


def test_a_reference_that_is_corrected_to_itself_proves_nothing(monkeypatch):
    item = printed("pid-report").misprints["chord-figure"]
    for text, outcome in ((item.corrected, (True, True)), ("in figure 3.1", (False, True))):
        monkeypatch.setitem(printed("pid-report").misprints, item.id, type(item)(**{**vars(item), "printed": text}))
        assert resolves("pid-report", "chord-figure", "points A and B") == outcome
