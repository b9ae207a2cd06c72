"""A report is built again when something it depends on changed, and the line says what; else nothing is done."""

import importlib.util
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from notebook_reports.memory import fingerprint
from notebook_reports.project.project import EnvironmentProblem, UsageError

pytestmark = pytest.mark.builds

TITLE = "# A notebook"


@pytest.fixture
def two(bench):
    """Two notebooks: one uses a module through another and reads a table; one uses nothing."""
    bench.module("springs.py", "from constants import G\n\ndef force(x):\n    return G * x\n")
    bench.module("constants.py", "G = 2\n")
    bench.module("lazy.py", "VALUE = 1\n")
    bench.module("unused.py", "VALUE = 1\n")
    (bench.root / "data").mkdir()
    (bench.root / "data" / "a.txt").write_text("1")
    read = (
        "from pathlib import Path\ndata = Path('../../data').resolve()\n"
        "[p.read_text() for p in sorted(data.glob('*.txt'))]"
    )
    bench.write("a/uses", TITLE, "import springs\nsprings.force(3)", "def late():\n    import lazy\nlate()", read)
    bench.write("a/alone", TITLE, "1 + 1")
    assert bench.build().code == 0
    return bench


def lines(bench):
    return [line for line in bench.said.splitlines() if line.startswith("ok")]


def test_a_number_changed_within_the_second_of_its_compilation_counts(two):
    source = two.root / "src/constants.py"
    compiled = Path(importlib.util.cache_from_source(source))
    second = source.stat().st_mtime_ns // 10**9 * 10**9
    for path, nanoseconds in ((source, 1), (compiled, 2)):
        os.utime(path, ns=(second + nanoseconds, second + nanoseconds))
    same_length = source.read_text().replace("2", "5")
    source.write_text(same_length)
    os.utime(source, ns=(second + 3, second + 3))
    two.build()
    assert two.executed("a/uses")["cells"][1]["outputs"][0]["data"]["text/plain"] == "15"


def test_rebuilds_exactly_what_depends_on_it_and_says_why(two):
    assert two.build().code == 0
    assert two.said == "2 notebooks up to date\n" and two.exported == []

    (two.root / "src/constants.py").write_text("G = 5\n")
    two.build()
    assert two.exported == ["a/uses.html"]
    assert "(rebuilt: src/constants.py)" in lines(two)[0] and "1 notebook up to date" in two.said
    assert two.executed("a/uses")["cells"][1]["outputs"][0]["data"]["text/plain"] == "15"

    (two.root / "src/lazy.py").write_text("VALUE = 2\n")
    two.build()
    assert "(rebuilt: src/lazy.py)" in two.said

    (two.root / "src/unused.py").write_text("VALUE = 2\n")
    two.build()
    assert two.said == "2 notebooks up to date\n"

    (two.root / "data/a.txt").write_text("2")
    two.build()
    assert two.exported == ["a/uses.html"] and "(rebuilt: data/a.txt)" in two.said

    (two.root / "data/b.txt").write_text("3")
    two.build()
    assert two.exported == ["a/uses.html"] and "(rebuilt: data/)" in two.said

    two.write("a/alone", TITLE, "1 + 2")
    two.build()
    assert two.exported == ["a/alone.html"] and "(rebuilt: its code)" in two.said


def test_a_run_that_writes_no_reports_takes_none_away_and_the_next_build_makes_them_anew(two):
    before = two.reports()
    (two.root / "src/constants.py").write_text("G = 7\n")
    assert two.build(formats=()).code == 0
    assert two.reports() == before
    assert two.build().code == 0
    assert (
        two.exported == ["a/uses.html"]
        and two.executed("a/uses")["cells"][1]["outputs"][0]["data"]["text/plain"] == "21"
    )


def test_a_notebook_saved_while_it_is_built_is_built_as_it_was_and_then_again(bench):
    path = bench.root / "notebooks/a/b.ipynb"
    bench.write("a/b", TITLE, "1 + 1", "import shutil\nshutil.copy('later.json', 'b.ipynb');")
    before = path.read_bytes()
    bench.write("a/b", "# Saved again", "2 + 2")
    path.rename(path.with_name("later.json"))
    path.write_bytes(before)
    assert bench.build().code == 0
    assert len(bench.executed("a/b")["cells"]) == 3
    assert bench.build().code == 0 and "(rebuilt: its code)" in bench.said
    assert [c["source"] for c in bench.executed("a/b")["cells"]] == ["# Saved again", "2 + 2"]


def test_a_module_saved_while_a_notebook_runs_is_not_taken_for_the_one_that_ran(bench):
    bench.module("early.py", "X = 1\n")
    bench.write(
        "a/b", TITLE, "import early\nif early.X == 1:\n    open(early.__file__, 'a').write('X = 2\\n')\nearly.X"
    )
    assert bench.build().code == 0
    assert bench.build().code == 0 and "(rebuilt: src/early.py)" in bench.said
    assert bench.executed("a/b")["cells"][1]["outputs"][0]["data"]["text/plain"] == "2"
    assert bench.build().code == 0 and bench.said == "1 notebook up to date\n"


def test_prose_is_rendered_without_running(two, monkeypatch):
    from notebook_reports.run import run

    monkeypatch.setattr(run, "run_notebook", None)
    two.write("a/alone", "# Another title", "> and a paragraph", "1 + 1")
    assert two.build().code == 0
    assert "a/alone.html" in two.exported and "(exported again: its text)" in two.said
    assert "(exported again: its place in the book)" in two.said, "its neighbour shows its title"
    two.write("a/alone", "# Another title", "> and another paragraph", "1 + 1")
    assert two.build().code == 0 and two.exported == ["a/alone.html"]
    built = two.executed("a/alone")
    assert [c["source"] for c in built["cells"]] == ["# Another title", "> and another paragraph", "1 + 1"]
    assert built["cells"][2]["outputs"][0]["data"]["text/plain"] == "2"


def test_a_template_exports_again_without_running(two, monkeypatch):
    from notebook_reports.run import run

    monkeypatch.setattr(run, "run_notebook", None)
    of_export = fingerprint.of_export
    name = "notebook_reports/export/templates/report.typ.j2"
    monkeypatch.setattr(fingerprint, "of_export", lambda *a: {**of_export(*a), name: "changed"})
    assert two.build().code == 0
    assert sorted(two.exported) == ["a/alone.html", "a/uses.html"]
    assert f"(exported again: {name})" in two.said


def test_what_a_notebook_shows_its_results_with_is_part_of_its_run(bench):
    """How a number is written stands in the outputs: who changes it has to run the notebooks that show one."""
    bench.write("a/table", TITLE, "from notebook_reports.display import Table\nTable(['x'], [[1.5]])")
    assert bench.build().code == 0
    run = json.loads((bench.root / ".cache/stamps/a/table.json").read_text())["run"]
    names = [name for name in run if name.endswith("notebook_reports/display.py")]
    assert len(names) == 1 and run[names[0]]
    assert not any("/export/" in name or "/mathematics/" in name for name in run)


def test_the_environment_rebuilds_all(two, monkeypatch):
    (two.root / "environment.txt").write_text("numpy==2.0\n")
    two.build()
    assert len(lines(two)) == 2 and "(rebuilt: environment.txt)" in two.said
    environment = fingerprint.environment
    monkeypatch.setattr(fingerprint, "environment", lambda p: {**environment(p), "Python": "3.99.0"})
    two.build()
    assert len(lines(two)) == 2 and " -> 3.99.0)" in two.said


def test_a_report_that_is_gone_or_was_changed_is_written_again(two):
    (two.root / "reports/a/alone.html").unlink()
    (two.root / "reports/a/uses.html").write_text("mine now")
    two.build()
    assert "alone.html is not there" in two.said and "uses.html was changed" in two.said
    assert "mine" not in (two.root / "reports/a/uses.html").read_text()


def test_the_cache_can_go_at_any_time(two):
    shutil.rmtree(two.root / ".cache")
    assert two.build().code == 0
    assert len(lines(two)) == 2


def test_a_broken_stamp_is_no_stamp(two):
    (two.root / ".cache/stamps/a/alone.json").write_text('{"run": ')
    assert two.build().code == 0
    assert two.exported == ["a/alone.html"]


def test_a_failure_takes_the_old_report_away_and_the_next_build_recovers(two):
    two.write("a/alone", TITLE, "1 / 0")
    assert two.build().code == 1
    assert two.reports() == ["a/uses.html"]
    assert two.build().code == 1  # not forgotten
    two.write("a/alone", TITLE, "1 + 1")
    assert two.build().code == 0
    assert two.reports() == ["a/alone.html", "a/uses.html"]
    assert not (two.root / ".cache/failures.txt").exists()
    assert not list((two.root / ".cache/failed").rglob("*.ipynb"))


def test_an_export_that_fails_is_a_failure_with_its_cell_and_leaves_no_report(two):
    class Problem(Exception):
        cell = 2

    def exporter(content, format, notebook, title):
        if notebook.id == "a/alone":
            raise Problem("a table wider than the page")
        return b"fine"

    outcome = two.build(force=True, exporter=exporter)
    assert outcome.code == 1
    assert two.reports() == ["a/uses.html"]
    assert "a/alone, cell 2: html: Problem: a table wider than the page" in two.said
    assert two.build().code == 0  # run before, so only exported now
    assert "alone.html is not there" in two.said


def test_other_parameters_leave_the_usual_reports_alone(bench):
    bench.write("a/b", TITLE, ("q: float = 0.5  # [0, 1)\ns: str = ''", "parameters"), "q, s")
    bench.build()
    before = (bench.root / "reports/a/b.html").read_bytes()
    text = "\"; import os; os.abort()\n'''"
    assert bench.build("a/b", parameters=[("q", "0.6"), ("s", text)], formats=("ipynb",)).code == 0
    assert (bench.root / "reports/a/b.html").read_bytes() == before
    (made,) = (bench.root / "reports/custom/a").iterdir()
    assert made.name.startswith("b-q=0.6-s=")
    import json

    cells = json.loads(made.read_text())["cells"]
    assert [c["id"] for c in cells] == ["c1", "c2", "injected-parameters", "c3"]
    assert cells[3]["outputs"][0]["data"]["text/plain"] == repr((0.6, text))
    bench.build()
    assert bench.said == "1 notebook up to date\n"


def test_parameters_need_a_notebook_and_a_known_name(bench):
    bench.write("a/b", TITLE, ("q: float = 0.5", "parameters"), "q")
    with pytest.raises(UsageError, match="-p needs a notebook"):
        bench.build(parameters=[("q", "0.6")])
    with pytest.raises(UsageError, match=r"no parameter 'Q'; did you mean q\?"):
        bench.build("a/b", parameters=[("Q", "0.6")])
    assert not (bench.root / ".cache").exists()  # refused before anything started


def test_names_of_notebooks(bench):
    for id in ("double_tank/03_pole_placement", "double_tank/04_comparison", "pid_report/01_terms"):
        bench.write(id, TITLE)
    chosen = bench.project.select
    assert [n.id for n in chosen(("double_tank/03",))] == ["double_tank/03_pole_placement"]
    assert [n.id for n in chosen(("double_tank",))] == ["double_tank/03_pole_placement", "double_tank/04_comparison"]
    path = bench.root / "notebooks/pid_report/01_terms.ipynb"
    assert [(n.id, n.own) for n in chosen((str(path),))] == [("pid_report/01_terms", True)]
    with pytest.raises(UsageError, match=r"no notebook 'double_tank/03_pole_placment'; did you mean double_tank/03"):
        chosen(("double_tank/03_pole_placment",))
    with pytest.raises(UsageError, match=r"no such notebook: elsewhere\.ipynb"):
        chosen(("elsewhere.ipynb",))


def test_a_notebook_from_elsewhere_is_built_beside_itself(bench, tmp_path_factory):
    bench.write("a/b", TITLE)
    folder = tmp_path_factory.mktemp("elsewhere")
    path = folder / "mine.ipynb"
    path.write_bytes(bench.write("a/b", "# Mine", "1 + 1").read_bytes())
    before = path.read_bytes()
    assert bench.build(str(path), formats=("html", "ipynb")).code == 0
    assert sorted(p.name for p in folder.iterdir()) == ["mine.executed.ipynb", "mine.html", "mine.ipynb"]
    assert path.read_bytes() == before
    assert bench.build(str(path), output=folder / "out").code == 0
    assert (folder / "out/mine.html").exists()


def test_a_folder_that_cannot_be_written(bench):
    bench.write("a/b", TITLE, "1")
    (bench.root / "taken").write_text("a file, not a folder")
    with pytest.raises(EnvironmentProblem, match=r"cannot write .*taken"):
        bench.build("a/b", output=bench.root / "taken")


def test_not_a_notebook(bench):
    bench.write("a/good", TITLE, "1")
    (bench.root / "notebooks/a/bad.ipynb").write_text("not json")
    outcome = bench.build()
    assert outcome.code == 1 and bench.reports() == ["a/good.html"]
    assert "cannot be read as a notebook" in bench.said


def test_nothing_slow_is_imported_where_nothing_is_to_be_done(bench):
    bench.write("a/b", TITLE, "1")
    assert bench.build(formats=("ipynb",)).code == 0
    check = (
        "import sys\nfrom loopbook.cli import main\n"
        "try:\n    main()\nexcept SystemExit as done:\n    assert not done.code, done.code\n"
        "slow = {'papermill', 'nbclient', 'nbformat', 'nbconvert', 'jupyter_client', 'numpy', 'sympy', 'tqdm'}\n"
        "print(sorted(slow & set(sys.modules)))"
    )
    command = [sys.executable, "-c", check, "--root", str(bench.root), "build", "--format", "ipynb"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.stdout == "1 notebook up to date\n[]\n", done.stderr


def test_a_report_written_again_has_the_bytes_of_the_first(bench):
    unsorted = "from IPython.display import JSON\nJSON({'b': 1, 'a': {'d': 2, 'c': 3}})"
    bench.write("a/one", TITLE, unsorted)
    as_given = lambda content, *about: json.dumps(content).encode()  # noqa: E731
    report = bench.root / "reports" / "a" / "one.html"
    bench.build(exporter=as_given)
    first = report.read_bytes()
    report.unlink()
    bench.build(exporter=as_given)
    assert report.read_bytes() == first and "exported again" in bench.said
