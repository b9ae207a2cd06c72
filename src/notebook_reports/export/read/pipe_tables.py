r"""Pipe tables whose rows do not have as many cells as their head, made whole: nothing of a row is lost.

A bar in mathematics divides no cells, as in Jupyter; a short row gets empty cells; what a long row has too much stays
in its last cell.
"""

import re

_RULE = re.compile(r"^ {0,3}\|?[ \t]*:?-+:?[ \t]*(\|[ \t]*:?-+:?[ \t]*)*\|?[ \t]*$")
_MATH = re.compile(r"(?<![\\$])\$(?!\$)((?:\\.|[^$\\\n])+?)\$(?!\$)|\$\$((?:\\.|[^$\\\n])+?)\$\$")
_CODE = re.compile(r"(`+)(.+?)\1(?!`)")
_BAR = re.compile(r"(?<!\\)\|")


def with_whole_tables(source: str) -> str:
    """The Markdown with each row of its pipe tables as long as the table's head."""
    if "|" not in source:
        return source
    lines = source.split("\n")
    fenced = False
    for i in range(1, len(lines)):
        fenced ^= bool(re.match(r" {0,3}(```|~~~)", lines[i - 1]))
        if fenced or "|" not in lines[i - 1] or "-" not in lines[i] or not _RULE.match(lines[i]):
            continue
        width = len(_cells(lines[i]))
        if len(_cells(_without_bars_in_mathematics(lines[i - 1]))) != width:
            continue
        lines[i - 1] = _without_bars_in_mathematics(lines[i - 1])
        row = i + 1
        while row < len(lines) and lines[row].strip() and (_BAR.search(lines[row]) or width == 1):
            lines[row] = _of_width(_without_bars_in_mathematics(lines[row]), width)
            row += 1
    return "\n".join(lines)


def _without_bars_in_mathematics(line: str) -> str:
    def in_math(found: re.Match[str]) -> str:
        return re.sub(r"\\\|", r"\\Vert ", found[0]).replace("|", r"\vert ")

    def in_code(found: re.Match[str]) -> str:
        return _BAR.sub(r"\\|", found[0])

    return _MATH.sub(in_math, _CODE.sub(in_code, line)) if "$" in line or "`" in line else line


def _cells(line: str) -> list[str]:
    line = line.strip()
    line = line.removeprefix("|")
    line = line[:-1] if line.endswith("|") and not line.endswith("\\|") else line
    return _BAR.split(line)


def _of_width(line: str, width: int) -> str:
    cells = [cell.strip() for cell in _cells(line)]
    if len(cells) == width:
        return line
    cells = [*cells[: width - 1], r" \| ".join(cells[width - 1 :])] if len(cells) > width else cells
    return "| " + " | ".join([*cells, *[""] * (width - len(cells))]) + " |"
