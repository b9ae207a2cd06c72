"""Docstrings as reStructuredText: they are plain text, in which indented blocks and examples stand as they are."""

import re
from collections.abc import Iterator, Sequence

MARKS = re.compile(r"([*|\\])|(?<=\w)(_)(?!\w)|(?<=\w)(__?)(?=\s|$)")
CODE = re.compile(r"(``[^`]+``|`[^`\n]+`)")


def as_rst(lines: Sequence[str]) -> list[str]:
    """The lines of a docstring as reStructuredText.

    Examples (``>>>``) stay, indented blocks become literal ones, in prose every mark but back quotes is a character.

    >>> as_rst(["G = a*b, see `Loop`.", "", "    x = |y|", "", ">>> 1 * 1", "1"])
    ['G = a\\\\*b, see ``Loop``.', '', '::', '', '    x = |y|', '', '>>> 1 * 1', '1']
    """
    found: list[str] = []
    for kind, block in _blocks(lines):
        if kind == "literal":
            found += ["::", ""]
        found += [_prose(line) for line in block] if kind == "prose" else block
        found += [""]
    return found[:-1]


def _blocks(lines: Sequence[str]) -> Iterator[tuple[str, list[str]]]:
    """Paragraphs with what they are: prose, literal (indented) or example."""
    block: list[str] = []
    for line in [*lines, ""]:
        if line.strip():
            kind = _kind(line)
            if block and kind != _kind(block[0]) and "example" not in (_kind(block[0]),):
                yield _kind(block[0]), block
                block = []
            block.append(line.rstrip())
        elif block:
            yield _kind(block[0]), block
            block = []


def _kind(line: str) -> str:
    return "example" if line.lstrip().startswith(">>>") else "literal" if line.startswith(" ") else "prose"


def _prose(line: str) -> str:
    parts = CODE.split(line)
    return "".join(f"``{p.strip('`')}``" if CODE.fullmatch(p) else MARKS.sub(_escaped, p) for p in parts)


def _escaped(match: re.Match) -> str:
    return "".join("\\" + c for c in match.group())
