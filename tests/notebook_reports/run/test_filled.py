"""Parameters in prose: shown with four digits at least, never rounded; formulas and text stay as they are."""

from decimal import Decimal

import pytest
from hypothesis import given
from hypothesis import strategies as st

from notebook_reports.run.filled import fill, names_shown, written


@given(st.floats(min_value=1e-6, max_value=1e14))
def test_a_number_is_shown_whole_with_four_digits_or_more(value):
    shown = written(value)
    assert Decimal(shown) == Decimal(repr(value))
    assert len(shown.replace(".", "").lstrip("0")) >= 4


def test_other_braces_and_other_names_stay():
    text = r"$\frac{{a}}{{{b}}}$ {{unknown}} {{ T }} {{T:.2f}}"
    assert fill(text, {"T": 2.0}) == r"$\frac{{a}}{{{b}}}$ {{unknown}} 2.000 {{T:.2f}}"
    assert names_shown("{{T}} and {{ K }}") == {"T", "K"}


def test_a_text_is_no_markup():
    assert fill("for {{who}}", {"who": "$x$ `y`"}) == r"for \$x\$ \`y\`"


@pytest.mark.builds
def test_a_report_shows_what_the_notebook_was_run_with(bench):
    bench.write("a/b", "# Title", "1 + 1", ("T: float = 10.0  # s, > 0", "parameters"), "> T is {{T}} s")
    text = lambda: bench.executed("a/b")["cells"][3]["source"]  # noqa: E731
    assert bench.build().code == 0 and text() == "> T is 10.00 s"
    path = bench.write("a/b", "# Title", "1 + 1", ("T: float = 10.0  # s, > 0", "parameters"), "> Now T is {{T}} s")
    assert bench.build().code == 0 and text() == "> Now T is 10.00 s"
    out = path.parent / "out"
    assert bench.build("a/b", parameters=[("T", "2.5")], output=out).code == 0
    assert "> Now T is 2.500 s" in next(out.rglob("*.html")).read_text()
