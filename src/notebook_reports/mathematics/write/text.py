"""The tree as one line of readable text, for those who hear a formula instead of seeing it."""

import unicodedata

from notebook_reports.mathematics import nodes as n
from notebook_reports.mathematics import symbols
from notebook_reports.mathematics.spacing import classes, gap

_ALPHABETS = 0x1D400  # from here on: letters of the mathematical alphabets, read as plain letters
_READABLE = {0xFE01: None, ord("ı"): "i", ord("ȷ"): "j"}
_ACCENT = {"vec": "vector", "dot": "dot", "ddot": "double dot", "overrightarrow": "vector"}


def emit(items: list[n.Node]) -> str:
    plain = (unicodedata.normalize("NFKC", c) if ord(c) >= _ALPHABETS else c for c in _list(items))
    return " ".join("".join(plain).translate(_READABLE).replace("^∘", "°").split())


def _list(items: list[n.Node]) -> str:
    out = ""
    before: str | None = None
    last: n.Node | None = None
    for item, pair in zip(items, classes(items), strict=True):
        if isinstance(item, n.StyleSwitch):
            continue
        if isinstance(item, n.Space):
            out += " " if item.em > 0 else ""
            continue
        text = _node(item)
        if before and pair and (gap(before, pair[0]) or _would_merge(last, out, text)):
            out += " "
        out += text
        before, last = (pair[1], item) if pair else (before, last)
    return out


def _would_merge(last: n.Node | None, out: str, text: str) -> bool:
    """Whether two neighbours would be read as one word, or the second as part of the first one's script."""
    base = last.base if isinstance(last, n.Scripts) else last
    if isinstance(base, n.Symbol) and base.large:
        return True
    if isinstance(last, n.Fraction):
        return text[:1].isalnum() or text[:1] == "("
    return out[-1:].isalnum() and text[:1].isalnum() and (base is not last or len(text) > 1)


def _node(node: n.Node) -> str:
    match node:
        case n.Symbol():
            return node.char
        case n.Number() | n.Word() | n.MathText():
            return node.text
        case n.Group() | n.Classed():
            return _list(node.items)
        case n.Scripts():
            base = _node(node.base) + symbols.PRIMES.get(node.primes, "′" * node.primes)
            return base + _script("_", node.sub) + _script("^", node.sup)
        case n.Fraction():
            num = _list(node.num).strip()
            num = num if num.isalnum() else _bracketed(node.num)
            return f"{num}{'/' if node.line else ' over '}{_bracketed(node.den)}"
        case n.Root():
            index = f"root {_list(node.index)} of " if node.index else "√"
            return f"{index}{_bracketed(node.body)}"
        case n.Fenced():
            body = _list(node.items).strip()
            if len(node.items) == 1 and isinstance(node.items[0], n.MathArray) and body[:1] == "[":
                body = body[1:-1]
            return f"{node.left}{body}{node.right}"
        case n.Middle() | n.Big():
            return node.char
        case n.Accent():
            return f"{_bracketed(node.body)} {_ACCENT.get(node.name, node.name)}"
        case n.Line():
            return f"{_bracketed(node.body)} {'bar' if node.over else 'underlined'}"
        case n.Brace() | n.Boxed() | n.Colored() | n.Sized():
            return _list(node.body)
        case n.Stack():
            notes = [_list(part) for part in (node.over, node.under) if part]
            return f"{_list(node.base)} ({'; '.join(notes)})"
        case n.Arrow():
            notes = [_list(part) for part in (node.over, node.under) if part]
            return f"{node.char} ({'; '.join(notes)})" if notes else node.char
        case n.Operator():
            return _list(node.name)
        case n.MathArray():
            return _grid(node)
        case n.Phantom():
            return ""
        case n.Cancel():
            return f"{_bracketed(node.body)} crossed out"
        case n.TagNode():
            return f"  {node.tag.text}"
    raise TypeError(f"no text form for {type(node).__name__}")


def _script(mark: str, items: list[n.Node] | None) -> str:
    """A sub- or superscript: index words such as y_sp stand bare, products in an exponent do not."""
    if items is None:
        return ""
    text = _list(items).strip()
    bare = len(text) == 1 or (text.isalnum() if mark == "_" else text.isdigit())
    return mark + (text if bare else f"({text})")


def _bracketed(items: list[n.Node]) -> str:
    text = _list(items).strip()
    whole = text[:1] == "(" and text[-1:] == ")" and "(" not in text[1:-1] and ")" not in text[1:-1]
    return text if whole or len(text) == 1 or (len(items) == 1 and _is_atom(items[0])) else f"({text})"


def _is_atom(node: n.Node) -> bool:
    """Whether a node needs no parentheses as a denominator or script."""
    if isinstance(node, n.Scripts):
        short = all(len(_list(part)) == 1 for part in (node.sub, node.sup) if part is not None)
        return _is_atom(node.base) and short and (node.sub is None or node.sup is None)
    return isinstance(node, n.Symbol | n.Number | n.Word | n.Operator)


def _grid(node: n.MathArray) -> str:
    rows = []
    for row in node.rows:
        separator = " " if node.aligned else ", "
        text = separator.join(_list(cell).strip(" ,") for cell in row.cells)
        rows.append(f"{text}  {row.tag.text}" if row.tag else text)
    return f"{node.left or ('' if node.right else '[')}{'; '.join(rows)}{node.right or ('' if node.left else ']')}"
