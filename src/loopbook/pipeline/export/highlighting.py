"""Code for the screen: classes of tokens by Pygments, the colours in the style sheet."""

import functools
from html import escape
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


@functools.cache
def _lexer(language: str) -> Any:
    from pygments.lexers import get_lexer_by_name
    from pygments.util import ClassNotFound

    try:
        return get_lexer_by_name(language, stripnl=False, ensurenl=False)
    except ClassNotFound:
        return None


@functools.cache
def _class(token: Any) -> str:
    name = str(token).removeprefix("Token.")
    return next((css for prefix, css in _CLASSES if name.startswith(prefix)), "")


def highlighted(code: str, language: str) -> str:
    """Code as HTML, its tokens in spans; the same text where the language is unknown.

    >>> highlighted("x = 1", "python")
    'x = <span class="n">1</span>'
    """
    lexer = _lexer(language) if language else None
    if lexer is None:
        return escape(code, quote=False)
    parts: list[list[str]] = []
    for token, text in lexer.get_tokens(code):
        css = _class(token)
        if parts and parts[-1][0] == css:
            parts[-1][1] += text
        else:
            parts.append([css, text])
    return "".join(
        f'<span class="{c}">{escape(t, quote=False)}</span>' if c else escape(t, quote=False) for c, t in parts
    )
