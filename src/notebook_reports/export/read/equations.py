r"""Numbers of equations as AMS-LaTeX and Jupyter give them, and the references to them.

``equation``, ``align``, ``gather`` and their kin are numbered, row by row; starred ones and rows with ``\notag`` are
not. ``\eqref{key}`` and ``\ref{key}``, in text and in formulas, show the number of the equation with ``\label{key}``.
"""

import re

from notebook_reports.export.errors import CannotShow
from notebook_reports.export.model import Display, Inline, Link, Math, Mend, Report, Text, rewrite, walk
from notebook_reports.export.read.reading import Reading

ONE_NUMBER = ("equation", "multline")
NUMBERED_ROWS = ("align", "alignat", "flalign", "gather", "eqnarray")
_WHOLE = re.compile(rf"\\begin\{{({'|'.join(ONE_NUMBER + NUMBERED_ROWS)})\}}(.*)\\end\{{\1\}}", re.DOTALL)
_LABEL = re.compile(r"\\label\s*\{([^}]*)\}")
_OWN = re.compile(r"\\(?:tag\*?|notag|nonumber)(?![A-Za-z])")
_REFERENCE = re.compile(r"\\(eqref|ref)\s*\{([^}]*)\}")

Place = tuple[str, str]
"""The number and the anchor of an equation."""


def number_equations(report: Report) -> dict[str, Place]:
    """Give numbers to the equations of a report that ask for one; the place of each label."""
    places: dict[str, Place] = {}
    count = 0
    for cell in report.cells:
        for node in walk(cell):
            if isinstance(node, Display):
                count = _number(node, count, report.document, places)
    return places


def _number(node: Display, count: int, document: str, places: dict[str, Place]) -> int:
    whole = _WHOLE.fullmatch(node.latex.strip())
    labels = _LABEL.findall(node.latex)
    if not whole and not labels:
        return count
    rows = rows_of(whole[2]) if whole and whole[1] in NUMBERED_ROWS else [node.latex]
    solid = [row for row in rows if row.strip()]
    if len(solid) <= 1 or not whole:
        wanted = not node.label and not _OWN.search(node.latex)
        count += wanted
        node.label = str(count) if wanted else node.label
        node.latex = _LABEL.sub("", node.latex)
        node.anchor = node.anchor or (_anchor(document, node.label or labels[0]) if node.label or labels else "")
        places.update((key, (node.label or "?", node.anchor)) for key in labels)
        return count
    shown = []
    for row in rows:
        keys = _LABEL.findall(row)
        row = _LABEL.sub("", row)
        own = re.search(r"\\tag\*?\s*\{([^}]*)\}", row)
        if row.strip() and not _OWN.search(row):
            count += 1
            places.update((key, (str(count), _anchor(document, str(count)))) for key in keys)
            node.anchor = node.anchor or _anchor(document, str(count))
            row = rf"{row.rstrip()} \tag{{{count}}} "
        elif keys:
            places.update((key, (own[1] if own else "?", node.anchor)) for key in keys)
        shown.append(row)
    begin, end = node.latex.index(whole[2]), node.latex.index(whole[2]) + len(whole[2])
    node.latex = node.latex[:begin] + r"\\".join(shown) + node.latex[end:]
    places.update((key, (number, node.anchor)) for key, (number, _) in places.items() if key in labels)
    return count


def _anchor(document: str, label: str) -> str:
    return "-".join(part for part in ("eq", document, label) if part)


def rows_of(body: str) -> list[str]:
    r"""The rows of an environment.

    >>> rows_of(r"a \\ \begin{matrix} b \\ c \end{matrix} \\ {d \\ e}")
    ['a ', ' \\begin{matrix} b \\\\ c \\end{matrix} ', ' {d \\\\ e}']
    """
    rows, depth = [""], 0
    for token in re.findall(r"\\begin\b|\\end\b|\\\\|\\.|[^\\]", body, re.DOTALL):
        depth += (token in ("{", "\\begin")) - (token in ("}", "\\end"))
        if token == "\\\\" and depth == 0:
            rows.append("")
        else:
            rows[-1] += token
    return rows


def settle_references(report: Report, places: dict[str, Place], reading: Reading) -> None:
    """Put the numbers of equations where the text refers to them."""

    def in_formula(found: re.Match[str]) -> str:
        number = places.get(found[2], ("???", ""))[0]
        return rf"\text{{({number})}}" if found[1] == "eqref" else rf"\text{{{number}}}"

    def shown(node: object) -> list[Inline] | None:
        if isinstance(node, Math | Display):
            node.latex = _REFERENCE.sub(in_formula, node.latex)
            alone = isinstance(node, Math) and re.fullmatch(r"\\text\{(\(?[^()}]*\)?)\}", node.latex)
            return [Text(alone[1])] if alone else None
        if isinstance(node, Text) and _REFERENCE.search(node.text):
            return reading.attempt(lambda: _linked(node.text, places, reading))
        return None

    for cell in report.cells:
        reading.cell = cell.number
        rewrite(cell, shown)


def _linked(text: str, places: dict[str, Place], reading: Reading) -> list[Inline]:
    nodes: list[Inline] = []
    at = 0
    for found in _REFERENCE.finditer(text):
        number, anchor = places.get(found[2], ("???", ""))
        if not anchor and not reading.mending:
            raise CannotShow(f"a reference to \\label{{{found[2]}}}, which no equation has")
        words = Text(f"({number})" if found[1] == "eqref" else number)
        nodes += [Text(text[at : found.start()]), Link(f"#{anchor}", [words]) if anchor else words]
        if not anchor:
            nodes.append(Mend("link", "it refers to an equation that is nowhere", "", found[2], remark=True))
        at = found.end()
    return [node for node in [*nodes, Text(text[at:])] if not isinstance(node, Text) or node.text]
