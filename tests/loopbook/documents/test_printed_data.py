"""The transcribed data: malformed files are refused by name, and the real ones all load."""

import pytest

from loopbook.documents.open import FOLDER, names
from loopbook.documents.open import printed as of
from notebook_reports.ledger import printed_data as printed
from notebook_reports.ledger.printed_data import PrintedDataError, load

GOOD = 'document = "double-tank"\nplace = "Table 5"\n'
VALUE = '[[value]]\nid = "a"\nquantity = "rise"\nprinted = "3.66"\n'


def loaded(tmp_path, text, name="table_5.toml"):
    folder = tmp_path / "double_tank" / "printed"
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_text(text, encoding="utf-8")
    return load("double-tank", tmp_path)


def test_a_value_is_read_as_printed(tmp_path):
    value = loaded(tmp_path, GOOD + VALUE).values["a"]
    assert (value.printed, value.place, value.kind) == ("3.66", "Table 5", "computed")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (GOOD, "holds no value, claim or misprint"),
        (GOOD + "x = 1\n" + VALUE, "unknown key"),
        ('document = "other"\n' + VALUE, "document = 'other' in folder double_tank"),
        (GOOD + VALUE.replace('"3.66"', "3.66"), "value a: printed = 3.66 must be a string"),
        (GOOD + VALUE.replace("3.66", "3,66"), "value a: printed = '3,66' is not a number"),
        (GOOD + VALUE + 'kind = "guessed"\n', "value a: kind = 'guessed'; one of"),
        (GOOD + VALUE + 'corrected = "3.67"\n', "value a: a corrected value needs a reason"),
        (GOOD + VALUE + 'unti = "s"\n', "value a: unknown key"),
        ('document = "double-tank"\n' + VALUE, "value a: place is missing"),
        (GOOD + VALUE + VALUE, "value a stands twice in double-tank"),
        (GOOD + '[[misprint]]\nid = "m"\nkind = "typo"\n', "misprint m: kind = 'typo'; one of"),
        (GOOD + '[[claim]]\nid = "c"\n', "claim c: missing 1 required positional argument"),
        (GOOD + "[[value\n", "table_5.toml: "),
    ],
)
def test_malformed_data_is_refused_by_name(tmp_path, text, message):
    with pytest.raises(PrintedDataError) as error:
        loaded(tmp_path, text)
    assert message in str(error.value) and "table_5.toml" in str(error.value)


def test_an_unknown_document_is_refused():
    with pytest.raises(PrintedDataError, match=f"one of {', '.join(names())}$"):
        load("pid-book", FOLDER)


@pytest.mark.parametrize("document", names())
def test_each_document_holds_values(document):
    data = of(document)
    assert data.values
    assert {v.kind for v in data.values.values()} <= set(printed.VALUE_KINDS)


def test_every_data_file_belongs_to_a_document():
    files = sorted(set(FOLDER.rglob("*.toml")) - {FOLDER / "glossary.toml", *FOLDER.glob("*/cited.toml")})
    assert len(files) > 30
    assert {f.parent.parent for f in files} == {FOLDER / name.replace("-", "_") for name in names()}
    assert {f.parent.name for f in files} == {"printed"}
