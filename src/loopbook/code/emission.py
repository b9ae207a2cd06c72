"""A controller written out in one language."""

import re
from itertools import takewhile

from loopbook.code.block import Block, CodeError
from loopbook.code.language import Options
from loopbook.code.languages import languages

USE = "How to use it:"
"""Begins the lines of use."""


def emit(
    block: Block,
    target: str = "c",
    *,
    real: str = "float",
    arduino: bool = False,
    test_main: bool = False,
    stem: str = "",
) -> dict[str, str]:
    """The texts of a controller, by file name.

    target: c, st, js or py. real: "float" or "double" for C and Structured Text. arduino, test_main: C with a sketch,
    with a main that tries it. stem: of the file names; default the block's name.
    Raises CodeError for an unknown target.

    >>> from loopbook.code import pid_block
    >>> sorted(emit(pid_block(K=2.0, Ti=10.0, h=0.5)))
    ['pid.c', 'pid.h']
    """
    known = languages()
    if target not in known:
        raise CodeError(f"{target}: no such language; one of {', '.join(known)} is expected")
    return known[target].files(block, Options(real, arduino, test_main), stem or block.name)


def statements(block: Block, equation: str, real: str = "float") -> dict[str, str]:
    """What an equation of the report became, by language: the first line that carries its number.

    Raises CodeError for an equation that no line carries.

    >>> from loopbook.code import pid_block
    >>> statements(pid_block(K=2.0, Ti=10.0, h=0.5), "4.11")["Python"]
    'self.p3 = self.Tf/(self.Tf + self.h)'
    """
    found = {}
    for language in languages().values():
        text = language.files(block, Options(real), block.name)[f"{block.name}{language.suffixes[0]}"]
        carrying = [line for line in text.splitlines() if f"eq. {equation}" in line]
        code = [re.sub(r"\s*(/\*|\(\*|//|#) eq\. .*", "", line).strip() for line in carrying]
        if not any(code):
            raise CodeError(f"eq. {equation}: no statement of the {block.program.law} in {language.title} carries it")
        found[language.title] = next(filter(None, code))
    return found


def how_to_call(block: Block, target: str = "c") -> str:
    """The ten lines of use that stand above the program: begin, call, switch on from rest, manual, scaling.

    Raises CodeError for an unknown target.

    >>> from loopbook.code import pid_block
    >>> how_to_call(pid_block(K=2.0, Ti=10.0, h=0.5)).splitlines()[0].strip()
    'static pid loop;'
    """
    text = next((t for t in emit(block, target).values() if USE in t), "")
    if not text:
        raise CodeError(f"{target}: its text says how to use it in a line; c and st have ten")
    lines = (re.sub(r"^ \*", "", line) for line in text[text.index(USE) + len(USE) :].splitlines()[1:])
    return "\n".join(takewhile(str.strip, lines))
