r"""``\ce{…}``: chemical formulas and equations, the common part of mhchem, as LaTeX mathematics.

>>> latex_of("2H2 + O2 -> 2H2O")
'2\\mathrm{H}_{2} + \\mathrm{O}_{2} \\longrightarrow 2\\mathrm{H}_{2}\\mathrm{O}'
>>> latex_of("SO4^2-")
'\\mathrm{SO}_{4}^{2-}'
"""

import re

ARROWS = {
    "<=>>": r"\rightleftharpoons",
    "<<=>": r"\rightleftharpoons",
    "<=>": r"\rightleftharpoons",
    "<->": r"\longleftrightarrow",
    "<-->": r"\rightleftarrows",
    "->": r"\longrightarrow",
    "<-": r"\longleftarrow",
    "=": "=",
}
_BONDS = {"-": "-", "=": "=", "#": r"\equiv"}
_ARROW = re.compile(r"(<=>>|<<=>|<=>|<-->|<->|->|<-)(?:\[([^\]]*)\])?(?:\[([^\]]*)\])?")
_ATOM = re.compile(
    r"(?P<math>\$[^$]*\$)"
    r"|(?P<script>[_^]\{[^{}]*\}|[_^][0-9]*[+-]?(?:[A-Za-z])?)"
    r"|(?P<charge>(?<=[A-Za-z0-9)\]}])[+-](?=$|[\s)\]},]))"
    r"|(?P<count>(?<=[A-Za-z)\]}])\d+)"
    r"|(?P<number>\d+(?:\.\d+)?(?:/\d+)?)"
    r"|(?P<letters>[A-Za-z]+)"
    r"|(?P<bond>(?<=[A-Za-z0-9)\]])[-=#](?=[A-Z(\[]))"
    r"|(?P<dot>\*|\.)"
    r"|(?P<command>\\[A-Za-z]+(?:\{[^{}]*\})*)"
    r"|(?P<other>.)",
    re.DOTALL,
)


def latex_of(source: str) -> str:
    """The LaTeX of a chemical formula or equation."""
    shown, at = "", 0
    for found in _ARROW.finditer(source):
        shown += _species(source[at : found.start()]) + " " + _arrow(*found.groups()) + " "
        at = found.end()
    return " ".join((shown + _species(source[at:])).split(" ")).strip()


def _arrow(kind: str, above: str | None, below: str | None) -> str:
    if not above and not below:
        return ARROWS[kind]
    over, under = (_species(part).strip() if part else "" for part in (above, below))
    if kind == "->":
        return rf"\xrightarrow{f'[{under}]' if under else ''}{{{over}}}"
    stacked = rf"\overset{{{over}}}{{{ARROWS[kind]}}}"
    return rf"\underset{{{under}}}{{{stacked}}}" if under else stacked


def _species(source: str) -> str:
    """One side of an equation: terms, with their numbers, scripts, charges and states."""
    return " ".join(_term(word) for word in source.split())


def _term(word: str) -> str:
    if word in ("+", "="):
        return word
    if word in ("v", "(v)"):
        return r"\downarrow"
    if word in ("^", "(^)"):
        return r"\uparrow"
    shown = ""
    for found in _ATOM.finditer(word):
        text = found[0]
        match found.lastgroup:
            case "math":
                shown += text.strip("$")
            case "script":
                inside = text[1:].strip("{}")
                shown += ("{}" if not shown else "") + f"{text[0]}{{{inside}}}"
            case "charge":
                shown += f"^{{{text}}}"
            case "count":
                shown += f"_{{{text}}}"
            case "number":
                over = text.split("/")
                shown += rf"\tfrac{{{over[0]}}}{{{over[1]}}}" if len(over) == 2 else text
            case "letters":
                shown += rf"\mathrm{{{text}}}"
            case "bond":
                shown += rf"{{{_BONDS[text]}}}"
            case "dot":
                shown += r"{\cdot}"
            case _:
                shown += text
    return shown
