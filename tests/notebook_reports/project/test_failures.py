"""The end of a build: one list, at most fifteen lines, with the command that repeats it."""

from notebook_reports.project.failures import Failure, summary


def many(number, more=()):
    return [Failure(f"a/{i}", "broken", 3, more, f"loopbook build a/{i}") for i in range(number)]


def test_one_failure_in_full():
    failure = Failure("a/b", "K = 1, expected 2", 7, ("pass it as from_inputs",), "loopbook build a/b")
    assert summary([failure]) == [
        "",
        "1 failed:",
        "a/b, cell 7: K = 1, expected 2",
        "    pass it as from_inputs",
        "Repeat: loopbook build a/b",
    ]


def test_details_go_before_lines_do():
    lines = summary(many(9, ("detail",)))
    assert len(lines) == 12 and not any("detail" in line for line in lines)
    assert lines[-1] == "Repeat: loopbook build " + " ".join(f"a/{i}" for i in range(9))


def test_never_more_than_fifteen_lines():
    lines = summary(many(100, ("detail",)))
    assert len(lines) == 15
    assert lines[1] == "100 failed:" and "and 89 more" in lines[-2]


def test_none():
    assert summary([]) == []
