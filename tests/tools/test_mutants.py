"""The harness that breaks the project can report survivors, and what it alters is noticed; whole in `make mutants`."""

import re
from pathlib import Path

import mutants
import pytest
from mutations import altered, claim_mutants, input_mutants, value_mutants

ROOT = Path(__file__).parents[2]
NOTEBOOK = "double_tank/01_model"


@pytest.fixture(scope="module")
def seeing(tmp_path_factory):
    return mutants.Copy(tmp_path_factory.mktemp("seeing") / "copy").make()


@pytest.fixture(scope="module")
def blind(tmp_path_factory):
    return mutants.Copy(tmp_path_factory.mktemp("blind") / "copy", off=True).make()


def of(made, *ids):
    found = [m for m in made(ROOT) if m.names[0] in ids and m.notebooks and m.notebooks[0] == NOTEBOOK]
    assert found, ids
    return found[0]


@pytest.mark.builds
@pytest.mark.parametrize("id", ["power-for-one-kelvin"])
def test_a_printed_digit_alone_turns_its_check_red(seeing, blind, id):
    mutant = of(value_mutants, id)
    assert mutants.fate(seeing, mutant).by == "check"
    assert mutants.fate(blind, mutant).by in ("", "nothing determines it"), "the harness sees what is not there"


@pytest.mark.builds
@pytest.mark.parametrize("id", ["heating-gain"])
def test_a_word_of_a_statement_alone_moves_its_verdict(seeing, blind, id):
    mutant = of(claim_mutants, id)
    found = mutants.fate(seeing, mutant)
    assert found.by == "check" and found.named
    assert mutants.fate(blind, mutant).by in ("", "evidence")


@pytest.mark.builds
def test_a_literal_of_a_computation_alone_moves_what_is_computed(seeing):
    found = [m for m in input_mutants(ROOT) if m.notebooks == (NOTEBOOK,) and "measured: 1 ->" in m.what]
    assert found and mutants.fate(seeing, found[0]).by == "check"


def test_words_that_no_test_reads_are_survivors(seeing):
    mutant = next((m for m in claim_mutants(ROOT) if not m.notebooks), None)
    if mutant is None:
        pytest.skip("some test reads every word")
    assert mutants.fate(seeing, mutant).by == ""


def test_a_copy_is_left_as_it_was_and_has_no_committed_ledger(seeing):
    assert not (seeing.folder / "reports").exists()
    for path in (seeing.folder / "src/loopbook/documents").glob("*/printed/*.toml"):
        assert path.read_bytes() == (ROOT / path.relative_to(seeing.folder)).read_bytes()


def test_every_printed_number_has_a_mutant_and_no_two_are_one():
    made = list(value_mutants(ROOT))
    rows = (ROOT / "reports" / "ledger.csv").read_text(encoding="utf-8").count("\n") - 1
    assert len(made) >= 0.99 * rows and len({(m.file, m.start) for m in made}) == len(made)
    for mutant in made:
        text = (ROOT / mutant.file).read_text(encoding="utf-8")[mutant.start : mutant.end]
        assert re.fullmatch(r"[-+\d.e]+", text) and altered(text) == mutant.text != text
