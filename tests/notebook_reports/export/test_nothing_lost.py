"""Random HTML and Markdown: every word comes out once, whatever tags are around it and however broken."""

import re

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from notebook_reports.export.model import Mend, plain, walk
from notebook_reports.export.read.flat import flat
from notebook_reports.export.read.html import read_html
from notebook_reports.export.read.markdown import read_markdown
from notebook_reports.export.read.reading import Reading
from notebook_reports.export.write.typst_text import flowing, text_pieces

pytestmark = pytest.mark.builds

TAGS = (
    "b i span div p ul ol li table tr td th h2 pre blockquote font center a code q details summary section dl dt dd int"
)
tags = st.sampled_from(TAGS.split())
marks = st.one_of(
    st.tuples(st.just("open"), tags),
    st.tuples(st.just("close"), tags),
    st.tuples(st.just("void"), st.sampled_from(["br", "hr"])),
)
texts = st.lists(st.one_of(marks, st.just(("word", ""))), min_size=1, max_size=40)


def written(parts):
    source, words = "", []
    for kind, name in parts:
        if kind == "word":
            words.append(f"w{len(words)}x")
            source += f" {words[-1]} "
        elif name != "int":
            source += f"</{name}>" if kind == "close" else f"<{name}>"
        else:
            source += f"</{name}>" if kind == "close" else f"<{name}>"
    return source, words


def shown(blocks):
    """The words of blocks; those of a listing are its text."""
    told = []
    for block in blocks:
        for node in [block, *walk(block)]:
            if hasattr(node, "text") and isinstance(node.text, str):
                told.append(node.text)
    return re.findall(r"w\d+x", " ".join(told))


@settings(max_examples=1500, deadline=None)
@given(texts)
def test_no_word_of_html_is_lost(parts):
    source, words = written(parts)
    blocks = read_html(source, Reading(mending=True))
    assert sorted(shown(blocks)) == sorted(words), source


@settings(max_examples=150, deadline=None)
@given(texts)
def test_no_word_of_markdown_with_html_is_lost(parts):
    source, words = written(parts)
    blocks = read_markdown(source, Reading(mending=True))
    assert sorted(shown(blocks)) == sorted(words), source


def test_a_cell_of_a_table_keeps_what_blocks_say():
    blocks = read_html("<h3>one</h3><p>two</p><ul><li>three</li></ul><pre>four\nfive</pre><hr>", Reading(mending=True))
    assert re.findall(r"[a-z]+", plain(flat(blocks))) == ["one", "two", "three", "four", "five"]
    assert not [node for node in walk(blocks) if isinstance(node, Mend)]


LETTERS = st.text(alphabet='ab :;.,!)(]/-\u200b"', max_size=200)


@given(LETTERS, st.integers(4, 60))
def test_places_to_break_change_no_character(text, longest):
    assert "".join(piece for piece, _ in text_pieces(text, longest, longest)) == text.replace("\u200b", "")
    assert "\u200b" not in flowing(text, longest, longest)
