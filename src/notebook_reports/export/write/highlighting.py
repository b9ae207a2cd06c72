"""Code in runs of one colour, by Pygments, once for both formats; the colours themselves are in the templates."""

import functools
from typing import Any

_CLASSES = (
    ("Comment", "c"),
    ("Literal.String", "s"),
    ("Literal.Number", "n"),
    ("Keyword.Constant", "n"),
    ("Keyword", "k"),
    ("Operator.Word", "k"),
    ("Name.Function", "f"),
    ("Name.Class", "f"),
    ("Name.Builtin", "f"),
    ("Name.Decorator", "f"),
)
_NAMES = {"ipython": "python", "ipython3": "python", "python3": "python", "py": "python"}


@functools.cache
def _lexer(language: str) -> Any:
    from pygments.lexers import get_lexer_by_name
    from pygments.util import ClassNotFound

    try:
        return get_lexer_by_name(_NAMES.get(language, language), stripnl=False, ensurenl=False)
    except ClassNotFound:
        return None


@functools.cache
def _class(token: Any) -> str:
    name = str(token).removeprefix("Token.")
    return next((css for prefix, css in _CLASSES if name.startswith(prefix)), "")


@functools.lru_cache(maxsize=2000)
def runs(code: str, language: str) -> tuple[tuple[str, str], ...]:
    """The code cut into (class, text): c comment, s string, n number, k keyword, f name, "" other.

    Nothing is cut where the language is "" or unknown.

    >>> runs("x = 1", "python")
    (('', 'x = '), ('n', '1'))
    """
    lexer = _lexer(language) if language else None
    if lexer is None:
        return (("", code),)
    found: list[tuple[str, str]] = []
    for token, text in lexer.get_tokens(code):
        kind = found[-1][0] if found and text.isspace() else _class(token)
        if found and found[-1][0] == kind:
            found[-1] = (kind, found[-1][1] + text)
        else:
            found.append((kind, text))
    return tuple(found)


def highlighted_lines(code: str, language: str) -> list[list[tuple[str, str]]]:
    r"""The same, line by line.

    >>> highlighted_lines("x = 1\n# end", "python")
    [[('', 'x = '), ('n', '1')], [('c', '# end')]]
    """
    rows: list[list[tuple[str, str]]] = [[]]
    for kind, text in runs(code, language):
        first, *rest = text.split("\n")
        rows[-1].append((kind, first))
        rows += [[(kind, line)] for line in rest]
    return [[(kind, text) for kind, text in row if text] for row in rows]
