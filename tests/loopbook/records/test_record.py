"""Records as loggers write them: found columns, units, decimals and gaps, or a refusal that says how to mend it."""

from datetime import datetime, timedelta

import numpy as np
import pytest

from loopbook.records.reading import read_record
from loopbook.records.record import Record, RecordError
from loopbook.records.steps import find_steps

N = 30
T = np.arange(N) * 0.5
U = np.where(T >= 2, 5.0, 0.0)
Y = np.round(20 + 3 * np.maximum(T - 3, 0), 2)


def lines(*columns, head="", sep=",", form=str):
    rows = [sep.join(form(v) for v in row) for row in zip(*columns, strict=True)]
    return "\n".join([head, *rows] if head else rows) + "\n"


def grouped(value):
    return f"{value:,.3f}".translate(str.maketrans(",.", ".,"))


def day(seconds, form):
    return (datetime(2026, 2, 1, 23, 59, 55) + timedelta(seconds=float(seconds))).strftime(form)


def read(tmp_path, text, encoding="utf-8", **names):
    file = tmp_path / "log.csv"
    file.write_bytes(text.encode(encoding))
    return read_record(file, **names)


def comma(value):
    return value if isinstance(value, str) else str(value).replace(".", ",")


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
        lines(T + 1e6, U, Y, head="time;u;y", sep=";", form=grouped),
        lines(T, U, Y, head="Time;u;y\ns;%;°C", sep=";", form=comma),
        "sep=;\n" + lines(T, U, Y, head="Time;u;y", sep=";", form=comma),
        lines(T, U, Y, head="time,u,y", form=lambda v: f'"{comma(v)}"'),
        lines(T * 1000 + 1.7e12, U, Y, head="timestamp,u,y"),
        lines([day(s, "%d.%m.%Y %H:%M:%S.%f") for s in T], U, Y, head="tid;u;y", sep=";", form=comma),
        lines([day(s, "%d/%m/%Y %H:%M:%S.%f") for s in T], U, Y, head="date,u,y"),
        lines([day(s, "%m/%d/%Y %H:%M:%S.%f") for s in T], U, Y, head="date,u,y"),
        lines([day(s, "%Y-%m-%dT%H:%M:%S.%f+01:00") for s in T], U, Y, head="date,u,y"),
        lines(T[:9], U[:9], Y[:9], head="time,u,y") + lines(T[9:], U[9:], Y[9:], head="time,u,y"),
        lines(range(N), T, U, Y, head="Unnamed: 0,time,u,y"),
        lines(T, np.full(N, 21.5), U, Y, head="time,sp,op,pv"),
        lines(T, U, Y, head="time,u,y").replace("\n", "\r\n"),
    ],
    ids=[
        *("plain", "decimal comma", "tabs", "ms", "min", "index", "blanks", "preamble", "dates", "late start"),
        *("grouped thousands", "line of units", "sep line", "quoted decimal comma", "since 1970", "dotted dates"),
        *("day first", "month first", "zone", "logging restarted", "pandas index", "set-point", "line ends"),
    ],
)
def test_the_same_record_in_many_guises(tmp_path, text):
    record = read(tmp_path, text)
    assert np.allclose(record.time, T, atol=1e-6)
    assert np.array_equal(record.u, U) and np.allclose(record.y, Y)
    assert record.assumptions


def test_an_old_encoding_is_read(tmp_path):
    record = read(tmp_path, lines(T, U, Y, head="Time [s],u,Temp [°C]"), encoding="cp1252")
    assert record.output_unit == "°C"


def test_a_spreadsheets_export_is_read(tmp_path):
    record = read(tmp_path, lines(T, U, Y, head="Tid [s];Styrsignal [%];Mätvärde [°C]", sep=";", form=comma), "utf-16")
    assert (record.input_name, record.output_name, record.output_unit) == ("Styrsignal", "Mätvärde", "°C")


def test_a_line_of_units_names_the_units(tmp_path):
    record = read(tmp_path, lines(T / 60, U, Y, head="Time;u;y\nmin;%;°C", sep=";", form=lambda v: f"{v:.9f}"))
    assert (record.input_unit, record.output_name, record.output_unit) == ("%", "y", "°C")
    assert np.allclose(record.time, T, atol=1e-6)


def test_a_step_at_a_sample_whose_output_is_missing_keeps_its_instant(tmp_path):
    at = int(np.argmax(U > 0))
    shown = ["---" if i in (at, at + 1) else y for i, y in enumerate(Y)]
    record = read(tmp_path, lines(T, U, shown, head="time,u,y"))
    assert len(record.time) == N - 2
    (steps, before) = (find_steps(record).list, find_steps(record).before)
    assert steps == [(T[at], 5.0)] and before == at


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
        read_record(tmp_path / "none.csv")
    with pytest.raises(RecordError, match="is a folder"):
        read_record(tmp_path)


def test_a_record_refuses_what_it_cannot_hold():
    with pytest.raises(RecordError, match="differ in length"):
        Record(T, U[:-1], Y)
    with pytest.raises(RecordError, match="must be finite"):
        Record(T, U, np.where(T > 5, np.nan, Y))
    with pytest.raises(RecordError, match="increase strictly"):
        Record(T[::-1], U, Y)


LONG = np.arange(40.0)
UP = np.where(LONG >= 10, 50.0, 10.0)
RISEN = np.round(20 + 30 * (1 - np.exp(-np.maximum(LONG - 12, 0) / 8)) + 0.01 * np.sin(7 * LONG), 3)


@pytest.mark.parametrize(
    ("head", "u", "y"),
    [
        ("time,valve flow,valve opening", "valve opening", "valve flow"),
        ("time,pH,Acid flow", "Acid flow", "pH"),
        ("time,CO2 ppm,Fan level", "Fan level", "CO2 ppm"),
        ("Zeit,Regelgröße,Stellgröße", "Stellgröße", "Regelgröße"),
        ("Tid,Mätsignal,Ventilläge", "Ventilläge", "Mätsignal"),
        ("Czas,Wartość mierzona,Sygnał sterujący", "Sygnał sterujący", "Wartość mierzona"),
        ("Tiempo,Variable de proceso,Señal de control", "Señal de control", "Variable de proceso"),
        ("X_Value,Temperature,Heater", "Heater", "Temperature"),
    ],
)
@pytest.mark.parametrize("swapped", [False, True])
def test_names_tell_input_from_output_in_either_order(tmp_path, head, u, y, swapped):
    names = head.split(",")
    columns = {names[0]: LONG, u: UP, y: RISEN}
    order = [names[0], *(names[:0:-1] if swapped else names[1:])]
    record = read(tmp_path, lines(*[columns[n] for n in order], head=",".join(order)))
    assert (record.input_name, record.output_name) == (u, y)


def test_of_two_outputs_the_one_with_the_inputs_number_is_taken(tmp_path):
    other = 0.5 * RISEN
    for order in ((RISEN, other), (other, RISEN)):
        head = "time,Heater 1,Temperature 1,Temperature 2"
        names = head if order[0] is RISEN else "time,Heater 1,Temperature 2,Temperature 1"
        assert read(tmp_path, lines(LONG, UP, *order, head=names)).output_name == "Temperature 1"


def stop_watch(seconds):
    return f"{int(seconds) // 60:02}:{int(seconds) % 60:02}"


@pytest.mark.parametrize(
    "text",
    [
        lines([f"{t:g} s" for t in LONG], [f"{v:g} %" for v in UP], [f"{v} °C" for v in RISEN], head="time,u,y"),
        lines(LONG, [f"{v:g}%" for v in UP], RISEN, head="time,u,y"),
        "// " + lines(LONG, UP, RISEN, head="time,u,y"),
        "# time, u, y\n# started by hand\n" + lines(LONG, UP, RISEN),
        lines([stop_watch(t) for t in LONG], UP, RISEN, head="time,u,y"),
        lines([stop_watch(t + 3580) for t in LONG], UP, RISEN, head="time,u,y"),
        lines([f"202512312358{int(t):02}" for t in LONG], UP, RISEN, head="time,u,y"),
        lines(LONG, [v if i in (0, 10) else "" for i, v in enumerate(UP)], RISEN, head="time,u,y"),
    ],
)
def test_a_loggers_habits_change_nothing(tmp_path, text):
    record = read(tmp_path, text)
    np.testing.assert_allclose(record.time, LONG, atol=1e-6)
    np.testing.assert_array_equal(record.u, UP)
    np.testing.assert_array_equal(record.y, RISEN)


def test_hours_and_minutes_are_not_minutes_and_seconds(tmp_path):
    texts = [stop_watch(t + 8 * 60 + 15) for t in LONG]
    record = read(tmp_path, lines(texts, UP, RISEN, head="time,u,y"))
    assert record.sampling == 60.0 and record.time_unit == "hours:minutes"


def test_a_loggers_sign_for_a_missing_value_is_no_measurement(tmp_path):
    y = RISEN.copy()
    y[[0, 1, 2, 3, 20]] = -9999
    record = read(tmp_path, lines(LONG, UP, y, head="time,u,y"))
    assert record.left_out.sum() == 5 and any("missing value" in text for text in record.assumptions)
    jumped = np.where(LONG < 10, 0.0, 100 + 0.01 * np.sin(7 * LONG))
    assert not read(tmp_path, lines(LONG, UP, jumped, head="time,u,y")).left_out.any()
