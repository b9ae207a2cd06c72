"""Are the words of a notebook on its pages, in order, each in the place of its cell?

The words of the notebook are taken from its JSON by rules of their own, not by the reader that makes the pages, so that
what the reader loses is seen: Markdown without its marks, code as it is, of each output the form a browser shows.
Formulas and pictures have no words here.
"""

import html
import re
import unicodedata
from bisect import bisect, bisect_left
from collections import Counter
from dataclasses import dataclass
from typing import Any

NEAR = 250
"""Words from where a cell stands within which its words are in their place: about half a page."""
_MATH = re.compile(
    r"\$\$.*?\$\$|(?<![\\$])\$[^$]+?\$|\\begin\{(\w+\*?)\}.*?\\end\{\1\}|\\\(.*?\\\)|\\\[.*?\\\]|\\(?:eq)?ref\{[^}]*\}",
    re.DOTALL,
)
_UNSEEN = re.compile(r"<(style|script|svg|title|head)\b.*?(</\1\s*>|\Z)|<!--.*?-->", re.DOTALL | re.IGNORECASE)
_TAG = re.compile(r"</?([A-Za-z][A-Za-z0-9:-]*)(\s[^<>]*|/)?>", re.DOTALL)
_ANSI = re.compile(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b\][^\x07]*\x07")
_HTML_NAMES = frozenset(
    re.findall(
        r"\w+",
        """
        a abbr address article aside audio b blockquote body br button canvas caption center cite code col colgroup
        dd del details dfn div dl dt em embed figcaption figure font footer form h1 h2 h3 h4 h5 h6 head header hr html
        i iframe img input ins kbd label li link main mark meta nav nobr ol option p pre progress q s samp section
        select small source span strike strong style sub summary sup svg table tbody td template textarea tfoot th
        thead time title tr tt u ul var video wbr
        """,
    )
)


@dataclass(frozen=True)
class Comparison:
    """Words by cell: lost are on no page, displaced are threes of words that are not where their cell stands."""

    count: int
    lost: list[tuple[int, str]]
    displaced: list[tuple[int, str]]


def words_of(text: str) -> list[str]:
    """Letters and digits, in small letters.

    >>> words_of("A self-tuning PID: 0.5")
    ['a', 'self', 'tuning', 'pid', '0', '5']
    """
    return re.findall(r"[^\W_]+", unicodedata.normalize("NFKC", text).lower())


def notebook_words(notebook: Any) -> list[tuple[int, list[str]]]:
    """The words of each cell, its number with them."""
    found = []
    for number, cell in enumerate(notebook["cells"], start=1):
        hidden = {"remove-input", "hide-input"} & set(cell.get("metadata", {}).get("tags", ()))
        source = "" if hidden else "".join(cell.get("source") or "")
        text = _of_markdown(source) if cell["cell_type"] == "markdown" else source
        outputs = [_of_output(output) for output in cell.get("outputs") or ()]
        found.append((number, words_of("\n".join([text, *outputs]))))
    return found


def compare(notebook: Any, page: str) -> Comparison:
    """Which words of a notebook are not on its page, and which threes of words stand elsewhere.

    Threes that occur once in the notebook and once on the page are put in their order in both; the longest row of them
    that rises in both is what stands in order, and what lies further from it than about half a page is displaced.
    """
    cells = notebook_words(notebook)
    shown = words_of(page)
    text, whole = "".join(shown), set(shown)
    words = [(number, word) for number, found in cells for word in found]
    counted = [(number, word) for number, word in words if len(word) >= 3]
    lost = [(number, word) for number, word in counted if word not in whole and word not in text]
    here, there = _threes([word for _, word in words]), _threes(shown)
    pairs = [(place, there[three]) for three, place in here.items() if three in there]
    row = _rising([onward for _, onward in pairs])
    displaced = []
    for at, (place, onward) in enumerate(pairs):
        near = [pairs[i][1] for i in row[max(0, bisect(row, at) - 1) : bisect(row, at) + 1]]
        if near and min(abs(onward - n) for n in near) > NEAR:
            displaced.append((words[place][0], " ".join(word for _, word in words[place : place + 3])))
    return Comparison(len(counted), lost, displaced)


def _threes(words: list[str]) -> dict[tuple[str, ...], int]:
    """Three words that follow each other, and stand nowhere else, with their place."""
    threes = [tuple(words[i : i + 3]) for i in range(len(words) - 2)]
    once = {three for three, count in Counter(threes).items() if count == 1}
    return {three: place for place, three in enumerate(threes) if three in once}


def _rising(values: list[int]) -> list[int]:
    """The places of a longest row of values that rise.

    >>> _rising([1, 9, 2, 3])
    [0, 2, 3]
    """
    least: list[int] = []
    places: list[int] = []
    before: list[int] = []
    for i, value in enumerate(values):
        k = bisect_left(least, value)
        before.append(places[k - 1] if k else -1)
        least[k : k + 1], places[k : k + 1] = [value], [i]
    row: list[int] = []
    i = places[-1] if places else -1
    while i >= 0:
        row.append(i)
        i = before[i]
    return row[::-1]


def _of_markdown(source: str) -> str:
    """What of Markdown is read, roughly: no addresses, no marks, no formulas."""
    text = _UNSEEN.sub(" ", _MATH.sub(" ", source))
    text = re.sub(r"!\[[^\]]*\](\([^)]*\)|\[[^\]]*\])", " ", text)
    text = re.sub(r"\]\((<[^>]*>|[^()\s]*(\([^()]*\)[^()\s]*)*)(\s+[\"'(][^)]*)?\)", "] ", text)
    text = re.sub(r"^ {0,3}\[(?!\^)[^\]]+\]:\s*\S+.*$", " ", text, flags=re.MULTILINE)
    text = re.sub(r"\]\[[^\]]*\]|\[\^[^\]]*\]:?|(?:```|~~~)[^\n]*", "] ", text)
    return html.unescape(_without_tags(text))


def _of_output(output: Any) -> str:
    kind = output["output_type"]
    if kind == "stream":
        return "\n".join(line.split("\r")[-1] for line in _ANSI.sub("", _joined(output.get("text"))).split("\n"))
    if kind == "error":
        return _ANSI.sub("", "\n".join(output.get("traceback") or [output.get("evalue", "")]))
    data = output.get("data") or {}
    text = _joined(data.get("text/html"))
    if any(mime.startswith(("image/", "text/latex", "application/vnd.loopbook")) for mime in data):
        return ""
    if text and "repr-fallback" not in text:
        return _of_html(text)
    if "text/markdown" in data:
        return _of_markdown(_joined(data["text/markdown"]))
    return "" if "application/json" in data else _ANSI.sub("", _joined(data.get("text/plain")))


def _of_html(text: str) -> str:
    hidden = re.compile(r"<(\w+)\b[^>]*(?:display:\s*none|\shidden\b)[^>]*>.*?</\1\s*>", re.DOTALL)
    text = re.sub(r"<(option|textarea)\b.*?</\1\s*>", " ", _UNSEEN.sub(" ", hidden.sub(" ", text)), flags=re.DOTALL)
    return html.unescape(_without_tags(_MATH.sub(" ", text)))


def _without_tags(text: str) -> str:
    """Without the tags of HTML; other names in angle brackets are words."""

    def tag(found: re.Match[str]) -> str:
        name = found[1].lower()
        return " " if name in _HTML_NAMES or "-" in name or ":" in name else found[0]

    return _TAG.sub(tag, text)


def _joined(text: Any) -> str:
    return "".join(text) if isinstance(text, list | tuple) else str(text or "")
