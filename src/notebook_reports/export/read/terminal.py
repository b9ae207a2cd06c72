"""Printed text as a terminal would leave it: without colours, with overwritten lines overwritten."""

import re

_ESCAPE = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)|\x1b[@-Z\\-_]")
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f]")


def _overwrite(line: str) -> str:
    shown = ""
    for part in line.split("\r"):
        shown = part + shown[len(part) :]
    while "\b" in shown:
        shown = re.sub(r"[^\x08]\x08|^\x08+", "", shown)
    return shown


def settle(text: str) -> str:
    r"""What a terminal shows in the end; other control characters become visible escapes.

    >>> settle("\x1b[31mred\x1b[0m\n 10 %\r100 %\n")
    'red\n100 %\n'
    >>> print(settle("a\x00b"))
    a\x00b
    """
    text = _ESCAPE.sub("", text).replace("\r\n", "\n")
    text = "\n".join(_overwrite(line) for line in text.split("\n")).expandtabs(8)
    return visible(text)


def visible(text: str) -> str:
    """Control characters, which no font has, as Python writes them; a byte order mark goes."""
    return _CONTROL.sub(lambda found: f"\\x{ord(found[0]):02x}", text.replace("\ufeff", ""))
