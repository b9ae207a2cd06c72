"""Draws: by a secret, without replacement, and once given they stay."""

import json

import pytest

from loopbook.course.errors import CourseError
from loopbook.course.release.draw import Draw, read_secret
from loopbook.course.release.manifest import Manifest, read_manifest
from loopbook.course.release.release import assign_numbers, read_sheets
from loopbook.course.release.roster import Student, read_roster
from loopbook.course.release.variants import Variants, values
from loopbook.course.sheet import read_sheet
from notebook_reports.project.parameters import NotebookParameter
from notebook_reports.project.ranges import read_range

KEY = b"a secret of a course"


def roster(*ids):
    return [Student(id) for id in ids]


def numbers(manifest, sheet="lag"):
    return manifest.sheets[sheet].numbers


@pytest.mark.parametrize(
    ("kind", "default", "comment", "found"),
    [
        ("float", 5.0, "s, {5, 8, 10}", (5.0, 8.0, 10.0)),
        ("float", 20.0, "s, {20, 25 … 35}", (20.0, 25.0, 30.0, 35.0)),
        ("int", 2, "[1, 4)", (1, 2, 3)),
        ("float", 0.45, "[0.44, 0.46)", tuple(0.44 + 0.001 * i for i in range(20))),
        ("bool", True, "with filter", (False, True)),
        ("str", "PI", '{"PI", "PID"}', ("PI", "PID")),
        ("float", 3.0, "s, > 0", (3.0,)),
        ("float", 3.0, "s", (3.0,)),
    ],
)
def test_the_values_of_a_parameter(kind, default, comment, found):
    got = values(NotebookParameter("x", kind, default, comment, read_range(comment)))
    assert got == pytest.approx(found) if kind == "float" else got == found


def test_every_variant_has_a_number_and_back(sheet_file):
    variants = Variants(read_sheet(sheet_file()))
    assert variants.count == 12 and [variants.index(variants.at(i)) for i in range(12)] == list(range(12))
    assert variants.index({"K": 99.0, "T": 11.0}) is None
    with pytest.raises(IndexError):
        variants.at(12)


def test_no_two_share_all_numbers_until_none_are_left(sheet_file):
    sheets = read_sheets([sheet_file()])
    students = [f"s{i:02}" for i in range(40)]
    first, _ = assign_numbers(sheets, roster(*students[:8]), KEY, Manifest())
    given = [tuple(n.values()) for n in numbers(first).values()]
    assert len(set(given)) == 8
    with pytest.raises(CourseError, match=r"lag: (\d+) variants for 40 students; widen") as error:
        assign_numbers(sheets, roster(*students), KEY, Manifest())
    count = int(str(error.value).split()[1])
    narrow = sheet_file().read_text().replace("Kc = answer", "require(K > 2, 'K is large'); Kc = answer")
    with pytest.raises(CourseError, match=r"lag: 8 variants for 9 students; 4 of 12 fall to: K is large; widen"):
        assign_numbers({"lag": narrow.encode()}, roster(*students[:9]), KEY, Manifest())
    enough, _ = assign_numbers(sheets, roster(*students[:count]), KEY, Manifest())
    assert len({tuple(n.values()) for n in numbers(enough).values()}) == count


def test_who_was_there_keeps_the_numbers(sheet_file, tmp_path):
    sheets = read_sheets([sheet_file()])
    before, _ = assign_numbers(sheets, roster("s3", "s1", "s2"), KEY, Manifest())
    late, remarks = assign_numbers(sheets, roster("a0", "s1", "s2", "s3", "zz"), KEY, before)
    assert remarks == [] and all(numbers(late)[s] == numbers(before)[s] for s in ("s1", "s2", "s3"))
    before.write(tmp_path / "m.json")
    assert (tmp_path / "m.json").stat().st_mode & 0o077 == 0
    kept = read_manifest(tmp_path / "m.json")
    text = (
        sheet_file()
        .read_text()
        .replace("{1.7, 2.3, 3.1}", "{1.3, 2.3, 2.9}")
        .replace("half a minute", "thirty seconds")
    )
    mended = read_sheets([_written(tmp_path, text)])
    after, _ = assign_numbers(mended, roster("s1", "s2", "s3"), KEY, kept)
    assert numbers(after) == numbers(before) and after.sheets["lag"].digest != before.sheets["lag"].digest


def test_a_mended_sheet_that_would_not_draw_them_says_so_and_keeps_them(sheet_file, tmp_path):
    sheets = read_sheets([sheet_file()])
    before, _ = assign_numbers(sheets, roster("s1", "s2"), KEY, Manifest())
    text = sheet_file().read_text().replace("Kc = answer", "require(False, 'none is good'); Kc = answer")
    after, remarks = assign_numbers(read_sheets([_written(tmp_path, text)]), roster("s1"), KEY, before)
    assert numbers(after) == numbers(before) and len(remarks) == 2 and "none is good" in remarks[0]
    more = (
        sheet_file().read_text().replace("s, {11", "s, {11").replace("K: float", "N: float = 8.0  # {8, 9}\\nK: float")
    )
    grown, _ = assign_numbers(read_sheets([_written(tmp_path, more)]), roster("s1"), KEY, before)
    assert numbers(grown)["s1"] == {"N": 8.0, **numbers(before)["s1"]}


def _written(tmp_path, text):
    json.loads(text)
    path = tmp_path / "mended" / "lag.ipynb"
    path.parent.mkdir(exist_ok=True)
    path.write_text(text)
    return path


def test_the_roster_s_order_decides_who_comes_first_and_nothing_else(sheet_file):
    sheets = read_sheets([sheet_file()])
    few, _ = assign_numbers(sheets, roster("b", "c"), KEY, Manifest())
    more, _ = assign_numbers(sheets, roster("b", "c", "a", "d"), KEY, Manifest())
    other, _ = assign_numbers(sheets, roster("b", "c"), b"another secret of it", Manifest())
    assert all(numbers(more)[s] == numbers(few)[s] for s in "bc") and numbers(other) != numbers(few)


def test_every_variant_is_as_likely(sheet_file):
    variants = Variants(read_sheet(sheet_file()))
    counts = [0] * variants.count
    for i in range(3000):
        counts[Draw("lag", variants, KEY, lambda numbers: "").of(f"s{i}", 1)[0]] += 1
    assert all(180 < count < 320 for count in counts)


def test_the_secret(tmp_path):
    path = tmp_path / "repository" / "secret"
    path.parent.mkdir()
    with pytest.raises(CourseError, match="loopbook course secret"):
        read_secret(path)
    path.write_text("short\n")
    with pytest.raises(CourseError, match="has 5 bytes; 16 or more"):
        read_secret(path)
    path.write_text("long enough for a course\n")
    assert read_secret(path) == b"long enough for a course"
    with pytest.raises(CourseError, match="keep it outside"):
        read_secret(path, path.parent)


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("id,name\ns1,Åsa Öst\ns2,\n", [("s1", "Åsa Öst"), ("s2", "")]),
        ("﻿Student_ID;First name;Last name\r\ns1;Bo;Ek\r\n\r\n", [("s1", "Bo Ek")]),
        ("Name\tUsername\nA B\ta.b@x.se\n", [("a.b@x.se", "A B")]),
    ],
)
def test_rosters_as_offices_export_them(tmp_path, text, found):
    (tmp_path / "r.csv").write_text(text, encoding="utf-8")
    assert [(s.id, s.name) for s in read_roster(tmp_path / "r.csv")] == found


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty"),
        ("id\n", "names nobody"),
        ("who\nx\n", "no column of ids"),
        ("id\ns1\nS1\n", "line 3: S1 stands twice"),
        ("id\n../etc\n", "names no file"),
        ("id,name\ns1,a,b\n", "3 cells below 2 columns"),
    ],
)
def test_rosters_that_are_none(tmp_path, text, message):
    (tmp_path / "r.csv").write_text(text)
    with pytest.raises(CourseError, match=message):
        read_roster(tmp_path / "r.csv")
    (tmp_path / "m.json").write_text('{"version": 9}')
    with pytest.raises(CourseError, match="version 9"):
        read_manifest(tmp_path / "m.json")
