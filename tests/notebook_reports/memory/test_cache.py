"""Nothing in the cache is believed: whatever is done to a file of it, the reports and the ledger come out right."""

import json
import random
import shutil

import pytest

from notebook_reports.memory import kept_fonts, sealed, stamps
from notebook_reports.run import run as runner
from notebook_reports.run.canonical import canonical
from notebook_reports.run.run import Run

pytestmark = pytest.mark.long

IDS = ("a/one", "a/two", "b/three")
REPORTS = ("ledger.csv", *(f"{id}.{format}" for id in IDS for format in ("html", "ipynb")))


def pretend(source, name, project, parameters=None, timeout=600):
    """A run without a kernel: one value in the ledger, one text."""
    record = {"table": "value", "document": "d", "place": "T", "id": name, "verdict": "reproduced"}
    record["fields"] = {"quantity": "q", "printed": "1.0", "unit": "s", "kind": "computed", "exact": f"1.0{len(name)}"}
    data = {"application/vnd.loopbook.checks+json": [record], "text/plain": f"result of {name}"}
    output = {"output_type": "display_data", "metadata": {}, "data": data}
    content = canonical(source.content, project.root, [c.id for c in source.cells])
    for cell in content["cells"]:
        if cell["cell_type"] == "code":
            cell |= {"execution_count": 1, "outputs": [output]}
    return Run(content, 0.1)


@pytest.fixture
def built(bench, monkeypatch):
    """Three notebooks, built; `right` holds what the reports have to be."""
    monkeypatch.setattr(runner, "run_notebook", pretend)
    for id in IDS:
        bench.write(id, f"# {id}", "1 + 1")
    assert bench.build(formats=("html", "ipynb")).code == 0
    bench.right = {name: (bench.root / "reports" / name).read_bytes() for name in REPORTS}
    return bench


def wrong(built) -> list[str]:
    """The reports that are not as they have to be, after one more build that has to be good."""
    outcome = built.build(formats=("html", "ipynb"))
    assert outcome.code == 0, built.said
    assert "Traceback" not in built.said and "--accept" not in built.said and "report it" not in built.said
    return [n for n, content in built.right.items() if (built.root / "reports" / n).read_bytes() != content]


def flip(content: bytes, at: int) -> bytes:
    return content[:at] + bytes([content[at] ^ 1]) + content[at + 1 :]


def made_folder(path):
    path.unlink()
    path.mkdir()
    (path / "x").write_text("x")


def made_link(path):
    target = path.with_name("elsewhere")
    shutil.copy(path, target)
    path.unlink()
    path.symlink_to(target)


DAMAGES = {
    "a byte flipped": lambda p: p.write_bytes(flip(p.read_bytes(), len(p.read_bytes()) // 2)),
    "empty": lambda p: p.write_bytes(b""),
    "truncated": lambda p: p.write_bytes(p.read_bytes()[:-30]),
    "not JSON": lambda p: p.write_text("{"),
    "of another shape": lambda p: p.write_text("[1]"),
    "null": lambda p: p.write_text("null"),
    "another number": lambda p: p.write_bytes(p.read_bytes().replace(b"1.05", b"99.5").replace(b"result", b"resulT")),
    "nested deeply": lambda p: p.write_text("[" * 100_000),
    "not text": lambda p: p.write_bytes(b"\xff\xfe\x00" * 20),
    "gone": lambda p: p.unlink(),
    "a folder": made_folder,
    "a link": made_link,
    "that of another notebook": lambda p: p.write_bytes(
        (p.parent / ("two" + p.suffix)).read_bytes() if p.stem == "one" else p.read_bytes()
    ),
}
ENTRIES = ("executed/a/one.ipynb", "records/a/one.json", "stamps/a/one.json", "verdict.json", "manifest.json")


@pytest.mark.parametrize("entry", ENTRIES)
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_entry_is_a_miss(built, entry, damage):
    path = built.root / ".cache" / entry
    DAMAGES[damage](path)
    assert wrong(built) == []
    kept = entry.split("/")[0] in ("executed", "records", "stamps")
    if kept and damage not in ("a link", "gone", "that of another notebook"):
        (line,) = [line for line in built.said.splitlines() if line.startswith("ok")]
        assert ("a/one" in line and "(rebuilt: its stamp" in line) or "in the cache was changed)" in line
    assert wrong(built) == [] and built.said == "3 notebooks up to date\n"


@pytest.mark.long
def test_a_seeded_fuzz_of_the_whole_cache(built):
    chance = random.Random(14)
    for _ in range(150):
        files = sorted(p for p in (built.root / ".cache").rglob("*") if p.is_file() and p.name != "build.lock")
        for path in chance.sample(files, chance.randint(1, 3)):
            content = path.read_bytes()
            at = chance.randrange(len(content)) if content else 0
            kind = chance.randrange(5)
            changed = (
                flip(content, at) if content else b"x",
                content[:at],
                content[:at] + bytes(chance.randbytes(8)) + content[at:],
                chance.randbytes(40),
                files[chance.randrange(len(files))].read_bytes() if kind == 4 else b"",
            )[kind]
            path.write_bytes(changed)
        assert wrong(built) == []


def test_without_verification_the_same_damage_does_give_wrong_reports(built, monkeypatch):
    """The test of the tests: what they damage matters."""
    monkeypatch.setattr(stamps, "hash_now", lambda path: "same")
    monkeypatch.setattr(stamps, "of_bytes", lambda content: "same")
    monkeypatch.setattr(sealed, "_seal", lambda data, of: data.get("seal", "same"))
    built.build(force=True, formats=("html", "ipynb"))
    executed = built.root / ".cache/executed/a/one.ipynb"
    executed.write_bytes(executed.read_bytes().replace(b"result of", b"nonsense"))
    (built.root / "reports/a/one.html").unlink()
    assert wrong(built) == ["a/one.html"]


def test_a_changed_report_is_written_again_though_size_and_time_are_kept(built):
    import os

    for name in REPORTS[1:]:
        path = built.root / "reports" / name
        before = path.stat()
        path.write_bytes(flip(path.read_bytes(), 40))
        os.utime(path, ns=(before.st_atime_ns, before.st_mtime_ns))
    assert wrong(built) == []
    assert "was changed" in built.said


def test_what_is_changed_while_it_is_used_stops_the_build(built):
    notebook = built.project.notebooks()[0]
    stamps.records_path(built.project, notebook).write_text("[]")
    with pytest.raises(stamps.EnvironmentProblem, match=r"one\.json was changed while it was used; build again"):
        stamps._read(built.project, notebook, stamps.records_path(built.project, notebook), "records")


def test_the_list_of_fonts_is_made_again_where_it_was_changed(tmp_path):
    fonts = tmp_path / "matplotlib" / "fontlist.json"
    fonts.parent.mkdir()
    fonts.write_text("{}")
    kept_fonts.note(tmp_path)
    assert kept_fonts.check(tmp_path) == "" and fonts.exists()
    fonts.write_text("[]")
    assert "was changed" in kept_fonts.check(tmp_path) and not fonts.exists()
    assert kept_fonts.check(tmp_path) == ""


def test_the_records_kept_are_plain_data(built):
    (record,) = json.loads((built.root / ".cache/records/a/one.json").read_bytes())
    assert record["fields"]["exact"] == "1.05"
