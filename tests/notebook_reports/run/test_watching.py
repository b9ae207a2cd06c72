"""What a notebook reads is seen and part of its stamp; what is not seen is said, and can be declared."""

import json
import sqlite3

import pytest

pytestmark = pytest.mark.builds

READS = {
    "outside": "open({outside!r}).read()",
    "database": "import sqlite3\nsqlite3.connect({database!r}).execute('select x from t').fetchone()",
    "stat": "import os\nos.stat('../../data/time.txt').st_mtime_ns // 10**9",
    "exists": "from pathlib import Path\nPath('../../data/later.txt').exists()",
    "variable": "import os\nos.environ.get('TRUST_TEST', 'none'), os.getenv('TRUST_OTHER')",
    "access": "import os\nos.access('../../data/later.txt', os.R_OK)",
    "listing": "import os\nsorted(os.listdir('../../data'))",
    "library": "import pandas\npandas.read_csv('../../data/table.csv').a[0]",
    "none": "1 + 1",
}


@pytest.fixture(scope="module")
def readers(shared, tmp_path_factory):
    """One notebook for each way to read, built together."""
    shared.elsewhere = tmp_path_factory.mktemp("elsewhere")
    (shared.elsewhere / "outside.txt").write_text("1")
    with sqlite3.connect(shared.elsewhere / "data.db") as database:
        database.execute("create table t(x)")
        database.execute("insert into t values (1)")
    data = shared.root / "data"
    data.mkdir()
    (data / "time.txt").write_text("1")
    (data / "table.csv").write_text("a\n1\n")
    told = {"outside": str(shared.elsewhere / "outside.txt"), "database": str(shared.elsewhere / "data.db")}
    for name, code in READS.items():
        shared.write(f"a/{name}", "# T", code.format(**told))
    assert shared.build(formats=("ipynb",), jobs=3).code == 0, shared.said
    shared.first = shared.said
    return shared


def test_a_change_of_what_was_read_runs_the_notebook_again_and_no_other(readers, monkeypatch):
    import os

    assert readers.build(formats=("ipynb",)).code == 0
    assert readers.said.splitlines()[0] == f"{len(READS)} notebooks up to date"

    (readers.elsewhere / "outside.txt").write_text("2")
    with sqlite3.connect(readers.elsewhere / "data.db") as database:
        database.execute("update t set x = 2")
    os.utime(readers.root / "data/time.txt", (10, 10))
    (readers.root / "data/later.txt").write_text("")
    (readers.root / "data/table.csv").write_text("a\n2\n")
    monkeypatch.setenv("TRUST_TEST", "another")
    assert readers.build(formats=("ipynb",), jobs=3).code == 0
    said = {line.split()[1].removeprefix("a/"): line for line in readers.said.splitlines() if line.startswith("ok")}
    assert set(said) == set(READS) - {"none"}
    for name, reason in (
        ("outside", "outside.txt"),
        ("database", "data.db"),
        ("stat", "size and time of data/time.txt"),
        ("exists", "data/later.txt"),
        ("variable", "$TRUST_TEST"),
        ("listing", "data/"),
        ("library", "data/table.csv"),
    ):
        assert f"(rebuilt: {reason}" in said[name] or reason in said[name], said[name]


def test_reading_outside_the_project_is_said(readers):
    for name in ("outside.txt", "data.db"):
        assert f"{name}, outside its project: keep it in the project, or name it" in readers.first.replace("\n", " ")
    assert readers.first.count("outside its project") == 2


def test_the_stamp_holds_no_value_of_a_variable(readers, monkeypatch):
    monkeypatch.setenv("TRUST_TEST", "a secret")
    assert readers.build("a/variable", formats=("ipynb",)).code == 0
    stamp = (readers.root / ".cache/stamps/a/variable.json").read_text()
    assert "TRUST_TEST" in stamp and "a secret" not in stamp


def with_inputs(bench, id, inputs, code):
    path = bench.write(id, "# T", code)
    content = json.loads(path.read_text())
    content["metadata"]["loopbook"] = {"inputs": inputs}
    path.write_text(json.dumps(content))


def test_what_another_program_reads_is_not_seen_and_can_be_declared(bench):
    data = bench.root / "data"
    data.mkdir()
    (data / "a.txt").write_text("1")
    bench.write("a/silent", "# T", "!cat ../../data/a.txt")
    with_inputs(bench, "a/tells", ["../../data/", "$TRUST_TEST"], "!cat ../../data/a.txt")
    with_inputs(bench, "a/nothing", [], "!true")
    assert bench.build(formats=("ipynb",), jobs=2).code == 0
    assert "a/silent, cell 2: runs cat ../../data/a.txt: what that reads is not seen" in bench.said
    assert "a/tells, cell" not in bench.said and "a/nothing, cell" not in bench.said
    (data / "a.txt").write_text("2")
    assert bench.build(formats=("ipynb",)).code == 0
    assert "a/tells" in bench.said and "(rebuilt: data/a.txt)" in bench.said and "ok    a/silent" not in bench.said


def test_a_new_declaration_counts_at_once(bench):
    (bench.root / "data.txt").write_text("1")
    bench.write("a/b", "# T", "1")
    bench.build(formats=("ipynb",))
    with_inputs(bench, "a/b", ["../../data.txt"], "1")
    bench.build(formats=("ipynb",))
    assert "(rebuilt: data.txt)" in bench.said


def test_a_file_that_a_notebook_makes_for_itself_is_no_input(bench):
    code = (
        "import tempfile, pathlib\nfolder = pathlib.Path(tempfile.mkdtemp())\n"
        "(folder / 'x').write_text('1')\nopen('made', 'w').write('1')\n"
        "(folder / 'x').read_text() + open('made').read()"
    )
    bench.write("a/b", "# T", code)
    assert bench.build(formats=("ipynb",)).code == 0 and "outside" not in bench.said
    (bench.root / "notebooks/a/made").unlink()
    assert bench.build(formats=("ipynb",)).code == 0 and bench.said == "1 notebook up to date\n"


def test_a_file_read_and_then_written_is_an_input(bench):
    (bench.root / "notebooks" / "a").mkdir(parents=True)
    (bench.root / "notebooks/a/count").write_text("1")
    bench.write("a/b", "# T", "n = int(open('count').read())\nopen('count', 'w').write(str(n + 1))\nn")
    bench.build(formats=("ipynb",))
    assert bench.build(formats=("ipynb",)).code == 0 and "(rebuilt: notebooks/a/count)" in bench.said
