"""The tree as Typst mathematics.

Rules that keep the result independent of Typst's versions and of what a formula contains: characters stand for
themselves (no symbol names), ASCII punctuation is always escaped, text is a string literal, every function has
explicit arguments, and a class is written out wherever Typst could see another one than TeX does.
"""

from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics import symbols
from notebook_reports.mathematics.spacing import BARS, THIN, classes, gap
from notebook_reports.mathematics.write import text

_CLASS = {
    "ord": "normal",
    "op": "large",
    "bin": "binary",
    "rel": "relation",
    "open": "opening",
    "close": "closing",
    "punct": "punctuation",
}
# Characters whose class is the same for Typst and for TeX.
_NATURAL = {
    "ord": set("∞∂∇∅∀∃ℵ′/.@"),
    "bin": set("+−×⋅∓±∩∪∧∨⊕⊗∘"),
    "rel": set(":=<>≤≥≠≈≡≪≫∼∈∉⊂⊆→⇒⇔↦⟶⟹⟺"),
    "punct": set(",;"),
    "open": set("([{⟨⌊⌈"),
    "close": set(")]}⟩⌋⌉"),
}
_STYLE = {"display": "display", "text": "inline", "script": "script", "sscript": "sscript"}
_BRACES = {
    "⏞": "overbrace",
    "⏟": "underbrace",
    "⎴": "overbracket",
    "⎵": "underbracket",
    "⏜": "overparen",
    "⏝": "underparen",
}
_CANCEL = {"cancel": "", "bcancel": ", inverted: #true", "xcancel": ", cross: #true", "sout": ", angle: #90deg"}


_INSIDE_FRACTION = {"display": "text", "text": "script", "script": "script", "sscript": "script"}


def emit(items: list[n.Node], display: bool = False) -> str:
    """Typst code for a horizontal list."""
    return _list(items, "display" if display else "text")


def string(text: str) -> str:
    r"""A Typst string literal.

    >>> print(string('say "a\\b"'))
    "say \"a\\b\""
    """
    return '"' + text.replace("\\", "\\\\").replace('"', '\\"') + '"'


def join(parts: list[str]) -> str:
    """Parts side by side, with a space only where two would run into one word (a space next to text would show)."""
    out = ""
    for part in parts:
        if out and part and _wordlike(out[-1]) and _wordlike(part[0]):
            out += " "
        out += part
    return out


def _wordlike(char: str) -> bool:
    return char.isalnum() or ord(char) > 127


def _em(value: float) -> str:
    return f"{value:.4f}".rstrip("0").rstrip(".") + "em"


def _space(em: float) -> str:
    return f"#h({_em(em)})"


def _char(char: str) -> str:
    """One character that means itself and opens, closes or starts nothing."""
    return char if char.isalnum() else "\\" + char


def _wrap(content: str, cls: str) -> str:
    return f'class("{_CLASS[cls]}", {content})'


def _list(items: list[n.Node], style: str) -> str:
    """A horizontal list as one argument; never empty, because Typst refuses empty arguments."""
    return _from(0, items, classes(items), None, style) or '""'


def _from(start: int, items: list[n.Node], found: list, before: str | None, style: str) -> str:
    """The list from a place on. Explicit spaces include TeX's own space there, which Typst drops."""
    parts: list[str] = []
    space: float | None = None
    for i in range(start, len(items)):
        item, pair = items[i], found[i]
        if isinstance(item, n.Space):
            space = item.em + (space or 0.0)
            continue
        after_space = space is not None
        if space is not None:
            parts.append(_space(space + (gap(before, pair[0], "script" in style) if before and pair else 0.0)))
            space = None
        if isinstance(item, n.StyleSwitch):
            rest = _from(i + 1, items, found, before, item.style) or '""'
            return join([*parts, f"{_STYLE[item.style]}({rest})"])
        if before == "op" and pair and not after_space and (own := _space_after_operator(item)) is not None:
            parts.append(_space(own))
        parts.append(_node(item, pair[0] if pair else "ord", style))
        before = pair[1] if pair else before
        if after_space and before == "bin":
            space = 0.0  # Typst takes an operator after an explicit space for a sign: both its spaces are ours to write
    if space is not None:
        parts.append(_space(space))
    return join(parts)


def _space_after_operator(node: n.Node) -> float | None:
    """The space before growing delimiters where Typst would set another one than `spacing` says.

    A growing bar is ordinary in `spacing` and an opening delimiter for Typst; with a script it is the other way round.
    """
    base = node.base if isinstance(node, n.Scripts) else node
    if not isinstance(base, n.Fenced | n.MathArray) or not base.left:
        return None
    if base.left in BARS:
        return None if base is not node else THIN
    return 0.0 if base is not node else None


def _equation(items: list[n.Node], style: str) -> str:
    """A formula inside a box, which is text; tagged PDF wants a text alternative for it too."""
    alternative = string(text.emit(items) or "formula")
    equation = f"math.equation(alt: {alternative}, ${_STYLE[style]}({_list(items, style)})$)"
    return f"#{{set par(leading: 0em); {equation}}}"  # with a leading, Typst makes tall formulas in lines less tall


def _node(node: n.Node, cls: str, style: str) -> str:
    """One node. cls: its class in its context, which for a unary minus is not its own."""
    match node:
        case n.Symbol():
            return _symbol(node, cls)
        case n.Number():
            return node.text if node.text.replace(".", "").isdecimal() and "," not in node.text else string(node.text)
        case n.Word():
            return string(node.text)
        case n.MathText():
            text = string(node.text)
            return f"{node.variant}({text})" if node.variant != "normal" else text
        case n.Group():
            return _group(node.items, style)
        case n.Classed():
            if cls == "op":
                return f"op({_list(node.items, style)}, limits: #true)"
            return _wrap(_list(node.items, style), cls)
        case n.Scripts():
            return _scripts(node, cls, style)
        case n.Fraction():
            return _fraction(node, style)
        case n.Root():
            body = _list(node.body, style)
            return f"sqrt({body})" if node.index is None else f"root({_list(node.index, 'script')}, {body})"
        case n.Fenced():
            return _fenced(node, style)
        case n.Middle():
            return _wrap(f"mid({_char(node.char)})", "ord") if node.char else '""'
        case n.Big():
            return _wrap(f"lr({_char(node.char)}, size: #{_em(node.em)})", cls) if node.char else '""'
        case n.Accent():
            size = "" if node.wide else ", size: #0%"
            mark = f"\\u{{{ord(symbols.ACCENTS[node.name][0]):x}}}"
            return f'accent({_list(node.body, style)}, #"{mark}"{size})'
        case n.Line():
            return f"{'overline' if node.over else 'underline'}({_list(node.body, style)})"
        case n.Brace():
            return f"{_BRACES[node.char]}({_list(node.body, style)})"
        case n.Stack():
            return _labelled(_list(node.base, style), node, cls)
        case n.Arrow():
            return _labelled(f"stretch({node.char}, size: #(100% + 1em))", node, cls)
        case n.Operator():
            return f"op({_list(node.name, style)}, limits: #{'true' if node.limits else 'false'})"
        case n.MathArray():
            return _grid(node, style)
        case n.Phantom():
            if node.width and node.height:
                return f"std.hide({_list(node.body, style)})"
            return f"std.box({'height' if node.width else 'width'}: #0pt, std.hide({_equation(node.body, style)}))"
        case n.Boxed():
            return f"std.box(stroke: #0.05em, inset: #0.3em, {_equation(node.body, 'display')})"
        case n.Cancel():
            return f"cancel({_list(node.body, style)}{_CANCEL[node.kind]})"
        case n.Colored():
            return f'std.text(fill: #rgb("{node.color}"), {_list(node.body, style)})'
        case n.Sized():
            return f"std.text(size: #{_em(node.factor)}, {_list(node.body, style)})"
        case n.TagNode():
            return _space(2.0) + string(node.tag.text)
    raise TypeError(f"no Typst form for {type(node).__name__}")


def _labelled(base: str, node: n.Stack | n.Arrow, cls: str) -> str:
    """A base with small lists above and below it."""
    slots = [f"{side}: {_list(part, 'script')}" for side, part in (("t", node.over), ("b", node.under)) if part]
    return _wrap(f"attach(limits({base}), {', '.join(slots)})" if slots else base, cls)


def _symbol(node: n.Symbol, cls: str) -> str:
    if node.large:
        return node.char
    if node.upright:
        return string(node.char)
    if cls == "ord" and node.char[0].isalpha():
        return node.char
    char = _char(node.char)
    return char if node.char in _NATURAL.get(cls, ()) else _wrap(char, cls)


def _group(items: list[n.Node], style: str) -> str:
    """A group shows its list; at its edges it is an ordinary atom for its neighbours."""
    body = _list(items, style)
    found = [pair for pair in classes(items) if pair]
    if found and (found[0][0], found[-1][1]) != ("ord", "ord"):
        return _wrap(body, "ord")
    return body


def _scripts(node: n.Scripts, cls: str, style: str) -> str:
    """Scripts beside the base (tr, br) or, for operators with limits, above and below it (t, b)."""
    base = node.base
    sub = None if node.sub is None else _list(node.sub, "script")
    sup = None if node.sup is None else _list(node.sup, "script")
    if isinstance(base, n.Brace):
        above = base.char in "⏞⎴⏜"
        label = sup if above else sub
        body = f"{_BRACES[base.char]}({_list(base.body, style)}{', ' + label if label else ''})"
        rest = sub if above else sup
        return f"attach(limits({body}), {'b' if above else 't'}: {rest})" if rest else body
    body = _node(base, cls, style)
    limits = node.limits
    if limits is None and _moves_limits(base):
        top, bottom = "t", "b"
    elif limits:
        top, bottom, body = "t", "b", f"limits({body})"
    else:
        top, bottom = "tr", "br"
        if limits is False or isinstance(base, n.Stack | n.Arrow):
            body = f"scripts({body})"
    slots = []
    if node.primes:
        primes = symbols.PRIMES.get(node.primes, "′" * node.primes)
        if top == "t" or sup is None:
            slots.append(f"tr: {primes}")
        else:
            sup = join([primes, sup])
    if sup is not None:
        slots.append(f"{top}: {sup}")
    if sub is not None:
        slots.append(f"{bottom}: {sub}")
    return f"attach({body}, {', '.join(slots)})"


def _moves_limits(base: n.Node) -> bool:
    match base:
        case n.Symbol() | n.Operator():
            return base.limits
        case n.Classed():
            return base.cls == "op"
        case _:
            return False


def _fraction(node: n.Fraction, style: str) -> str:
    inner = _INSIDE_FRACTION[node.style or style]
    num, den = _list(node.num, inner), _list(node.den, inner)
    body = f"frac({num}, {den})" if node.line else f"mat(delim: #none, row-gap: #0.2em, {num}; {den})"
    return f"{_STYLE[node.style]}({body})" if node.style else body


def _fenced(node: n.Fenced, style: str) -> str:
    """An invisible delimiter is an empty text, so that `lr` does not stretch what stands at the edge instead."""
    if len(node.items) == 1 and isinstance(node.items[0], n.Fraction) and (node.left, node.right) == ("(", ")"):
        over = node.items[0]
        if not over.line:
            inner = _INSIDE_FRACTION[over.style or style]
            body = f"binom({_list(over.num, inner)}, {_list(over.den, inner)})"
            return f"{_STYLE[over.style]}({body})" if over.style else body
    return _between(node.left, _list(node.items, style), node.right)


def _between(left: str, body: str, right: str) -> str:
    return f"lr({join([_delimiter(left, 'open'), body, _delimiter(right, 'close')])})"


def _delimiter(char: str, cls: str) -> str:
    if not char:
        return '""'
    return _char(char) if char in _NATURAL[cls] else _wrap(_char(char), cls)


def _grid(node: n.MathArray, style: str) -> str:
    """A `mat` without delimiters inside `lr`; tags stand in a column of their own."""
    mixed = len(set(node.align)) > 1
    align = {"l": "left", "c": "center", "r": "right"}[node.align[0] if node.align and not mixed else "c"]
    tagged = any(row.tag for row in node.rows)
    rows = []
    for row in node.rows:
        cells = [
            _cell(
                [n.Space(2.0), *cell] if j and node.aligned and j % 2 == 0 else cell,
                node.align[j] if mixed or tagged else "",
                node.style,
                row.space if j == 0 else 0.0,
            )
            for j, cell in enumerate(row.cells)
        ]
        if tagged:
            cells.append(_cell([n.Space(2.0), n.MathText(row.tag.text)] if row.tag else [], "l", "display"))
        rows.append(", ".join(cells) or '""')
    lines = [
        f"{name}: ({''.join(f'{i}, ' for i in at)})"
        for name, at in (("vline", node.vlines), ("hline", node.hlines))
        if at
    ]
    options = [
        "delim: #none",
        f"align: #{align}",
        f"row-gap: #{_em(node.row_gap)}",
        f"column-gap: #{_em(node.gap)}",
        *([f"augment: #({', '.join(lines)})"] if lines else []),
    ]
    body = f"mat({', '.join(options)}, {'; '.join(rows) or chr(34) * 2})"
    if node.style == "script":
        body = f"script({body})"  # the rows of a mat are at least as high as a parenthesis of the style around it
    if node.left or node.right:
        return _between(node.left, body, node.right)
    return body


def _cell(items: list[n.Node], align: str, style: str, space: float = 0.0) -> str:
    """One cell. space: extra depth in em, from ``\\\\[6pt]``."""
    strut = f"#std.box(width: 0pt, height: {_em(space + 0.3)}, baseline: {_em(space + 0.3)})" if space > 0 else ""
    body = f"{_STYLE[style]}({_list(items, style)}{strut})" if items or strut else '""'
    return {"l": "&" + body, "r": body + "&"}.get(align, body)
