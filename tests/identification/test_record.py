"""Records as loggers write them: found columns, units, decimals and gaps, or a refusal that says how to mend it."""

import numpy as np
import pytest

from loopbook.identification.record import Record, RecordError, read_csv

N = 30
T = np.arange(N) * 0.5
U = np.where(T >= 2, 5.0, 0.0)
Y = np.round(20 + 3 * np.maximum(T - 3, 0), 2)


def lines(*columns, head="", sep=",", form=str):
    rows = [sep.join(form(v) for v in row) for row in zip(*columns, strict=True)]
    return "\n".join([head, *rows] if head else rows) + "\n"


def read(tmp_path, text, encoding="utf-8", **names):
    file = tmp_path / "log.csv"
    file.write_bytes(text.encode(encoding))
    return read_csv(file, **names)


def comma(value):
    return str(value).replace(".", ",")


@pytest.mark.parametrize(
    "text",
    [
        lines(T, U, Y, head="Time,u,y"),
        lines(T, U, Y, head="Time [s];Q1 [%];T1 [°C]", sep=";", form=comma),
        lines(T, U, Y, head="tid (s)\tstyrsignal\ttemp", sep="\t"),
        lines(T * 1000, U, Y, head="t [ms],heater,temperature"),
        lines(T / 60, U, Y, head="Time (min),op,pv"),
        lines(range(N), T, U, Y, head=",time,input,output"),
        "# logged by hand\n" + lines(T, U, Y, head="t u y", sep=" "),
        "Plant 7\nunit;;\n" + lines(T, U, Y, head="time;u;y", sep=";"),
        lines([f"2026-03-01 10:00:{s:06.3f}" for s in T], U, Y, head="timestamp,u,y"),
        lines(T + 1e6, U, Y, head="time,u,y"),
    ],
    ids=["plain", "decimal comma", "tabs", "ms", "min", "index", "blanks", "preamble", "dates", "late start"],
)
def test_the_same_record_in_many_guises(tmp_path, text):
    record = read(tmp_path, text)
    assert np.allclose(record.time, T, atol=1e-6)
    assert np.array_equal(record.u, U) and np.allclose(record.y, Y)
    assert record.assumptions


def test_an_old_encoding_is_read(tmp_path):
    record = read(tmp_path, lines(T, U, Y, head="Time [s],u,Temp [°C]"), encoding="cp1252")
    assert record.output_unit == "°C"


def test_columns_can_be_named(tmp_path):
    text = lines(T, U, Y, Y / 2, head="Time,Q1,T1,T2")
    assert read(tmp_path, text).output_name == "T1"
    assert any("T2 could be it too (--output)" in a for a in read(tmp_path, text).assumptions)
    assert np.allclose(read(tmp_path, text, output="t2").y, Y / 2)
    with pytest.raises(RecordError, match="no column 'T3' for the output; the columns are Time, Q1, T1, T2"):
        read(tmp_path, text, output="T3")


def test_repeated_missing_and_unsorted_samples_are_mended_and_said(tmp_path):
    order = [1, 0, *range(2, N), 5]
    text = lines(T[order], U[order], Y[order], head="t,u,y") + "99,,4\n"
    record = read(tmp_path, text)
    assert np.allclose(record.time, T) and np.allclose(record.y, Y)
    said = " ".join(record.assumptions)
    assert "lack a value" in said and "sorted" in said and "share a time stamp" in said


def test_a_gap_is_said(tmp_path):
    keep = np.r_[0:10, 25:N]
    record = read(tmp_path, lines(T[keep], U[keep], Y[keep], head="t,u,y"))
    assert any("longest gap" in a for a in record.assumptions)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "the file is empty"),
        ("hello\nworld\n", "no columns found"),
        (lines(T[:5], U[:5], Y[:5], head="t,u,y"), "only 5 samples"),
        (lines(T, U, Y, head="t [fortnight],u,y"), "time is in 'fortnight'"),
        (lines(T[::-1] * 0, U, Y, head="a,u,y"), "no time column"),
        (lines(T, U, head="t,u"), "no output column"),
    ],
)
def test_what_cannot_be_read_is_refused(tmp_path, text, message):
    with pytest.raises(RecordError, match=message.replace("(", r"\(")):
        read(tmp_path, text)


def test_a_missing_file_is_named(tmp_path):
    with pytest.raises(RecordError, match="there is no file"):
        read_csv(tmp_path / "none.csv")
    with pytest.raises(RecordError, match="is a folder"):
        read_csv(tmp_path)


def test_a_record_refuses_what_it_cannot_hold():
    with pytest.raises(RecordError, match="differ in length"):
        Record(T, U[:-1], Y)
    with pytest.raises(RecordError, match="must be finite"):
        Record(T, U, np.where(T > 5, np.nan, Y))
    with pytest.raises(RecordError, match="increase strictly"):
        Record(T[::-1], U, Y)
