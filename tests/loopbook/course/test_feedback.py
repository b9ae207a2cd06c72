"""Feedback is written whatever a student wrote: their words are text on its page, never markup."""

import pytest

from loopbook.course.grade.one import GradeJob, grade_one
from loopbook.course.grade.submissions import Submission
from notebook_reports.export.read.pdf_text import PdfText

pytestmark = pytest.mark.builds

NASTY = (
    r"$\nonsense{$", "$x$", "`a`", "<script>alert(1)</script>", "x\x00\x1b[31m\u202ey",
    "\U0001f600 \u4e2d\u6587", "# h\n\n| a | b |",
    "a" * 5000, "K*" * 30 + "K", "=cmd()", "\\", "[x](javascript:1)", "![](http://x/y.png)", "{{K}}",
)  # fmt: skip


@pytest.mark.parametrize("kind", ["formula", "number"])
def test_whatever_was_written(sheet_file, head, kind):
    asked = "answer('f{0}', 'K*T', kind='formula', symbols='K T')" if kind == "formula" else "answer('f{0}', 7.77)"
    lines = "\n".join(f"v{i} = {asked.format(i)}" for i in range(len(NASTY)))
    content = sheet_file(*head, ("md", "**1.** ?", "question"), ("code", lines, "solution")).read_bytes()
    answers = {f"f{i}": text for i, text in enumerate(NASTY)}
    one = Submission("s1", "lag", "s1.csv", answers={**answers, "unasked $x$ `": "1"})
    graded = grade_one(GradeJob(content, {}, one, name="Zoë $x$ <b>"))
    assert {j.points for j in graded.judged} == {0} and "is not asked for" in graded.remarks[0]
    html = graded.feedback["html"].decode()
    assert (
        "<script>alert" not in html
        and "&lt;script&gt;alert(1)" in html
        and "http://x/y.png" in html
        and "<img" not in html
    )
    words = " ".join(run.text for run in PdfText(graded.feedback["pdf"]).runs())
    assert "nonsense" in words and "alert(1)" in words and "a" * 30 in words.replace(" ", "")
