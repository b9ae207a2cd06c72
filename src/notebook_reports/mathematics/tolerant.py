r"""Formulas that are no valid LaTeX and that browsers show all the same: how MathJax reads them.

Lines without an environment stand below each other, a character that is no mathematics is text.
"""

import re
from collections.abc import Iterator

from notebook_reports.mathematics.errors import MathError
from notebook_reports.mathematics.tree import tree

_PROTECTED = re.compile(
    r"\\(?:text\w*|mbox|hbox|operatorname\*?|tag\*?|label|ce|SI|si|num|qty|unit)\s*\{[^{}]*\}|\\[A-Za-z]+|\\.",
    re.DOTALL,
)
_ARRAY = re.compile(r"\\begin\{(array|subarray)\}\s*(?:\[\w*\]\s*)?\{((?:[^{}]|\{[^{}]*\})*)\}")
_STRANGE = re.compile(r"[^\x00-\x7f]+")


def readings(latex: str) -> Iterator[str]:
    """The formula itself, then what else it may be meant to be, the most likely first."""
    yield latex
    bare = _cleaned(latex)
    if bare != latex:
        yield bare
    wide = _with_columns(bare)
    if wide != bare:
        yield wide
        bare = wide
    lines = _in_lines(bare)
    if lines:
        yield lines
    textual = _with_text(lines or bare)
    if textual != (lines or bare):
        yield textual
    closed = _closed(textual)
    if closed != textual:
        yield closed


def _cleaned(latex: str) -> str:
    """Without dollars around, empty groups of alignment, and line ends at the end."""
    latex = latex.strip().strip("$").strip()
    latex = re.sub(r"(?:\\\\(?:\[[^\]]*\])?\s*)+$", "", latex)
    return re.sub(
        r"\\begin\{(equation|displaymath|math)(\*?)\}|\\end\{(equation|displaymath|math)\*?\}", " ", latex
    ).strip()


def _with_columns(latex: str) -> str:
    r"""Arrays with as many columns as their rows have cells, of the kinds that the converter knows."""
    at = 0
    while found := _ARRAY.search(latex, at):
        spec = re.sub(r"\*\{(\d+)\}\{([^{}]*)\}", lambda m: m[2] * min(int(m[1]), 50), found[2])
        spec = re.sub(r"[@!<>]\{[^{}]*\}|\[[^\]]*\]", "", spec)
        spec = re.sub(r"[pmbX]\{[^{}]*\}|X", "l", spec)
        spec = re.sub(r"[^lcr|]", "", re.sub(r"[A-Zd-ksz]", "c", spec))
        cells = _most_cells(latex[found.end() :])
        missing = cells - len(spec.replace("|", ""))
        last = spec.replace("|", "")[-1:] or "c"
        spec += last * max(0, missing)
        latex = f"{latex[: found.start()]}\\begin{{array}}{{{spec}}}{latex[found.end() :]}"
        at = found.start() + len("\\begin{array}{}") + len(spec)
    return latex


def _most_cells(body: str) -> int:
    """The cells of the longest row of an environment whose content begins here."""
    most, cells, depth = 1, 1, 0
    for token in re.findall(r"\\begin\b|\\end\b|\\\\|\\.|[^\\]", body, re.DOTALL):
        depth += (token in ("{", "\\begin")) - (token in ("}", "\\end"))
        if token == "\\end" and depth < 0:
            break
        if depth == 0 and token == "&":
            cells += 1
        elif depth == 0 and token == "\\\\":
            cells = 1
        most = max(most, cells)
    return most


def _in_lines(latex: str) -> str:
    r"""Lines that no environment holds, in one: ``a \\ b``, ``a &= b \\ c &= d``."""
    depth, breaks, marks = 0, False, False
    for token in re.findall(r"\\begin\b|\\end\b|\\\\|\\.|[^\\]", latex, re.DOTALL):
        depth += (token in ("{", "\\begin")) - (token in ("}", "\\end"))
        if depth == 0:
            breaks |= token == "\\\\"
            marks |= token == "&"
    if not breaks and not marks:
        return ""
    name = "aligned" if marks else "gathered"
    return rf"\begin{{{name}}}{latex}\end{{{name}}}"


def _with_text(latex: str) -> str:
    """Characters beyond ASCII that the converter does not know as text."""

    def known(char: str) -> bool:
        try:
            tree(char)
        except MathError:
            return False
        return True

    def mend(found: re.Match[str]) -> str:
        if all(known(char) for char in found[0]):
            return found[0]
        return rf"\text{{{found[0]}}}"

    out, at = "", 0
    for kept in _PROTECTED.finditer(latex):
        out += _STRANGE.sub(mend, latex[at : kept.start()]) + kept[0]
        at = kept.end()
    return out + _STRANGE.sub(mend, latex[at:])


def _closed(latex: str) -> str:
    """With the braces that are never closed."""
    bare = re.sub(r"\\.", "", latex, flags=re.DOTALL)
    missing = bare.count("{") - bare.count("}")
    return latex + "}" * missing if missing > 0 else latex
