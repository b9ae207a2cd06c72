"""Strict parameters: every mistake is an error before a kernel starts, every value arrives as what it is."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from notebook_reports.project.parameters import ParameterError, assign, read_parameters
from notebook_reports.project.ranges import read_range
from notebook_reports.project.source import Source, SourceCell

CELL = """
q: float = 0.5  # pole of the observer, [0, 1)
h: float = 1.0  # s, > 0
n: int = 3  # {2, 3, 4}
filtered: bool = True  # with the derivative filter
method: str = "PI"  # {"P", "PI", "PID"}
poles: list[float] = [0.3, 0.5]  # each in [0, 1)
name: str | None = None
"""


def source(text=CELL, tags=("parameters",), more=()):
    from pathlib import Path

    cells = [SourceCell(1, "p", "code", text, tags, ""), *more]
    return Source(Path("double_tank/03_pole_placement.ipynb"), tuple(cells), {})


def test_each_parameter_is_known_with_type_default_and_range():
    found = read_parameters(source())
    assert list(found) == ["q", "h", "n", "filtered", "method", "poles", "name"]
    assert found["q"].type == "float" and found["q"].default == 0.5 and found["q"].range.text == "[0, 1)"
    assert found["name"].default is None


@pytest.mark.parametrize(
    ("name", "text", "value"),
    [
        ("q", "0.6", 0.6),
        ("q", "0", 0.0),
        ("q", "5e-1", 0.5),
        ("n", "4", 4),
        ("filtered", "false", False),
        ("filtered", "True", True),
        ("method", "PID", "PID"),
        ("poles", "[0.1, 0]", [0.1, 0.0]),
        ("poles", "0.1,0.2", [0.1, 0.2]),
        ("name", "none", None),
        ("name", '"; import os; os.abort()', '"; import os; os.abort()'),
        ("name", "two\nlines \\ and 'quotes'", "two\nlines \\ and 'quotes'"),
    ],
)
def test_words_of_the_command_line_become_typed_values(name, text, value):
    got = assign(source(), [(name, text)])[name]
    assert got == value and type(got) is type(value)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("Q", "0.6", "has no parameter 'Q'; did you mean"),
        ("methd", "PI", "has no parameter 'methd'; did you mean method?"),
        ("zzz", "1", "it has q, h, n, filtered, method, poles, name"),
        ("q; import os", "1", "parameter 'q; import os' is not a name"),
        ("lambda", "1", "parameter 'lambda' is not a name"),
        ("q", "1.0", "q = 1.0 is out of range: [0, 1)"),
        ("q", "-0.1", "q = -0.1 is out of range"),
        ("q", "nan", "q = nan is not a float that can be computed with"),
        ("h", "inf", "h = inf is not a float that can be computed with"),
        ("h", "0", "h = 0.0 is out of range: > 0"),
        ("h", "half", "h = 'half' is not a float"),
        ("n", "3.0", "n = '3.0' is not an int"),
        ("n", "7", "n = 7 is out of range: {2, 3, 4}"),
        ("filtered", "0", "filtered = '0' is not a bool: write true or false"),
        ("method", "PD", "method = 'PD' is out of range"),
        ("poles", "[0.1, 2]", "poles = [0.1, 2.0] is out of range"),
        ("poles", "__import__('os')", "poles = \"__import__('os')\" is not a list[float]"),
    ],
)
def test_mistakes_on_the_command_line(name, text, message):
    with pytest.raises(ParameterError) as error:
        assign(source(), [(name, text)])
    assert message in str(error.value)
    assert error.value.name == name


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("filtered", "false", "filtered = 'false' is not a bool but a str"),
        ("filtered", 0, "filtered = 0 is not a bool but an int"),
        ("q", True, "q = True is not a float but a bool"),
        ("n", 3.0, "n = 3.0 is not an int but a float"),
        ("q", "0.5", "q = '0.5' is not a float but a str"),
    ],
)
def test_python_values_are_not_converted_behind_ones_back(name, value, message):
    with pytest.raises(ParameterError) as error:
        assign(source(), {name: value})
    assert message in str(error.value)


def test_an_int_is_a_float_where_a_float_is_due():
    assert assign(source(), {"q": 0}) == {"q": 0.0}


def test_given_twice():
    with pytest.raises(ParameterError, match="q is given twice"):
        assign(source(), [("q", "0.1"), ("q", "0.2")])


def test_a_notebook_without_a_tagged_cell_takes_none():
    with pytest.raises(ParameterError, match="takes no parameters: it has no cell tagged `parameters`"):
        assign(source(tags=()), [("q", "0.1")])


def test_two_tagged_cells():
    with pytest.raises(ParameterError, match="cells 1 and 2 are both tagged"):
        read_parameters(source(more=(SourceCell(2, "p2", "code", "a: int = 1", ("parameters",), ""),)))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("q: float = 0.5\np: float = 1 - q", "line 2: p = 1 - q is derived"),
        ("q: float = float('0.5')", "line 1: q = float('0.5') is derived"),
        ("import os", "line 1: `import os` is not of the form"),
        ("q: float", "line 1: `q: float` is not of the form"),
        ("q, h = 1, 2", "is not of the form"),
        ("q: float = 'a'", "line 1: q = 'a' is not a float"),
        ("q: bool = 1", "line 1: q = 1 is not a bool but an int"),
        ("q: float = 1.5  # [0, 1)", "line 1: q = 1.5 is out of range"),
        ("q: float = 1\nq: float = 2", "line 2: q is assigned twice"),
        ("q: complex = 1j", "q has the type complex; known are bool, int, float, str"),
        ("q = None", "line 1: annotate q with its type"),
        ("q: float = (", "line 1: '(' was never closed"),
    ],
)
def test_a_parameters_cell_that_would_deceive_is_refused(text, message):
    with pytest.raises(ParameterError) as error:
        read_parameters(source(text))
    assert "cell 1 (parameters)" in str(error.value) and message in str(error.value)


def test_types_are_inferred_where_nobody_wrote_them():
    found = read_parameters(source("q = 0.5\nn = 3\nnames = ['a']\npair = (1.0, 2.0)"))
    assert [p.type for p in found.values()] == ["float", "int", "list[str]", "tuple[float, ...]"]
    assert assign(source("pair = (1.0, 2.0)"), [("pair", "3,4")]) == {"pair": (3.0, 4.0)}


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_floats_arrive_to_the_last_bit(value):
    assert assign(source("x: float = 0.0"), [("x", repr(value))])["x"] == value


@given(st.text())
def test_text_arrives_as_it_is(value):
    assert assign(source("x: str = ''"), [("x", value)])["x"] == value


@pytest.mark.parametrize(
    ("comment", "inside", "outside"),
    [
        ("pole, [0, 1)", (0, 0.99), (-0.01, 1)),
        ("in (0, 1]", (0.01, 1), (0, 1.01)),
        ("]0, 1[", (0.5,), (0, 1)),
        ("[0, inf)", (0, 1e300), (-1e-300,)),
        ("s, > 0", (1e-9,), (0, -1)),
        ("s, >= 0, < 10", (0, 9.9), (-0.1, 10)),
        ("≥ 0", (0,), (-1,)),
        ("0 < q <= 1", (0.1, 1), (0, 1.1)),
        ("−1 ≤ x ≤ 1", (-1, 1), (-1.1, 1.1)),
        ("{2, 4}", (2, 4), (3,)),
        ("m3/s (measured in the lab)", (-1e9, 1e9), ()),
        ("", (0,), ()),
    ],
)
def test_ranges_in_comments(comment, inside, outside):
    found = read_range(comment)
    assert all(found.holds(v) for v in inside)
    assert not any(found.holds(v) for v in outside)


@pytest.mark.parametrize(
    ("comment", "choices"),
    [
        ("s, {20, 25 … 40}", (20, 25, 30, 35, 40)),
        ("s, {2, 3, ..., 5}", (2, 3, 4, 5)),
        ("{0.1, 0.2 … 0.5}", (0.1, 0.2, 0.3, 0.4, 0.5)),
        ("{-1, 0 … 2}", (-1, 0, 1, 2)),
        ("{2, 5 … 6}", ()),
        ("{2, 2 … 6}", ()),
        ("{0, 1 … 10000000}", ()),
        ("{12.5, 5, 8, 10}", (5, 8, 10, 12.5)),
        ('{"PI", "P"}', ("P", "PI")),
    ],
)
def test_lists_with_equal_steps(comment, choices):
    assert read_range(comment).choices == choices
