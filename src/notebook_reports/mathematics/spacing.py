"""TeX's spaces between atoms (TeXbook, chapter 18), worked out once for all emitters.

Two deliberate differences: a growing parenthesis counts as opening and closing, not as TeX's inner, because f(x) needs
no space; and a brace below counts as ordinary, not as an operator, because a sign beside it is binary.

Both emitters know the class of every atom in its context, so a minus is unary or binary for the same reason in the PDF
and on the screen.
"""

from notebook_reports.mathematics import nodes as n

THIN, MEDIUM, THICK = 3 / 18, 4 / 18, 5 / 18
BARS = ("|", "‖")
_NEVER_IN_SCRIPTS = {MEDIUM, THICK}


def edges(node: n.Node) -> tuple[str, str] | None:
    """TeX's class of a node as seen from the left and from the right; None for spaces and switches."""
    match node:
        case n.Space() | n.StyleSwitch() | n.TagNode():
            return None
        case n.Symbol() | n.Classed() | n.Big() | n.Stack():
            return node.cls, node.cls
        case n.Operator():
            return "op", "op"
        case n.Arrow():
            return "rel", "rel"
        case n.Middle():
            return "close", "open"
        case n.Fenced() | n.MathArray():
            return _edge(node.left, "open"), _edge(node.right, "close")
        case n.Scripts():
            return edges(node.base) or ("ord", "ord")
        case _:
            return "ord", "ord"


def _edge(delimiter: str, cls: str) -> str:
    return "ord" if not delimiter or delimiter in BARS else cls


def classes(items: list[n.Node]) -> list[tuple[str, str] | None]:
    """The classes of a list's nodes after TeX's rule that a binary operator without two operands is ordinary."""
    found = [edges(item) for item in items]
    atoms = [(i, pair) for i, pair in enumerate(found) if pair]
    for place, (i, pair) in enumerate(atoms):
        if pair[0] != "bin":
            continue
        before = (found[atoms[place - 1][0]] or pair)[1] if place else None
        after = atoms[place + 1][1][0] if place + 1 < len(atoms) else None
        if before in (None, "bin", "op", "rel", "open", "punct") or after in (None, "rel", "close", "punct"):
            found[i] = ("ord", "ord")
    return found


def gap(left: str, right: str, script: bool = False) -> float:
    """The space in em that TeX puts between two neighbouring atoms.

    >>> gap("ord", "rel") == 5 / 18, gap("ord", "rel", script=True), gap("open", "ord")
    (True, 0.0, 0.0)
    """
    space = _gap(left, right)
    if script and (space in _NEVER_IN_SCRIPTS or left == "punct"):
        return 0.0
    return space


def _gap(left: str, right: str) -> float:
    if left == "punct":
        return THIN
    if left == "open" or right in ("close", "punct"):
        return 0.0
    if "rel" in (left, right):
        return 0.0 if left == right else THICK
    if "bin" in (left, right):
        return MEDIUM
    if left == "op":
        return 0.0 if right == "open" else THIN
    return THIN if right == "op" else 0.0
