"""The glossary holds every variable of Tables 3.1, 4.1 and 5.1, once, and refuses a broken file."""

import pytest

from loopbook.documents.open import GLOSSARY, glossary, variables
from notebook_reports.ledger.glossary import terms

TABLES = {
    "3.1": {"y", "u", "y_{sp}", "e"},
    "4.1": {
        *("u", "v", "u_{low}", "u_{high}", "K", "b", "y_{sp}", "y", "T_i", "T_t", "e", "T_d", "y_f", "h"),
        *("P", "I", "t_k", "t", "D", "T_f", "y_{fold}", "D_f"),
    },
    "5.1": {"u_{low}", "u_{high}", "y_{sp}", "T_t", "h", r"T_{analog\ f}", "T_f", "K", "T_i", "T_d", "b"},
}


@pytest.mark.parametrize("table", TABLES)
def test_each_variable_of_a_table(table):
    symbols = {term.symbol.split(",")[0].strip("$ ") for term in variables(table)}
    assert symbols == TABLES[table]


WITHOUT_A_WORD = {"filtered measurement of the sample before", "tracking time constant", "sampling instant"}


def test_every_term_has_a_second_language_but_three_that_the_report_calls_by_their_symbol():
    alone = {term.en for term in terms(GLOSSARY) if not (term.sv or term.pl)}
    assert alone == WITHOUT_A_WORD
    assert all(term.symbol and term.tables for term in terms(GLOSSARY) if term.en in alone)


def test_every_variable_of_a_table_has_symbol_unit_and_the_words_of_the_report():
    for term in terms(GLOSSARY):
        if term.tables:
            assert term.symbol.startswith("$") and term.unit, term.en
            assert term.sv or term.en in WITHOUT_A_WORD, term.en


def test_the_table_shows_letters_of_both_languages():
    rows = [cell for row in glossary().rows for cell in row]
    assert any("ö" in cell for cell in rows)
    assert any("ł" in cell for cell in rows)
    assert glossary("3.1").caption == "The variables of Table 3.1 of pid-report"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('term = [{ en = "a" }, { en = "a" }]', "a stands twice"),
        ('term = [{ sv = "a" }]', "term 1: no English term"),
        ('term = [{ en = "a", de = "b" }]', r"term 1: \['de'\]"),
    ],
)
def test_a_broken_file_is_refused(tmp_path, text, message):
    path = tmp_path / "glossary.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(ValueError, match=message):
        terms(path)


def test_unknown_table():
    with pytest.raises(ValueError, match="no variables for table '9'"):
        variables("9")
