"""`loopbook diff`: what changed since a commit, in words and as Markdown that nothing in the ledger can bend."""

import subprocess

import pytest
from click.testing import CliRunner
from hypothesis import example, given
from hypothesis import strategies as st

from notebook_reports.cli import main
from notebook_reports.ledger.difference import as_plain_markdown

HEAD = "document,place,id,says,verdict,evidence,notebook\n"


@pytest.fixture
def project(tmp_path):
    for folder in ("notebooks", "reports"):
        (tmp_path / folder).mkdir()
    (tmp_path / "notebooks" / "book.toml").write_text('title = "T"\n')
    write(tmp_path, "a,p 1,first,It rises.,holds,2 > 1,a/01", "a,p 2,second,It falls.,holds,1 < 2,a/01")
    for words in (["init", "-q"], ["add", "."], ["-c", "user.name=x", "-c", "user.email=x@y", "commit", "-qm", "x"]):
        subprocess.run(["git", *words], cwd=tmp_path, check=True)
    return tmp_path


def write(folder, *rows):
    (folder / "reports" / "claims.csv").write_text(HEAD + "".join(f"{row}\n" for row in rows))


def run(project, *words):
    done = CliRunner().invoke(main, ["--root", str(project), "diff", *words])
    return done.exit_code, done.output


def test_nothing_changed(project):
    assert run(project) == (0, "The ledger is that of HEAD\n")


def test_a_moved_verdict_a_new_row_and_one_that_went(project):
    write(project, "a,p 1,first,It rises.,fails,1 < 2,a/01", "a,p 3,third,<b>@all</b> | x,holds,,a/01")
    code, text = run(project)
    assert code == 1 and "3 rows of the ledger are not as in HEAD; 2 of them moved" in text
    assert "! a, p 1, first: verdict holds -> fails" in text and "a, p 3, third: new, holds" in text
    assert "a, p 2, second: gone, was holds" in text
    assert run(project, "--format", "md")[1].count("| moved |") == 2


def test_evidence_alone_is_told_and_is_no_error(project):
    write(project, "a,p 1,first,It rises.,holds,3 > 1,a/01", "a,p 2,second,It falls.,holds,1 < 2,a/01")
    code, text = run(project)
    assert code == 0 and "evidence 2 > 1 -> 3 > 1" in text


@pytest.mark.parametrize("ref", ["nosuch", "--output=pwn", "HEAD:reports"])
def test_a_commit_that_is_none(project, ref):
    code, text = run(project, "--", ref)
    assert code == 2 and "is no commit" in text
    assert not (project / "pwn").exists()


@given(st.one_of(st.text(max_size=60), st.text("`*_~[]()<>!|#\\&;:/.@ab\n", max_size=30)))
@example("`a` *b* _c_ ~~d~~ [e](f) ![g](h) <i> j|k &amp; https://l.m")
@example("# a")
def test_markdown_shows_what_stands_in_the_ledger(text):
    from html import unescape

    import mistune

    shown = mistune.create_markdown(plugins=["table", "url"])(f"x{as_plain_markdown(text)}x")
    words = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    assert unescape(shown) == f"<p>x{words}x</p>\n"


def test_every_character_that_marks_something_is_escaped():
    marks = "\\`*_{}[]<>()#+-.!|~@$&:"
    assert as_plain_markdown(marks) == "".join(f"\\{c}" for c in marks)
