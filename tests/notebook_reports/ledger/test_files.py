"""The ledger's files: sorted, stable, and no verdict or printed digit moves in them unseen."""

import pytest

from notebook_reports.build import judge
from notebook_reports.ledger import files as ledger_files
from notebook_reports.ledger import harvest
from notebook_reports.ledger.printed_data import PrintedDocument, Value
from notebook_reports.ledger.row import LedgerRow
from notebook_reports.memory import stamps
from notebook_reports.project.project import Notebook

FIELDS = {
    "quantity": "rise time",
    "printed": "3.66",
    "unit": "s",
    "kind": "computed",
    "exact": "3.6634812345678",
    "from_inputs": "",
    "reason": "",
}


def found(id="rise", verdict="reproduced", table="value", notebook="a/b", place="Table 5", **fields):
    told = {**FIELDS, **fields}
    return LedgerRow(table, "double-tank", place, id, verdict, told, notebook, 7, "table-5", "Results")


def test_rows_are_sorted_as_a_person_counts():
    new = [found("q10", place="Table 10"), found("q2", place="Table 2"), found("q10"), found("q9")]
    made, _ = ledger_files.compare("value", [], new)
    assert [(r.place, r.id) for r in made] == [
        ("Table 2", "q2"),
        ("Table 5", "q9"),
        ("Table 5", "q10"),
        ("Table 10", "q10"),
    ]


def test_a_file_is_read_as_it_was_written(tmp_path):
    content = [found(reason='a "quoted", reason\nin two lines with å and ł'), found("other")]
    path = tmp_path / "ledger.csv"
    path.write_bytes(ledger_files.render("value", content))
    kept = ledger_files.read(path, "value")
    assert [r.columns() for r in kept] == [r.columns() for r in content]
    assert kept[0].fields["reason"] == 'a "quoted", reason in two lines with å and ł'
    assert path.read_text().splitlines()[0] == (
        "document,place,id,quantity,printed,unit,kind,exact,from_inputs,quoted,first,verdict,reason,notebook"
    )


@pytest.mark.parametrize(
    ("change", "moved", "what"),
    [
        ({"verdict": "differs"}, True, "verdict reproduced -> differs"),
        ({"printed": "3.67"}, True, "printed 3.66 -> 3.67"),
        ({"reason": "because"}, False, "reason (nothing) -> because"),
        ({"exact": "3.6634812"}, False, "exact 3.6634812345678 -> 3.6634812"),
    ],
)
def test_what_moved_and_what_only_changed(change, moved, what):
    _, changes = ledger_files.compare("value", [found()], [found(**change)])
    assert [(c.moved, c.what) for c in changes] == [(moved, what)]


def test_the_last_bits_of_another_machine_are_no_change():
    old = [found()]
    kept, changes = ledger_files.compare("value", old, [found(exact="3.6634812345680001")])
    assert kept == old and changes == []


def test_new_rows_and_rows_that_went():
    kept, changes = ledger_files.compare("value", [found("old")], [found("new")])
    assert [(c.row.id, c.what, c.moved) for c in changes] == [
        ("new", "new, reproduced", False),
        ("old", "gone, was reproduced", True),
    ]
    assert [r.id for r in kept] == ["new"]


def test_a_part_replaces_the_rows_of_its_notebooks_only():
    old = [found("a", notebook="x/1"), found("b", notebook="x/2"), found("c", notebook="x/1")]
    merged = ledger_files.merge(old, [found("a", "differs", notebook="x/1")], ["x/1"])
    assert sorted((r.id, r.verdict) for r in merged) == [("a", "differs"), ("b", "reproduced")]


def test_a_failing_check_names_cell_place_printed_computed_and_command():
    (failure,) = harvest.failing([found(verdict="unexplained", printed="3.70", from_inputs="3.702"), found("fine")])
    assert failure.line == (
        "a/b, cell 7: double-tank, Table 5, rise time (rise): document prints 3.70, computed 3.6634812"
    )
    assert failure.more[0] == "from the document's own rounded inputs: 3.702"
    assert failure.repeat == "loopbook build a/b"


def test_checked_twice_and_not_at_all():
    (twice,) = harvest.repeated([found(), found(notebook="a/c")])
    assert "value rise is checked again in a/c, cell 7" in twice.what
    values = {i: Value("double-tank", "Table 5", i, i, "1") for i in ("rise", "settling", "overshoot")}
    (missing,) = harvest.missing([found()], [PrintedDocument("double-tank", values, {}, {})])
    assert missing.what == "double-tank, Table 5: no notebook checks value settling, overshoot"


@pytest.fixture
def judged(bench):
    """A function that judges given records as the only ones of a whole project, and says what failed."""

    def run(*records, complete=True, **options):
        notebook = Notebook("a/b", bench.write("a/b", "# T"))
        data = [r.data() for r in records]
        executed, kept = stamps.keep(bench.project, notebook, b"{}", data)
        stamps.save(bench.project, notebook, stamps.Stamp({}, [], executed, "", "T", 1.0, {}, kept, []))
        bench.remembered = lambda: judge.remembered(bench.project, [notebook], f"{complete} {False}")
        return judge.judge(bench.project, [notebook], complete, **options)

    return run


def test_a_moved_verdict_fails_until_it_is_accepted(bench, judged):
    assert judged(found()).failures == []
    path = bench.root / "reports/ledger.csv"
    before = path.read_bytes()
    for _ in range(2):  # it does not wear off
        (failure,) = judged(found(verdict="differs", reason="why")).failures
        assert "reports/ledger.csv: double-tank, Table 5, rise: verdict reproduced -> differs" in failure.what
        assert "loopbook build --accept" in failure.more[0]
        assert path.read_bytes() == before
    assert bench.remembered().failures == [failure]
    assert judged(found(verdict="differs", reason="why"), accept=True).failures == []
    assert b"differs" in path.read_bytes()
    assert judged(found(verdict="differs", reason="why")).failures == []


def test_frozen_writes_nothing_and_fails_for_any_difference(bench, judged):
    judged(found())
    path = bench.root / "reports/ledger.csv"
    before = path.read_bytes()
    (failure,) = judged(found(), found("new"), frozen=True).failures
    assert "new: new, reproduced" in failure.what and path.read_bytes() == before
    assert judged(found(), frozen=True).failures == []


def test_a_failing_check_is_said_once_and_leaves_its_row_as_it_was(bench, judged):
    judged(found())
    before = (bench.root / "reports/ledger.csv").read_bytes()
    failing = found(verdict="unexplained"), found("new", "unexplained")
    assert [f.kind for f in judged(*failing).failures] == ["check", "check"]
    assert (bench.root / "reports/ledger.csv").read_bytes() == before


def test_what_is_printed_and_not_checked_fails_by_place(bench, judged):
    folder = bench.root / "documents/double_tank/printed"
    folder.mkdir(parents=True)
    head = 'document = "double-tank"\nplace = "Table 5"\n'
    entries = "".join(f'[[value]]\nid = "{i}"\nquantity = "{i}"\nprinted = "1"\n' for i in ("rise", "settling"))
    (folder / "table_5.toml").write_text(head + entries)
    (failure,) = judged(found()).failures
    assert failure.what == "double-tank, Table 5: no notebook checks value settling"
    assert judged(found(), complete=False).failures == []
    (folder / "table_5.toml").write_text(head + "[[value]]\n")
    (failure,) = judged(found()).failures
    assert "table_5.toml, value (without id): printed = None must be a string" in failure.what


@pytest.mark.builds
def test_the_build_harvests_what_cells_leave(bench):
    bench.write("a/b", "# T", "## Results", bench.record("rise"), bench.record("slow", "unexplained", exact="2"))
    outcome = bench.build()
    assert outcome.code == 1
    assert "a/b, cell 4: double-tank, Table 5, slow (slow): document prints 1.0, computed 2" in bench.said
    assert "ok    a/b" in bench.said and "2 values" in bench.said
    assert ledger_files.read(bench.root / "reports/ledger.csv", "value")[0].notebook == "a/b"
    assert bench.build().code == 1 and bench.exported == []  # remembered, not run again
    assert "cell 4" in bench.said
    (record, _) = stamps.records(bench.project, bench.project.notebooks()[0])
    assert (record["cell"], record["section"]) == (3, "Results")


def test_a_long_integer_is_the_same_only_digit_by_digit():
    one, other, rounded = "2361183241434822606848", "2361183241434822606849", "2.3611832414348226e+21"
    for old, new in ((one, other), (rounded, one)):
        (row,), _ = ledger_files.compare("value", [found(exact=old)], [found(exact=new)])
        assert row.fields["exact"] == new
