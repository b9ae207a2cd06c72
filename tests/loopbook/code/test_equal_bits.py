"""One derivation, four languages, no bit between them: the table that ``make test`` prints."""

import pytest
from prove import prove

pytestmark = pytest.mark.builds


@pytest.mark.parametrize("compensated", [False, True], ids=["plain sum", "compensated sum"])
def test_every_language_gives_the_same_bits(compensated, record_property, share):
    some = (lambda title: "-O2" in title or "Text" in title or "V8" in title) if compensated else lambda title: True
    samples = share(100, 300) if compensated else share(300, 2000)
    proof = prove(samples, chosen=some, compensated=compensated)
    if not compensated:
        record_property("table", proof.text())
        assert proof.fewest >= samples / 2, "a branch of the program is hardly taken"
    ran = [row for row in proof.rows if not row.missing]
    assert {row.title.split(",")[0].split()[0] for row in ran} >= {"Structured"}
    assert all(row.numbers > 0 for row in ran)
    assert {row.title: row.total for row in ran} == {row.title: 0 for row in ran}


def test_a_long_run_goes_on_where_the_last_chunk_ended():
    def some(title: str) -> bool:
        return title in ("C double, gcc -O2", "JavaScript, V8", "Python, emitted", "Structured Text, REAL")

    whole, parts = (prove(450, 5, chosen=some, size=size) for size in (450, 200))
    assert [row.total for row in (*whole.rows, *parts.rows)] == [0] * 8
    assert whole.branches == parts.branches
