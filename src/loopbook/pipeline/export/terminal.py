"""Printed text as a terminal would leave it: without colours, with overwritten lines overwritten."""

import re

_ESCAPE = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\x1b\][^\x07\x1b]*(?:\x07|\x1b\\)|\x1b[@-Z\\-_]")
_CONTROL = re.compile(r"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\ufeff]")


def _overwrite(line: str) -> str:
    shown = ""
    for part in line.split("\r"):
        shown = part + shown[len(part) :]
    while "\b" in shown:
        shown = re.sub(r"[^\b]\b|^\b+", "", shown)
    return shown


def settle(text: str) -> str:
    r"""What a terminal shows in the end; other control characters become their visible picture.

    >>> settle("\x1b[31mred\x1b[0m\n 10 %\r100 %\n")
    'red\n100 %\n'
    >>> settle("a\x00b")
    'a␀b'
    """
    text = _ESCAPE.sub("", text).replace("\r\n", "\n")
    text = "\n".join(_overwrite(line) for line in text.split("\n")).expandtabs(8)
    return visible(text)


def visible(text: str) -> str:
    """Control characters, which no font has, as their pictures in Unicode."""

    def picture(found: re.Match[str]) -> str:
        code = ord(found[0])
        return chr(0x2400 + code) if code < 0x20 else "␡" if code == 0x7F else "\N{SYMBOL FOR SUBSTITUTE FORM TWO}"

    return _CONTROL.sub(picture, text)
