"""What a change's own build wrote is quoted in a comment, never believed."""

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from review_comment import LONGEST, comment, number


@given(st.text(alphabet=st.sampled_from("`~<>@#[]()!|\n\\ ab\u202e\x1b\r"), max_size=200))
@example("```\n@all [x](y)\n````\n")
@example("`````")
def test_nothing_inside_closes_the_fence(text):
    lines = comment(text).split("\n")
    fence = lines[2].removesuffix("text")
    assert set(fence) == {"`"} and lines[-1] == fence
    assert all(fence not in line for line in lines[3:-1])
    assert not any(c in comment(text) for c in "\u202e\x1b\r")


def test_a_long_text_is_cut_and_says_so():
    text = comment("row\n" * LONGEST)
    assert len(text) < 65_536 and "cut; " in text


def test_the_run_with_the_pictures_is_linked_after_the_fence():
    lines = comment("[x](y)", "https://example.org/a/b/actions/runs/7").split("\n")
    assert lines[-3] == "```" and lines[-1].endswith("of [this run](https://example.org/a/b/actions/runs/7).")


@pytest.mark.parametrize("text", ["", "0", "12 --repo x", "$(id)", "1\n2", "-1", "1" * 12])
def test_a_number_is_digits_and_nothing_else(text):
    with pytest.raises(ValueError):
        number(text)
    assert number("41\n") == 41
