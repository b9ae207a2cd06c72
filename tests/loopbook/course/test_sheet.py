"""A sheet is read strictly and run in one process, the same as in a kernel."""

import pytest

from loopbook.course.errors import SheetError
from loopbook.course.sheet import read_sheet


def test_a_sheet_solved_and_solved_with_own_answers(runner_of):
    ran = runner_of()
    solved = ran.solve({"T": 17.0, "K": 1.7})
    assert list(solved.asked) == ["Kc", "rise", "half"] and solved.asked["Kc"].key == pytest.approx(1 / 3)
    own = ran.solve({"T": 17.0, "K": 1.7}, {"Kc": 1.0, "rise": "unreadable"}, strict=False).asked
    assert own["rise"].key == pytest.approx(solved.asked["rise"].key / 3)
    assert own["half"].key == pytest.approx(own["rise"].key / 2)
    assert ran.solve({}).parameters == {"K": 2.3, "T": 14.0}


def test_outputs_are_kept_where_they_are_wanted(runner_of, head):
    drawing = (
        "code",
        "from notebook_reports.display import figure\nimport matplotlib.pyplot as plt\n"
        "figure(plt.figure(), 'caption', 'alt')",
        "given",
    )
    text = ("code", "from notebook_reports.display import Listing\nprint('said')\nListing('shown')", "given")
    imports = "import matplotlib.pyplot as plt\nfrom notebook_reports.display import figure\n"
    needed = ("code", imports + "x = 3\nfigure(plt.figure(), 'c', 'a')", "given")
    question, solution = ("md", "**1.** ?", "question"), ("code", "y = answer('y', x + 0.5)", "solution")
    ran = runner_of(*head, drawing, text, needed, question, solution)
    assert ran.sheet.only_drawn == {4}
    some = ran.solve({}, show="texts").outputs
    assert set(some) == {5, 6, 8} and [o["output_type"] for o in some[5]] == ["stream", "display_data"]
    whole = ran.solve({}, show="all").outputs
    assert set(whole) == {4, 5, 6, 8} and "image/svg+xml" in whole[4][0]["data"]
    assert "**3.50**" in whole[8][0]["data"]["text/markdown"] and len(whole[8]) == 1
    assert ran.solve({}).outputs == {}


@pytest.mark.parametrize(
    ("cells", "message"),
    [
        ([("md", "# T")], "no cell is tagged `question`"),
        ([("md", "?", "question")], "nothing is asked for"),
        (
            [("md", "?", "question"), ("code", "answer('a', 1.0)")],
            "cell 2 calls answer(...) and is not tagged `solution`",
        ),
        ([("code", "answer('a', 1.0)", "solution"), ("md", "?", "question")], "cell 1 answers before the first cell"),
        (
            [("md", "? {{Q}}", "question"), ("code", "answer('a', 1.0)", "solution")],
            "cell 1 shows {{Q}}, which is no parameter",
        ),
        ([("code", "1", "question"), ("code", "answer('a', 1.0)", "solution")], "a question is text"),
        ([("md", "?", "question"), ("code", "%matplotlib inline\nanswer('a', 1.0)", "solution")], "plain Python"),
        (
            [
                ("md", "?", "question"),
                ("code", "q: float = 1 / 2", "parameters"),
                ("code", "answer('a', 1.0)", "solution"),
            ],
            "is derived",
        ),
    ],
)
def test_what_is_no_sheet(sheet_file, cells, message):
    with pytest.raises(SheetError) as error:
        read_sheet(sheet_file(*cells))
    assert message in str(error.value) and "lag" in str(error.value)


@pytest.mark.parametrize(
    ("code", "message"),
    [
        ("a = 1\nanswer('a', 1 / 0)", "cell 5, line 2: ZeroDivisionError"),
        ("answer('a', 1.0)\nanswer('a', 2.0)", "a is asked for twice"),
        ("answer('a b', 1.0)", "a name of letters"),
        ("answer('a', 'x', kind='number')", "cell 5, line 1: answer 'a': the value: 'x' is no real number"),
    ],
)
def test_an_author_s_error_is_named_by_cell_and_line(runner_of, head, code, message):
    with pytest.raises(SheetError) as error:
        runner_of(*head, ("md", "**1.** ?", "question"), ("code", code, "solution")).solve({})
    assert message in str(error.value)


def test_numbers_that_a_sheet_refuses(runner_of, head):
    cells = (
        *head,
        ("md", "**1.** ?", "question"),
        ("code", "require(K > 2, 'K is large')\na = answer('a', K / 7)", "solution"),
    )
    ran = runner_of(*cells)
    assert ran.solve({"K": 1.7}).redraw == "K is large" and not ran.solve({"K": 3.1}).redraw
    assert ran.solve({"K": 1.7}, strict=False).asked["a"].key == pytest.approx(1.7 / 7)
