"""What a notebook shows: tables, figures and numbered equations that carry their caption with them.

Each object displays itself in Jupyter (HTML, LaTeX, SVG) and puts the same content, as data, under a MIME type of
its own into the cell's output. The exporters read only that data, so a table is a table in the PDF too.

A cell of a table, a caption and a note are *inline text*: plain characters with mathematics between ``$`` signs
and code between backticks. Nothing else is markup. A dollar sign and a backtick that are meant are written with a
backslash before them, as `literal` does.
"""

import html
import io
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

TABLE_MIME = "application/vnd.loopbook.table+json"
FIGURE_MIME = "application/vnd.loopbook.figure+json"
EQUATION_MIME = "application/vnd.loopbook.equation+json"

ALIGNMENTS = ("left", "right", "center")


def number(value: float, digits: int = 5) -> str:
    """A number for a table cell: ``digits`` significant digits, no trailing noise, a real minus sign.

    Raises nothing for NaN or infinity: they are shown as such.

    >>> number(-0.000012345), number(8360.0), number(25194.1165), number(-0.0)
    ('−1.2345e−5', '8360', '25194', '0')
    """
    text = f"{float(value) or 0.0:.{digits}g}"  # zero has no sign
    if "e" in text:
        mantissa, exponent = text.split("e")
        text = f"{mantissa}e{int(exponent)}"
    return text.replace("-", "−").replace("inf", "∞")


def literal(text: str) -> str:
    r"""Plain characters, such as a name from data, as inline text: nothing in them is mathematics or code.

    >>> literal("$x^2$ in `W`")
    '\\$x^2\\$ in \\`W\\`'
    """
    return text.replace("$", "\\$").replace("`", "\\`")


@dataclass(frozen=True)
class Table:
    """A table with a caption.

    columns: head cells, inline text. rows: one sequence of inline texts per row (numbers are formatted by `number`).
    align: one of left, right, center per column; default left for the first column and right for the others.
    marks: per row "", "good", "note" or "bad"; colours the row's last cell. groups: so many of the first columns show a
    text only where it changes, and on paper again at the head of a page. anchors: per row
    the name that prose links to, as in ``[proof](#name)``, or "".
    Raises ValueError where a row has another length than the head.
    """

    columns: Sequence[str]
    rows: Sequence[Sequence[Any]]
    caption: str = ""
    align: Sequence[str] = ()
    notes: Sequence[str] = ()
    marks: Sequence[str] = ()
    extra: dict[str, Any] = field(default_factory=dict)
    groups: int = 0
    anchors: Sequence[str] = ()

    def __post_init__(self) -> None:
        cells = [[c if isinstance(c, str) else number(c) for c in row] for row in self.rows]
        for i, row in enumerate(cells):
            if len(row) != len(self.columns):
                raise ValueError(f"table row {i + 1} has {len(row)} cells, the head has {len(self.columns)}: {row}")
        align = list(self.align) or ["left"] + ["right"] * (len(self.columns) - 1)
        if len(align) != len(self.columns) or set(align) - set(ALIGNMENTS):
            raise ValueError(f"align takes one of {ALIGNMENTS} for each of {len(self.columns)} columns, got {align}")
        if self.marks and len(self.marks) != len(cells):
            raise ValueError(f"marks: {len(self.marks)} given for {len(cells)} rows")
        if self.anchors and len(self.anchors) != len(cells):
            raise ValueError(f"anchors: {len(self.anchors)} given for {len(cells)} rows")
        object.__setattr__(self, "rows", cells)
        object.__setattr__(self, "align", align)

    def data(self) -> dict[str, Any]:
        """The content under `TABLE_MIME`."""
        data = {
            "columns": list(self.columns),
            "rows": self.rows,
            "align": self.align,
            "caption": self.caption,
            "notes": list(self.notes),
            "marks": list(self.marks),
            **({"anchors": list(self.anchors)} if any(self.anchors) else {}),
        }
        return {**data, "groups": self.groups} if self.groups else data

    def repeats(self, y: int, x: int) -> bool:
        """Is the text of a cell that of the row above, in a column that shows it once?"""
        return x < self.groups and y > 0 and list(self.rows[y][: x + 1]) == list(self.rows[y - 1][: x + 1])

    def _html(self) -> str:
        def cell(tag: str, text: str, align: str, mark: str = "") -> str:
            css = f' class="loopbook-{mark}"' if mark else ""
            return f'<{tag}{css} style="text-align:{align}">{html.escape(text)}</{tag}>'

        head = "".join(cell("th", c, a) for c, a in zip(self.columns, self.align, strict=True))
        body = ""
        for i, row in enumerate(self.rows):
            mark = self.marks[i] if self.marks else ""
            last = len(row) - 1
            cells = []
            for j, (text, align) in enumerate(zip(row, self.align, strict=True)):
                cells.append(cell("td", "" if self.repeats(i, j) else text, align, mark if j == last else ""))
            body += f"<tr>{''.join(cells)}</tr>"
        notes = "".join(f"<p>{html.escape(n)}</p>" for n in self.notes)
        caption = f"<caption>{html.escape(self.caption)}</caption>" if self.caption else ""
        return f"<table>{caption}<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>{notes}"

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        plain = "\n".join("\t".join(r) for r in [list(self.columns), *self.rows])
        return {TABLE_MIME: self.data(), "text/html": self._html(), "text/plain": plain, **self.extra}


@dataclass(frozen=True)
class Equation:
    """A displayed equation, numbered where a document numbers it.

    latex: the mathematics without delimiters. label: the number shown at the right, for example "4.9", or "" for
    none. document: the document the number belongs to. anchor: what prose links to, ``[eq. 4.9](#eq-pid-report-4.9)``.
    """

    latex: str
    label: str = ""
    document: str = ""

    @property
    def anchor(self) -> str:
        return f"eq-{self.document}-{self.label}" if self.label else ""

    def data(self) -> dict[str, Any]:
        return {"latex": self.latex, "label": self.label, "document": self.document, "anchor": self.anchor}

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        tag = rf" \tag{{{self.label}}}" if self.label else ""
        return {
            EQUATION_MIME: self.data(),
            "text/latex": f"$${self.latex}{tag}$$",
            "text/plain": self.latex,
        }


def equation(expression: Any, label: str = "", document: str = "", left: str = "") -> Equation:
    """Show a SymPy expression, an equality or LaTeX text as a displayed equation, a list of equalities as a column.

    left: LaTeX of what an expression is.

    >>> import sympy
    >>> equation(sympy.Symbol("T_f") / 2, "4.8", "pid-report").latex
    '\\\\frac{T_{f}}{2}'
    >>> equation(sympy.Symbol("h") / 2, left="T_f").latex
    'T_f = \\\\frac{h}{2}'
    >>> equation([sympy.Eq(*sympy.symbols("a b")), sympy.Eq(*sympy.symbols("c d"))]).latex
    '\\\\begin{aligned}a &= b \\\\\\\\ c &= d\\\\end{aligned}'
    """
    before = f"{left} = " if left else ""
    if isinstance(expression, str):
        return Equation(before + expression, label, document)
    import sympy

    if not isinstance(expression, list | tuple):
        return Equation(before + sympy.latex(expression), label, document)
    lines = (f"{sympy.latex(law.lhs)} &= {sympy.latex(law.rhs)}" for law in expression)
    return Equation(r"\begin{aligned}" + r" \\ ".join(lines) + r"\end{aligned}", label, document)


@dataclass(frozen=True)
class Prose:
    """A paragraph in Markdown whose numbers were computed."""

    text: str

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        return {"text/markdown": self.text, "text/plain": self.text}


def prose(text: str) -> Prose:
    """Show a paragraph in Markdown, its numbers computed; a cell tagged ``remove-input`` is prose on the page.

    >>> prose(f"The power for one kelvin is {number(8360.0)} W.").text
    'The power for one kelvin is 8360 W.'
    """
    return Prose(text)


@dataclass(frozen=True)
class Listing:
    """Program text or data to be read and copied: shown as it is, in a fixed-width font."""

    text: str

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        return {"text/plain": self.text}


@dataclass(frozen=True)
class Figure:
    """A vector figure with its caption and the alternative text read to those who do not see it.

    Raises ValueError where the caption or the alternative text is empty.
    """

    svg: str
    caption: str
    alt: str

    def __post_init__(self) -> None:
        for name in ("caption", "alt"):
            if not getattr(self, name).strip():
                raise ValueError(f"a figure needs a {name}: one sentence that says what it shows")

    def data(self) -> dict[str, Any]:
        return {"caption": self.caption, "alt": self.alt}

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        return {FIGURE_MIME: self.data(), "image/svg+xml": self.svg, "text/plain": f"Figure: {self.caption}"}


def figure(fig: Any, caption: str, alt: str) -> Figure:
    """Turn a matplotlib figure into a captioned vector figure and close it.

    The SVG keeps text as text (searchable, small) and carries no date and no random ids. A figure whose layout keeps
    everything on it (constrained, tight) is drawn once, as large as it is; any other is cut to what is drawn.
    """
    import matplotlib as mpl
    import matplotlib.pyplot as plt
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    buffer = io.StringIO()
    told = {"Date": None, "Creator": None}
    with mpl.rc_context({"svg.fonttype": "none", "svg.hashsalt": "loopbook"}):
        if fig.get_layout_engine() is None:
            fig.savefig(buffer, format="svg", metadata=told, bbox_inches="tight")
        else:
            FigureCanvasSVG(fig).print_svg(buffer, metadata=told)
    plt.close(fig)
    return Figure(buffer.getvalue(), caption, alt)
