"""GIFT: a question for each number and choice of each variant, in Moodle's text format."""

import re

from loopbook.course.exports.variants import WEAKER, Variant, left_out, parts, plain_text
from loopbook.course.kinds.choice import Choice
from loopbook.course.notebooks import source_of

_SPECIAL = re.compile(r"([~=#{}:\\])")


def gift(sheet: str, variants: list[Variant]) -> bytes:
    """The file. Figures are not in it: GIFT has no files."""
    lines = [f"// {WEAKER.format(sheet=sheet)}", f"$CATEGORY: $course$/top/loopbook/{sheet}", ""]
    if missing := left_out(variants[0]):
        lines.insert(1, f"// Not asked here: {', '.join(missing)}.")
    for variant in variants:
        for place, cell, asked in variant.questions():
            text = f"{plain_text(variant.intro)}\n\n{source_of(cell)}"
            for one in asked:
                title = f"{sheet}, variant {variant.number}, question {place}, {one.name}"
                for part in parts(one):
                    named = title if part.label == one.name else f"{title}, {part.label}"
                    said = text if part.label == one.name else f"{text}\n\n{one.name}, {part.label}:"
                    lines.append(_question(named, said, f"#{part.key!r}:{part.width:.6g}"))
                if isinstance(one.kind, Choice):
                    options = (("=" if o == one.key[0] else "~") + in_gift(o) for o in one.kind.options)
                    lines.append(_question(title, text, " ".join(options)))
    return "\n".join(lines).encode()


def _question(title: str, text: str, answer: str) -> str:
    without = re.sub(r"!\[([^\]]*)\]\(attachment:[^)]*\)", r"(\1)", text)
    return f"::{in_gift(title)}::[markdown]{in_gift(without).replace(chr(10), chr(92) + 'n')}{{{answer}}}\n"


def in_gift(text: str) -> str:
    """A text in which GIFT finds no sign of its own.

    >>> in_gift("a{b} = c")
    'a\\\\{b\\\\} \\\\= c'
    """
    return _SPECIAL.sub(r"\\\1", text)
