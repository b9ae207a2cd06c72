"""Moodle XML: for each variant the whole sheet as one cloze question, and what stands alone as numerical questions.

Tolerances are absolute; a named wrong method is an answer without points whose feedback names it. Each question of the
sheet has a category of its own with its variants, so that a quiz draws one of them at random.
"""

import re
from collections.abc import Iterator
from html import escape
from typing import Any
from xml.etree.ElementTree import Element, SubElement, tostring

from loopbook.course.exports.variants import (
    WEAKER,
    AnswerNumber,
    Variant,
    asking,
    left_out,
    parts,
    plain_text,
    stands_alone,
)
from loopbook.course.kinds.choice import Choice
from loopbook.course.notebooks import Cell
from loopbook.course.question import Asked

_IN_CLOZE = re.compile(r'([\\}~#/"])')


def moodle(sheet: str, variants: list[Variant]) -> bytes:
    """The file to be imported into a question bank."""
    quiz = Element("quiz")
    about = WEAKER.format(sheet=sheet)
    missing = left_out(variants[0])
    about += f" Not asked here: {', '.join(missing)}." if missing else ""
    _category(quiz, f"{sheet}/whole sheet", about)
    for variant in variants:
        _cloze(quiz, f"{sheet}, variant {variant.number}", variant)
    for place, name in _alone(variants[0]):
        _category(quiz, f"{sheet}/question {place}, {name}", about)
        for variant in variants:
            _numerical(quiz, f"{sheet}, question {place}, {name}, variant {variant.number}", variant, place, name)
    return b'<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(quiz, encoding="utf-8") + b"\n"


def _alone(variant: Variant) -> list[tuple[int, str]]:
    """(question, answer) of each single number that needs no earlier answer."""
    return [
        (place, a.name)
        for place, _, asked in variant.questions()
        for a in asked
        if len(parts(a)) == 1 and stands_alone(variant, a)
    ]


def _category(quiz: Element, name: str, about: str) -> None:
    question = SubElement(quiz, "question", type="category")
    _text(SubElement(question, "category"), f"$course$/top/loopbook/{name}")
    _text(SubElement(question, "info", format="html"), about)


def _text(parent: Element, text: str) -> None:
    SubElement(parent, "text").text = text


def _question(quiz: Element, kind: str, name: str, html: str, cells: list[Cell]) -> Element:
    question = SubElement(quiz, "question", type=kind)
    _text(SubElement(question, "name"), name)
    body = SubElement(question, "questiontext", format="html")
    _text(body, html)
    for file, data in _files(cells):
        SubElement(body, "file", name=file, path="/", encoding="base64").text = data
    return question


def _numerical(quiz: Element, name: str, variant: Variant, place: int, answer: str) -> None:
    _, cell, asked = next(q for q in variant.questions() if q[0] == place)
    one = next(a for a in asked if a.name == answer)
    part = parts(one)[0]
    text = f"{plain_text(variant.intro)}\n\n{asking(cell)}"
    question = _question(quiz, "numerical", name, as_html(text), [*variant.intro, cell])
    SubElement(question, "defaultgrade").text = f"{one.points:g}"
    _answer(question, 100, part.key, part.width, "")
    for method, value in part.wrong:
        _answer(question, 0, value, part.width, f"That is the value with this mistake: {method}.")


def _answer(question: Element, fraction: int, key: float, width: float, feedback: str) -> None:
    answer = SubElement(question, "answer", fraction=str(fraction), format="moodle_auto_format")
    _text(answer, repr(key))
    SubElement(answer, "tolerance").text = f"{width:.6g}"
    if feedback:
        _text(SubElement(answer, "feedback", format="html"), feedback)


def _cloze(quiz: Element, name: str, variant: Variant) -> None:
    texts = [as_html(plain_text(variant.intro))]
    cells = [*variant.intro]
    for _, cell, asked in variant.questions():
        cells.append(cell)
        fields = [field for a in asked for field in _fields(a)]
        texts.append(as_html(asking(cell)) + "".join(f"<p>{field}</p>" for field in fields))
    _question(quiz, "cloze", name, "\n".join(texts), cells)


def _fields(asked: Asked) -> Iterator[str]:
    if isinstance(asked.kind, Choice):
        keys = [(option, option == asked.key[0]) for option in asked.kind.options]
        yield f"{_shown(asked.name)}: {_choice(keys, asked.points)}"
        if asked.kind.reasons:
            reasons = [(reason, letter == asked.key[1]) for letter, reason in asked.kind.letters.items()]
            yield f"because {_choice(reasons, asked.points)}"
        return
    found = parts(asked)
    unit = f" {_shown(asked.kind.unit)}" if asked.kind.unit else ""
    for part in found:
        label = _shown(asked.name if len(found) == 1 else f"{asked.name}, {part.label}")
        yield f"{label} = {_number(part, asked.points / len(found))}{unit}"


def _number(part: AnswerNumber, points: float) -> str:
    wrong = "".join(f"~%0%{value!r}:{part.width:.6g}#{in_cloze(method)}" for method, value in part.wrong)
    return f"{{{max(1, round(points))}:NUMERICAL:={part.key!r}:{part.width:.6g}{wrong}}}"


def _choice(options: list[tuple[str, bool]], points: float) -> str:
    shown = "~".join(("=" if right else "") + in_cloze(_shown(option)) for option, right in options)
    return f"{{{max(1, round(points))}:MULTICHOICE_V:{shown}}}"


def in_cloze(text: str) -> str:
    """A text inside the braces of a cloze field.

    >>> in_cloze("a = {b}~c")
    'a = {b\\\\}\\\\~c'
    """
    return _IN_CLOZE.sub(r"\\\1", text)


def _shown(text: str) -> str:
    return escape(text, quote=False)


def _files(cells: list[Cell]) -> Iterator[tuple[str, str]]:
    for cell in cells:
        for name, bundle in (cell.get("attachments") or {}).items():
            for data in bundle.values():
                yield name, data


def as_html(markdown: str) -> str:
    """Markdown as HTML whose formulas stand as MathJax of Moodle reads them; drawings are files of the question.

    >>> as_html("$a<b$ is **so**")
    '<p>\\\\(a&lt;b\\\\) is <strong>so</strong></p>'
    """
    import mistune

    kept: list[str] = []

    def keep(found: re.Match[str]) -> str:
        opening, closing = ("\\[", "\\]") if found[1] else ("\\(", "\\)")
        kept.append(opening + escape(found[1] or found[2], quote=False) + closing)
        return f"\x02{len(kept) - 1}\x03"

    held = re.sub(r"\$\$(.+?)\$\$|(?<!\\)\$([^$\n]+?)\$", keep, markdown, flags=re.DOTALL)
    read: Any = mistune.create_markdown(plugins=["table"], escape=False)
    made = str(read(held)).replace('src="attachment:', 'src="@@PLUGINFILE@@/').strip()
    return re.sub("\x02(\\d+)\x03", lambda m: kept[int(m[1])], made)
