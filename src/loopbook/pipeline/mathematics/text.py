"""The tree as one line of readable text, for those who hear a formula instead of seeing it."""

from loopbook.pipeline.mathematics import nodes as n
from loopbook.pipeline.mathematics.spacing import classes, gap

_ACCENT = {"vec": "vector", "dot": "dot", "ddot": "double dot", "overrightarrow": "vector"}


def emit(items: list[n.Node]) -> str:
    return " ".join(_list(items).split())


def _list(items: list[n.Node]) -> str:
    out = ""
    before: str | None = None
    for item, pair in zip(items, classes(items), strict=True):
        if isinstance(item, n.StyleSwitch):
            continue
        if isinstance(item, n.Space):
            out += " " if item.em > 0 else ""
            continue
        text = _node(item)
        if before and pair and (gap(before, pair[0]) or (out[-1:].isalnum() and len(text) > 1 and text[0].isalnum())):
            out += " "
        out += text
        before = pair[1] if pair else before
    return out


def _node(node: n.Node) -> str:
    match node:
        case n.Symbol():
            return node.char
        case n.Number() | n.Word() | n.Text():
            return node.text
        case n.Group() | n.Classed():
            return _list(node.items)
        case n.Scripts():
            base = _node(node.base) + "′" * node.primes
            sub = f"_{_bracketed(node.sub)}" if node.sub is not None else ""
            sup = f"^{_bracketed(node.sup)}" if node.sup is not None else ""
            return base + sub + sup
        case n.Fraction():
            return f"{_bracketed(node.num)}{'/' if node.line else ' over '}{_bracketed(node.den)}"
        case n.Root():
            index = f"root {_list(node.index)} of " if node.index else "√"
            return f"{index}{_bracketed(node.body)}"
        case n.Fenced():
            return f"{node.left}{_list(node.items).strip()}{node.right}"
        case n.Middle() | n.Big():
            return node.char
        case n.Accent():
            return f"{_bracketed(node.body)} {_ACCENT.get(node.name, node.name)}"
        case n.Line():
            return f"{_bracketed(node.body)} {'bar' if node.over else 'underlined'}"
        case n.Brace() | n.Boxed() | n.Colored():
            return _list(node.body)
        case n.Stack():
            notes = [_list(part) for part in (node.over, node.under) if part]
            return f"{_list(node.base)} ({'; '.join(notes)})"
        case n.Arrow():
            notes = [_list(part) for part in (node.over, node.under) if part]
            return f"{node.char} ({'; '.join(notes)})" if notes else node.char
        case n.Operator():
            return _list(node.name)
        case n.Grid():
            return _grid(node)
        case n.Phantom():
            return ""
        case n.Cancel():
            return f"{_bracketed(node.body)} crossed out"
        case n.TagNode():
            return f"  {node.tag.text}"
    raise TypeError(f"no text form for {type(node).__name__}")


def _bracketed(items: list[n.Node]) -> str:
    text = _list(items).strip()
    whole = text[:1] == "(" and text[-1:] == ")" and "(" not in text[1:-1] and ")" not in text[1:-1]
    return text if len(text) == 1 or text.isalnum() or whole else f"({text})"


def _grid(node: n.Grid) -> str:
    rows = []
    for row in node.rows:
        separator = " " if node.aligned else ", "
        text = separator.join(_list(cell).strip() for cell in row.cells)
        rows.append(f"{text}  {row.tag.text}" if row.tag else text)
    return f"{node.left or ('' if node.right else '[')}{'; '.join(rows)}{node.right or ('' if node.left else ']')}"
