"""A sentence and its test read the same fields: changing the one changes the other."""

import pytest

from notebook_reports.ledger import printed_data
from notebook_reports.ledger.printed_data import Claim, PrintedDataError
from notebook_reports.ledger.words import WordsError, told


@pytest.mark.parametrize(
    ("says", "fields", "expected"),
    [
        ("nothing in it", {}, "nothing in it"),
        ("$T_{63}$ and ${a}$", {"a": "1/(s+1)"}, "$T_{63}$ and $1/(s+1)$"),
        ("it {d:rises|falls}", {"d": "up"}, "it rises"),
        ("it {d:rises|falls}", {"d": "down"}, "it falls"),
        ("\\frac{a}{b}", {}, "\\frac{a}{b}"),
    ],
)
def test_fields_stand_in_the_sentence(says, fields, expected):
    assert told(says, fields) == expected


@pytest.mark.parametrize(
    ("says", "fields", "message"),
    [
        ("it falls", {"d": "down"}, "does not use its field d"),
        ("it {d:rises|falls}", {}, "needs a field d"),
        ("it {d:rises|falls}", {"d": "sideways"}, "'sideways'; a direction is 'up' or 'down'"),
    ],
)
def test_what_does_not_fit_is_refused(says, fields, message):
    with pytest.raises(WordsError, match=message):
        told(says, fields)


def test_a_claim_reads_its_fields_out_of_the_file(tmp_path):
    folder = tmp_path / "a_b" / "printed"
    folder.mkdir(parents=True)
    entry = '[[claim]]\nid = "c"\nsays = "With {gain} it {way:rises|falls}."\ngain = "2.5"\nway = "down"\n'
    (folder / "x.toml").write_text(f'document = "a-b"\nplace = "p"\n{entry}')
    claim = printed_data.load("a-b", tmp_path).claims["c"]
    assert claim.says == "With 2.5 it falls."
    assert claim.number("gain") * 2 == 5 and claim.agrees("way", -1) and not claim.agrees("way", 0)
    with pytest.raises(PrintedDataError, match=r"x.toml, claim c: no field 'gian'; there is gain, way"):
        claim.text("gian")


def test_nothing_that_stays_has_a_direction():
    assert not Claim("a", "b", "c", "", {"d": "up"}).agrees("d", 0)
    assert not Claim("a", "b", "c", "", {"d": "down"}).agrees("d", 0)
