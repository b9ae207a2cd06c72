"""The range that a parameter's comment states: ``# pole, [0, 1)``, ``# s, > 0``, ``# {"P", "PI"}``, ``# 0 < q < 1``."""

import ast
import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

_NUMBER = r"[-+−]?(?:\d+\.?\d*(?:e[-+]?\d+)?|\.\d+|inf|oo|∞)"
_INTERVAL = re.compile(rf"([\[\(\]])\s*({_NUMBER})\s*,\s*({_NUMBER})\s*([\]\)\[])", re.IGNORECASE)
_CHAIN = re.compile(rf"({_NUMBER})\s*(<=|<|≤)\s*\w+\s*(<=|<|≤)\s*({_NUMBER})", re.IGNORECASE)
_BOUND = re.compile(rf"(>=|<=|!=|>|<|≥|≤|≠)\s*({_NUMBER})", re.IGNORECASE)
_SET = re.compile(r"\{[^{}]*\}")

_TESTS: dict[str, Callable[[float, float], bool]] = {
    ">": lambda v, b: v > b,
    ">=": lambda v, b: v >= b,
    "<": lambda v, b: v < b,
    "<=": lambda v, b: v <= b,
    "!=": lambda v, b: v != b,
}
_PLAIN = {"≥": ">=", "≤": "<=", "≠": "!="}


@dataclass(frozen=True)
class Range:
    """What a value may be. text: as the comment writes it. bounds: (relation, number) that all must hold."""

    text: str = ""
    bounds: tuple[tuple[str, float], ...] = ()
    choices: tuple[Any, ...] = ()

    def holds(self, value: Any) -> bool:
        """Is the value, or each item of a list or tuple, inside?"""
        if isinstance(value, list | tuple):
            return all(self.holds(v) for v in value)
        if value is None:
            return True
        if self.choices and value not in self.choices:
            return False
        if isinstance(value, str | bool):
            return True
        return all(_TESTS[relation](value, bound) for relation, bound in self.bounds)


def _number(text: str) -> float:
    return float(text.replace("−", "-").replace("∞", "inf").replace("oo", "inf"))


def read_range(comment: str) -> Range:
    """The range in a comment, or one without limits.

    >>> read_range("pole, [0, 1)").holds(1.0), read_range("s, > 0").holds(0.5), read_range("free text").holds(-3)
    (False, True, True)
    """
    if found := _INTERVAL.search(comment):
        low, high = ">=" if found[1] == "[" else ">", "<=" if found[4] == "]" else "<"
        limits = ((low, _number(found[2])), (high, _number(found[3])))
        return Range(found[0], tuple(b for b in limits if abs(b[1]) != float("inf")))
    if found := _CHAIN.search(comment):
        low, high = (_PLAIN.get(sign, sign) for sign in found.group(2, 3))
        return Range(found[0], ((low.replace("<", ">"), _number(found[1])), (high, _number(found[4]))))
    if found := _SET.search(comment):
        try:
            return Range(found[0], choices=tuple(sorted(ast.literal_eval(found[0]), key=repr)))
        except (ValueError, SyntaxError, TypeError):
            return Range()
    bounds = tuple((_PLAIN.get(sign, sign), _number(bound)) for sign, bound in _BOUND.findall(comment))
    return Range(", ".join(f"{sign} {bound:g}" for sign, bound in bounds), bounds)
