"""The tree as MathML Core, the part of MathML that Firefox, Chromium and Safari draw themselves.

Every operator carries its spaces where they differ from the browsers' operator dictionary, and says whether it
stretches, so that all browsers set the same formula.
"""

from html import escape

from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics import symbols
from notebook_reports.mathematics.spacing import MEDIUM, THICK, classes, gap

# MathML Core's operator dictionary for the commonest operators: the spaces on both sides in infix form.
_DICTIONARY = {
    **dict.fromkeys("=<>≤≥≠≈≡∼≃≅∝∈∉⊂⊃⊆⊇→⇒⇔", (THICK, THICK)),
    **dict.fromkeys("+−±∓", (MEDIUM, MEDIUM)),
}
_IDENTIFIERS = set("∞∂∇∅ℵ℘ℏ℧∀∃∄⊤⊥°′∠△□◇★%#&$@…⋯⋮⋱⋰.?")
_MOVABLE = {True: ' movablelimits="true"', False: ' movablelimits="false"'}
_STRETCHY = set("()[]{}|‖⟨⟩⌊⌋⌈⌉")
_STYLE = {
    "display": 'displaystyle="true" scriptlevel="0"',
    "text": 'displaystyle="false" scriptlevel="0"',
    "script": 'displaystyle="false" scriptlevel="1"',
    "sscript": 'displaystyle="false" scriptlevel="2"',
}
_TEXT = {
    "bold": ' style="font-weight:bold"',
    "italic": ' style="font-style:italic"',
    "mono": ' style="font-family:monospace"',
    "sans": ' style="font-family:sans-serif"',
}
_STROKES = {
    "cancel": ("to top right",),
    "bcancel": ("to bottom right",),
    "xcancel": ("to top right", "to bottom right"),
    "sout": ("to top",),
}


def emit(items: list[n.Node], display: bool) -> str:
    """A complete ``<math>`` element."""
    attribute = ' display="block"' if display else ""
    return f'<math xmlns="http://www.w3.org/1998/Math/MathML"{attribute}>{_row(items)}</math>'


def _number(value: float) -> str:
    return f"{value:.4f}".rstrip("0").rstrip(".") or "0"


def _mo(char: str, cls: str, spaces: tuple[float, float], stretchy: bool = False, extra: str = "") -> str:
    """An operator with its spaces in em. Its form follows from its class, not from where it happens to stand."""
    form = {"open": "prefix", "op": "prefix", "close": "postfix", "ord": "prefix" if char in "+−±∓" else ""}.get(
        cls, "infix"
    )
    if form == "infix":
        default = _DICTIONARY.get(char)
    else:
        default = (0.0, 0.0) if form and (char in _STRETCHY or char in "+−±∓") else None
    space = "" if spaces == default else f' lspace="{_em(spaces[0])}" rspace="{_em(spaces[1])}"'
    stretch = ""
    if stretchy:
        stretch = ' stretchy="true" symmetric="true"'
    elif _may_stretch(char) and "stretchy" not in extra:
        stretch = ' stretchy="false"'
    shown_form = f' form="{form}"' if form else ""
    return f"<mo{shown_form}{space}{stretch}{extra}>{escape(char)}</mo>"


def _may_stretch(char: str) -> bool:
    return char in _STRETCHY or "←" <= char <= "⇿" or "⟰" <= char <= "⟿" or char in "/\\^~¯"


def _em(value: float) -> str:
    return f"{_number(value)}em" if value else "0"


def _mspace(em: float) -> str:
    return f'<mspace width="{_em(em)}"/>'


def _row(items: list[n.Node], script: bool = False) -> str:
    """A list as exactly one element."""
    parts = _from(0, items, classes(items), None, script)
    return parts[0] if len(parts) == 1 else f"<mrow>{''.join(parts)}</mrow>"


def _from(start: int, items: list[n.Node], found: list, before: int | None, script: bool) -> list[str]:
    """The elements of a list from a place on. TeX's space between two atoms goes to the operator among them."""
    parts: list[str] = []
    for i in range(start, len(items)):
        item, pair = items[i], found[i]
        if isinstance(item, n.Space):
            parts.append(_mspace(item.em))
            continue
        if isinstance(item, n.StyleSwitch):
            rest = "".join(_from(i + 1, items, found, before, script or "script" in item.style))
            return [*parts, f"<mstyle {_STYLE[item.style]}>{rest}</mstyle>"]
        if pair is None:
            parts.append(_node(item, "ord", script, (0.0, 0.0)))
            continue
        left = 0.0
        if before is not None and not _is_operator(items[before]):
            left = gap(found[before][1], pair[0], script)
        right = 0.0
        if _is_operator(item):
            after = next((p for p in found[i + 1 :] if p), None)
            right = gap(pair[1], after[0], script) if after else 0.0
        elif left:
            parts.append(_mspace(left))
        parts.append(_node(item, pair[0], script, (left, right)))
        before = i
    return parts


def _is_operator(node: n.Node) -> bool:
    """Whether the node's element takes lspace and rspace."""
    match node:
        case n.Symbol():
            return not _is_identifier(node)
        case n.Operator():
            return _operator_text(node) is not None
        case n.Scripts():
            return _is_operator(node.base)
        case n.Stack():
            return len(node.base) == 1 and _is_operator(node.base[0])
        case n.Big():
            return bool(node.char)
        case _:
            return isinstance(node, n.Arrow)


def _is_identifier(node: n.Symbol) -> bool:
    return node.upright or (node.cls == "ord" and (node.char[0].isalpha() or node.char in _IDENTIFIERS))


def _operator_text(node: n.Operator) -> str | None:
    """The name of an operator with limits, if it is plain text."""
    if not node.limits or not all(isinstance(part, n.Word | n.Space) for part in node.name):
        return None
    return "".join(part.text if isinstance(part, n.Word) else "\u2009" for part in node.name)


def _node(node: n.Node, cls: str, script: bool, spaces: tuple[float, float] = (0.0, 0.0)) -> str:
    """One node as one element. cls: its class in its context. spaces: for operators, in em."""
    match node:
        case n.Symbol():
            return _symbol(node, cls, spaces)
        case n.Number():
            return f"<mn>{node.text}</mn>"
        case n.Word():
            return _identifier(node.text, upright=True)
        case n.MathText():
            return f"<mtext{_TEXT.get(node.variant, '')}>{_hard_spaces(node.text)}</mtext>"
        case n.Group() | n.Classed():
            return _row(node.items, script)
        case n.Scripts():
            return _scripts(node, cls, script, spaces)
        case n.Fraction():
            line = "" if node.line else ' linethickness="0"'
            body = f"<mfrac{line}>{_row(node.num, script)}{_row(node.den, script)}</mfrac>"
            return f"<mstyle {_STYLE[node.style]}>{body}</mstyle>" if node.style else body
        case n.Root():
            body = _row(node.body, script)
            return f"<msqrt>{body}</msqrt>" if node.index is None else f"<mroot>{body}{_row(node.index, True)}</mroot>"
        case n.Fenced():
            return _fenced(node.left, _row(node.items, script), node.right, not _is_low(node.items))
        case n.Middle():
            return _mo(node.char, "rel", (0.0, 0.0), stretchy=True) if node.char else "<mrow></mrow>"
        case n.Big():
            size = f' minsize="{_em(node.em)}" maxsize="{_em(node.em)}"'
            return _mo(node.char, cls, spaces, stretchy=True, extra=size) if node.char else "<mrow></mrow>"
        case n.Accent():
            return _accent(node, script)
        case n.Line():
            side = "top" if node.over else "bottom"
            style = f"border-{side}:0.06em solid;padding-{side}:0.12em"
            return f'<mrow style="{style}">{_row(node.body, script)}</mrow>'
        case n.Brace():
            return _brace(node, script)
        case n.Stack():
            base = node.base
            core = _node(base[0], cls, script, spaces) if _is_operator(node) else _row(base, script)
            return _around(core, node.under, node.over)
        case n.Arrow():
            return _around(_mo(node.char, "rel", spaces, extra=' stretchy="true"'), node.under, node.over, padded=True)
        case n.Operator():
            text = _operator_text(node)
            if text is not None:
                return _mo(text, "op", spaces, extra=' movablelimits="true"')
            return _row(node.name, script)
        case n.MathArray():
            return _fenced(node.left, _grid(node), node.right) if node.left or node.right else _grid(node)
        case n.Phantom():
            hidden = f"<mphantom>{_row(node.body, script)}</mphantom>"
            if node.width and node.height:
                return hidden
            size = 'height="0" depth="0"' if node.width else 'width="0"'
            return f"<mpadded {size}>{hidden}</mpadded>"
        case n.Boxed():
            return f'<mrow style="border:0.05em solid;padding:0.3em">{_row(node.body, script)}</mrow>'
        case n.Cancel():
            return f'<mrow style="background:{_strokes(node.kind)}">{_row(node.body, script)}</mrow>'
        case n.Colored():
            return f'<mrow style="color:{node.color}">{_row(node.body, script)}</mrow>'
        case n.Sized():
            return f'<mrow style="font-size:{_em(node.factor)}">{_row(node.body, script)}</mrow>'
        case n.TagNode():
            return f"<mrow>{_mspace(2.0)}<mtext>{_hard_spaces(node.tag.text)}</mtext></mrow>"
    raise TypeError(f"no MathML form for {type(node).__name__}")


def _hard_spaces(text: str) -> str:
    """XML trims the blanks at the ends of a text."""
    return escape(text.replace(" ", "\u00a0"), quote=False)


def _identifier(text: str, upright: bool) -> str:
    """One letter is italic by itself, a word is upright by itself."""
    normal = ' mathvariant="normal"' if upright and len(text) == 1 else ""
    return f"<mi{normal}>{escape(text, quote=False)}</mi>"


def _symbol(node: n.Symbol, cls: str, spaces: tuple[float, float]) -> str:
    if _is_identifier(node):
        return _identifier(node.char, node.upright or not (node.char[0].isalpha() or node.char == "∂"))
    return _mo(node.char, cls, spaces, extra=' largeop="true"' + _MOVABLE[node.limits] if node.large else "")


def _is_low(items: list[n.Node]) -> bool:
    """Is a list no taller than a letter with scripts? Delimiters round it have their usual size.

    One that may grow is as wide as its largest shape in a browser, so that it would stand in a gap.
    """
    for item in items:
        match item:
            case n.Symbol():
                low = not item.large
            case n.Number() | n.Word() | n.Space():
                low = True
            case n.Group() | n.Classed() | n.Fenced():
                low = _is_low(item.items)
            case n.Accent():
                low = not item.wide and _is_low(item.body)
            case n.Scripts():
                parts = [item.base, *(item.sub or ()), *(item.sup or ())]
                low = not any(isinstance(part, n.Scripts) and part.sup for part in parts) and _is_low(parts)
            case _:
                low = False
        if not low:
            return False
    return True


def _fenced(left: str, body: str, right: str, grows: bool = True) -> str:
    opening = _mo(left, "open", (0.0, 0.0), stretchy=grows) if left else ""
    closing = _mo(right, "close", (0.0, 0.0), stretchy=grows) if right else ""
    return f"<mrow>{opening}{body}{closing}</mrow>"


def _around(core: str, under: list[n.Node] | None, over: list[n.Node] | None, padded: bool = False) -> str:
    """A core with small lists under and over it."""

    def small(items: list[n.Node], towards: str) -> str:
        row = _row(items, script=True)
        around = _mspace(0.5) if padded else ""
        return f'<mrow style="padding-{towards}:0.1em">{around}{row}{around}</mrow>'

    if under and over:
        return f"<munderover>{core}{small(under, 'top')}{small(over, 'bottom')}</munderover>"
    if under:
        return f"<munder>{core}{small(under, 'top')}</munder>"
    return f"<mover>{core}{small(over, 'bottom')}</mover>" if over else core


def _brace(node: n.Brace, script: bool) -> str:
    tag = "mover" if node.over else "munder"
    brace = f'<mo stretchy="true" lspace="0" rspace="0">{node.char}</mo>'
    return f"<{tag}>{_row(node.body, script)}{brace}</{tag}>"


def _accent(node: n.Accent, script: bool) -> str:
    """A mark above; i and j lose their dot, as TeX's and Typst's do."""
    body = node.body
    if len(body) == 1 and isinstance(body[0], n.Symbol) and body[0].char in "ij":
        body = [n.Symbol({"i": "ı", "j": "ȷ"}[body[0].char], upright=body[0].upright)]
    stretch = "true" if node.wide else "false"
    mark = f'<mo stretchy="{stretch}" lspace="0" rspace="0">{symbols.ACCENTS[node.name][1]}</mo>'
    return f'<mover accent="true">{_row(body, script)}{mark}</mover>'


def _scripts(node: n.Scripts, cls: str, script: bool, spaces: tuple[float, float]) -> str:
    """Beside the base, or above and below it where the base or ``\\limits`` asks for it."""
    base = node.base
    movable = node.limits is None and getattr(base, "limits", False)
    stacked = bool(node.limits or movable or isinstance(base, n.Brace))
    if isinstance(base, n.Symbol | n.Operator) and base.limits and node.limits is not None:
        core = _fixed_limits(_node(base, cls, script, spaces))
    else:
        core = _node(base, cls, script, spaces)
    sub = None if node.sub is None else _row(node.sub, True)
    sup = None if node.sup is None else _row(node.sup, True)
    if node.primes:
        primes = f'<mo lspace="0" rspace="0">{symbols.PRIMES.get(node.primes, "′" * node.primes)}</mo>'
        if stacked:
            core = f"<msup>{core}{primes}</msup>"
        else:
            sup = primes if sup is None else f"<mrow>{primes}{sup}</mrow>"
    names = ("munder", "mover", "munderover") if stacked else ("msub", "msup", "msubsup")
    if sub is not None and sup is not None:
        return f"<{names[2]}>{core}{sub}{sup}</{names[2]}>"
    if sub is not None:
        return f"<{names[0]}>{core}{sub}</{names[0]}>"
    return f"<{names[1]}>{core}{sup}</{names[1]}>" if sup is not None else core


def _fixed_limits(element: str) -> str:
    """The operator's element with limits that stay where they are."""
    return element.replace(' movablelimits="true"', "").replace("<mo", '<mo movablelimits="false"', 1)


def _strokes(kind: str) -> str:
    edge, ink = "transparent calc(50% {} 0.04em)", "currentcolor calc(50% {} 0.03em)"
    line = ",".join((edge.format("-"), ink.format("-"), ink.format("+"), edge.format("+")))
    return ",".join(f"linear-gradient({way},{line})" for way in _STROKES[kind])


def _grid(node: n.MathArray) -> str:
    tagged = any(row.tag for row in node.rows)
    rows = []
    for i, row in enumerate(node.rows):
        cells = "".join(_cell(node, i, j, row) for j in range(len(row.cells)))
        if tagged:
            tag = f"<mtext>{_hard_spaces(row.tag.text)}</mtext>" if row.tag else ""
            cells += f'<mtd style="{_aligned("right")};padding:{_em(node.row_gap / 2)} 0 0 2em">{tag}</mtd>'
        rows.append(f"<mtr>{cells}</mtr>")
    large = "true" if node.style == "display" else "false"
    table = f'<mtable displaystyle="{large}" style="border-collapse:collapse">{"".join(rows)}</mtable>'
    return f"<mstyle {_STYLE['script']}>{table}</mstyle>" if node.style == "script" else table


def _aligned(align: str) -> str:
    """Chromium aligns mathematics only with its own keywords; the others ignore them."""
    return f"text-align:{align};text-align:-webkit-{align}"


def _cell(node: n.MathArray, i: int, j: int, row: n.Row) -> str:
    """One cell; alignment, gaps and lines as CSS, because MathML Core leaves tables to it."""
    align = {"l": "left", "c": "center", "r": "right"}[node.align[j]]
    left = 0.0 if j == 0 and not node.vlines else node.gap / 2
    if node.aligned and j and j % 2 == 0:
        left = 2.0
    right = 0.0 if j == len(row.cells) - 1 and not node.vlines else node.gap / 2
    above = node.row_gap / 2 + 0.06
    style = f"{_aligned(align)};padding:{_em(above)} {_em(right)} {_em(above + max(0.0, row.space))} {_em(left)}"
    borders = [
        ("left", j in node.vlines),
        ("right", j + 1 == len(row.cells) and j + 1 in node.vlines),
        ("top", i in node.hlines),
        ("bottom", i + 1 == len(node.rows) and i + 1 in node.hlines),
    ]
    style += "".join(f";border-{side}:0.06em solid" for side, on in borders if on)
    return f'<mtd style="{style}">{_row(row.cells[j], node.style == "script")}</mtd>'
