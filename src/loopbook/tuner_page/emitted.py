"""The controller's program in the page: its law in JavaScript, and its C and Structured Text with places for numbers.

All of it is emitted by `loopbook.code`. A text with places is the program of settings that stand for nothing, each
number of which is a mark: the page writes its own in the language's way.
"""

import re
from dataclasses import replace
from functools import cache

from loopbook.code.emission import emit
from loopbook.code.pid import pid_block

MARKS = {
    **{"K": 101.015625, "Ti": 102.015625, "Td": 103.015625, "Tf": 104.015625, "b": 0.615625, "c": 0.415625},
    **{"Tt": 105.015625, "h": 106.015625, "u_low": -107.015625, "u_high": 108.015625, "rate": 109.015625},
}
NOT_IN_A_PAGE = ("manual", "cycle")
UNASKED = re.compile(r"\n    // (?:The flags|Settings that are not named).*?\n(?=\n    (?://|if))", re.S)
FORMS = {"(lb_real)": "c", "REAL#": "s", "": "p"}


@cache
def law_script() -> str:
    """The module `generated/law.js`: the function ``emittedLaw(settings)`` of an emitted controller."""
    block = pid_block(K=1.0, Ti=1.0, h=1.0, name="emitted_law")
    used = tuple(o for o in block.program.operations if o.name not in NOT_IN_A_PAGE)
    text = emit(replace(block, program=replace(block.program, operations=used)), "js")["emitted_law.mjs"]
    text = UNASKED.sub("", text[text.index("export function emittedLaw") :])
    return text.replace(" changed, flags,", "")


def with_places(text: str) -> str:
    """A program in which the numbers of `MARKS` are places, such as ``\\x02cK\\x03``; g: written with six digits."""
    text = text.replace(f"CYCLE := {MARKS['h']:g}", "CYCLE := \x02gh\x03")
    for name, value in MARKS.items():
        found = re.compile(rf"-?(\(lb_real\)|REAL#|){re.escape(repr(abs(value)))}")
        text = found.sub(lambda match, name=name: f"\x02{FORMS[match[1]]}{name}\x03", text)  # type: ignore[misc]
    return text


@cache
def programs() -> dict[str, str]:
    """C and Structured Text by file name, with places."""
    block = pid_block(**MARKS)  # type: ignore[arg-type]
    return {name: with_places(text) for target in ("c", "st") for name, text in emit(block, target).items()}
