"""One notebook on files of the reader's own: a report each, errors before a kernel starts, no ledger."""

import io
import json

import pytest

from notebook_reports.build.apply import apply, items
from notebook_reports.project.console import Console
from notebook_reports.project.project import UsageError

pytestmark = pytest.mark.builds

READS = "value = float(open(data).read())\nassert value > 0, f'{data} holds {value}'\nvalue"


@pytest.fixture
def reader(bench):
    return bench.write("own/reader", "# Reads", ('data: str = "none"', "parameters"), READS)


def run(bench, notebook, wanted, parameters=()):
    out = io.StringIO()
    return apply(bench.project, notebook, wanted, parameters, console=Console(out)), out.getvalue()


def test_each_file_gets_its_run_beside_it(bench, reader, tmp_path):
    files = [tmp_path / "a.csv", tmp_path / "b.csv"]
    for number, file in enumerate(files, 1):
        file.write_text(f"{number}.5")
    outcome, said = run(bench, reader, items(files, None, "design", ["ipynb"]))
    assert outcome.code == 0 and "ok    a" in said and "ok    b" in said
    for number, file in enumerate(files, 1):
        report = tmp_path / f"{file.stem}-design.ipynb"
        text = report.read_text(encoding="utf-8")
        assert f"{number}.5" in text and str(tmp_path) not in text
        sources = ["".join(c["source"]) for c in json.loads(text)["cells"]]
        assert any("data = " in source and file.name in source for source in sources)
    assert not (bench.root / "reports").exists()


def test_one_bad_file_fails_alone_and_is_named(bench, reader, tmp_path):
    good, bad = tmp_path / "good.csv", tmp_path / "bad.csv"
    good.write_text("1")
    bad.write_text("-1")
    outcome, said = run(bench, reader, items([good, bad], tmp_path / "out", "design", ["ipynb"]))
    assert outcome.code == 1 and "bad.csv holds -1.0" in said
    assert f"Repeat: loopbook design {bad}" in said and f"{tmp_path / 'out' / 'good-design.ipynb'}" in said
    assert (tmp_path / "out" / "good-design.ipynb").exists() and not (tmp_path / "out" / "bad-design.ipynb").exists()


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_many_files_show_progress_and_end_with_the_folder_and_every_failure(bench, reader, tmp_path, capsys):
    files = [tmp_path / f"r{n:02}.csv" for n in range(12)]
    for n, file in enumerate(files):
        file.write_text("nothing" if n in (3, 8) else f"{n}.25")
    out = Terminal()
    wanted = items(files, tmp_path / "out", "design", ["ipynb"])
    outcome = apply(bench.project, reader, wanted, [], jobs=2, console=Console(out))
    assert outcome.code == 1 and len(outcome.done) == 12
    made = {path.name for path in (tmp_path / "out").iterdir()}
    assert made == {f"r{n:02}-design.ipynb" for n in range(12) if n not in (3, 8)}
    said = out.getvalue()
    assert f"10 reports in {tmp_path / 'out'}" in said and "2 failed:" in said
    assert said.count("ok    r") == 10 and said.count("FAIL  r") == 2
    last = said[said.index("2 failed:") :]
    assert "r03, cell 3: ValueError" in last and "r08, cell 3: ValueError" in last
    assert f"Repeat: loopbook design {files[3]} {files[8]}" in last
    assert "/12 |" in capsys.readouterr().err


def test_the_command_that_repeats_a_failure_has_its_parameters(bench, tmp_path):
    notebook = bench.write("own/reader", "# Reads", ('data: str = "none"\nlimit: float = 0.0', "parameters"), READS)
    (tmp_path / "bad.csv").write_text("-1")
    _, said = run(bench, notebook, items([tmp_path / "bad.csv"], None, "design", ["ipynb"]), [("limit", "2")])
    assert f"Repeat: loopbook design {tmp_path / 'bad.csv'} -p limit 2" in said


def test_data_that_a_notebook_shows_as_json_is_a_report_of_its_own(bench, reader, tmp_path):
    shows = bench.write(
        "own/shows",
        "# Shows",
        ('data: str = "none"', "parameters"),
        "from IPython.display import JSON",
        "JSON({'K': 0.5})",
    )
    (tmp_path / "a.csv").write_text("1")
    (single,) = items([tmp_path / "a.csv"], tmp_path / "a.json", "design")
    assert run(bench, shows, [single])[0].code == 0
    assert json.loads((tmp_path / "a.json").read_text(encoding="utf-8")) == {"K": 0.5}
    outcome, said = run(bench, reader, [single])
    assert outcome.code == 1 and "json: LookupError: the notebook shows no data as JSON" in said
    assert json.loads((tmp_path / "a.json.old").read_text(encoding="utf-8")) == {"K": 0.5}
    assert f"{tmp_path / 'a.json'} was of an earlier run and is now a.json.old" in said


def test_a_run_that_fails_leaves_no_older_report_in_its_place(bench, reader, tmp_path):
    file, report = tmp_path / "a.csv", tmp_path / "a-design.ipynb"
    file.write_text("-1")
    report.write_text("older")
    outcome, said = run(bench, reader, items([file], None, "design", ["ipynb"]))
    assert outcome.code == 1 and not report.exists() and "was of an earlier run" in said
    assert (tmp_path / "a-design.ipynb.old").read_text() == "older"


def test_code_is_hidden_and_cells_are_left_out(bench, tmp_path):
    shows = bench.write(
        "own/shows",
        "# Shows",
        ('data: str = "none"', "parameters"),
        ("only = 'for programmers'\nonly", "code-only"),
        ("raise RuntimeError('never run')", "detail"),
        "'for everybody'",
    )
    (tmp_path / "a.csv").write_text("1")
    (single,) = items([tmp_path / "a.csv"], tmp_path / "a.html", "design")
    out = io.StringIO()
    how = {"console": Console(out), "leave_out": frozenset({"detail"})}
    assert apply(bench.project, shows, [single], [], code=False, **how).code == 0, out.getvalue()
    page = (tmp_path / "a.html").read_text(encoding="utf-8")
    assert "for everybody" in page and "for programmers" not in page and "data" not in page.partition("<main>")[2]
    assert apply(bench.project, shows, [single], [], **how).code == 0
    assert "for programmers" in (tmp_path / "a.html").read_text(encoding="utf-8")


def test_where_reports_may_go(tmp_path):
    one, two = tmp_path / "one.csv", tmp_path / "two.csv"
    one.touch(), two.touch()
    (single,) = items([one], tmp_path / "r.html", "design")
    assert single.outputs == {"html": (tmp_path / "r.html").resolve()}
    (both,) = items([one], tmp_path / "r.pdf", "design", ["pdf", "json"])
    assert both.outputs == {f: (tmp_path / f"r.{f}").resolve() for f in ("pdf", "json")}
    with pytest.raises(UsageError, match=r"no such file: .*none\.csv"):
        items([tmp_path / "none.csv"], None, "design", ["pdf"])
    with pytest.raises(UsageError, match=r"ends in \.pdf, \.html, \.ipynb or \.json"):
        items([one], tmp_path / "r.docx", "design", ["pdf"])
    with pytest.raises(UsageError, match="unknown format docx; one or more of pdf,html,ipynb,json"):
        items([one], None, "design", ["docx"])
    with pytest.raises(UsageError, match="2 reports are to be made: give a folder"):
        items([one, two], tmp_path / "r.pdf", "design", ["pdf"])
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "one.csv").touch()
    found = items([one, tmp_path / "sub" / "one.csv"], tmp_path / "out", "design")
    assert [i.outputs["pdf"].name for i in found] == [f"{tmp_path.name}-one-design.pdf", "sub-one-design.pdf"]
    (tmp_path / "one.xlsx").touch()
    found = items([one, tmp_path / "one.xlsx", one], None, "design")
    assert [i.outputs["pdf"].name for i in found] == ["one-csv-design.pdf", "one-xlsx-design.pdf"]


def test_a_report_goes_where_a_name_without_ending_or_a_link_leads(tmp_path):
    data = tmp_path / "one.csv"
    data.touch()
    plain = tmp_path / "report"
    plain.touch()
    (single,) = items([data], plain, "design")
    assert single.outputs == {"pdf": plain.resolve()}
    with pytest.raises(UsageError, match="a file without an ending"):
        items([data], plain, "design", ["pdf", "json"])
    with pytest.raises(UsageError, match="give a folder"):
        items([data, tmp_path / "report"], plain, "design")
    link = tmp_path / "latest"
    link.symlink_to(tmp_path / "elsewhere" / "r.pdf")
    (single,) = items([data], link, "design")
    assert single.outputs == {"pdf": (tmp_path / "elsewhere" / "r.pdf").resolve()}
    folder = tmp_path / "x.pdf"
    folder.mkdir()
    (single,) = items([data], folder, "design")
    assert single.outputs == {"pdf": (folder / "one-design.pdf").resolve()}
    gone = tmp_path / "gone.csv"
    gone.symlink_to(tmp_path / "nowhere.csv")
    with pytest.raises(UsageError, match=r"gone\.csv \(a link to .*nowhere\.csv, which is not there\)"):
        items([gone], None, "design")


def test_wrong_parameters_are_refused_before_a_kernel_starts(bench, reader, tmp_path):
    file = tmp_path / "a.csv"
    file.write_text("1")
    with pytest.raises(UsageError, match="no parameter 'dat'"):
        run(bench, reader, items([file], None, "design", ["ipynb"]), [("dat", "x")])
