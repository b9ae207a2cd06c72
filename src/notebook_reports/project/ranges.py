"""The range that a parameter's comment states: ``# pole, [0, 1)``, ``# s, > 0``, ``# {"P", "PI"}``, ``# 0 < q < 1``.

A list in braces may leave out equal steps: ``# s, {20, 25 … 120}``.
"""

import ast
import re
from collections.abc import Callable
from dataclasses import dataclass
from decimal import Decimal
from typing import Any

_NUMBER = r"[-+−]?(?:\d+\.?\d*(?:e[-+]?\d+)?|\.\d+|inf|oo|∞)"
_INTERVAL = re.compile(rf"([\[\(\]])\s*({_NUMBER})\s*,\s*({_NUMBER})\s*([\]\)\[])", re.IGNORECASE)
_CHAIN = re.compile(rf"({_NUMBER})\s*(<=|<|≤)\s*\w+\s*(<=|<|≤)\s*({_NUMBER})", re.IGNORECASE)
_BOUND = re.compile(rf"(>=|<=|!=|>|<|≥|≤|≠)\s*({_NUMBER})", re.IGNORECASE)
_SET = re.compile(r"\{[^{}]*\}")
_STEPS = re.compile(rf"\{{\s*({_NUMBER})\s*,\s*({_NUMBER})\s*,?\s*(?:…|\.\.\.)\s*,?\s*({_NUMBER})\s*\}}")
_MOST = 10_000

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
    """What a value may be. text: as the comment writes it. bounds: (relation, number) that all must hold. choices: in
    the order of their size, or of their letters."""

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


def _equal_steps(first: str, second: str, last: str) -> tuple[int | float, ...]:
    """The numbers from the first to the last in steps as large as the first one; none where they do not meet it."""
    start, step, end = Decimal(first), Decimal(second) - Decimal(first), Decimal(last)
    count = (end - start) / step if step > 0 else Decimal(-1)
    if count != int(count) or not 1 <= count < _MOST:
        return ()
    exact = [start + i * step for i in range(int(count) + 1)]
    return tuple(int(v) if "." not in first + second else float(v) for v in exact)


def _in_order(values: set[Any]) -> tuple[Any, ...]:
    return tuple(sorted(values, key=lambda v: (0, v, "") if isinstance(v, int | float) else (1, 0, repr(v))))


def read_range(comment: str) -> Range:
    """The range in a comment, or one without limits.

    >>> read_range("pole, [0, 1)").holds(1.0), read_range("s, > 0").holds(0.5), read_range("free text").holds(-3)
    (False, True, True)
    >>> read_range("s, {2, 2.5 … 4}").choices
    (2.0, 2.5, 3.0, 3.5, 4.0)
    """
    if (found := _STEPS.search(comment)) and (steps := _equal_steps(*(t.replace("−", "-") for t in found.groups()))):
        return Range(found[0], choices=steps)
    if found := _INTERVAL.search(comment):
        low, high = ">=" if found[1] == "[" else ">", "<=" if found[4] == "]" else "<"
        limits = ((low, _number(found[2])), (high, _number(found[3])))
        return Range(found[0], tuple(b for b in limits if abs(b[1]) != float("inf")))
    if found := _CHAIN.search(comment):
        low, high = (_PLAIN.get(sign, sign) for sign in found.group(2, 3))
        return Range(found[0], ((low.replace("<", ">"), _number(found[1])), (high, _number(found[4]))))
    if found := _SET.search(comment):
        try:
            return Range(found[0], choices=_in_order(ast.literal_eval(found[0])))
        except (ValueError, SyntaxError, TypeError):
            return Range()
    bounds = tuple((_PLAIN.get(sign, sign), _number(bound)) for sign, bound in _BOUND.findall(comment))
    return Range(", ".join(f"{sign} {bound:g}" for sign, bound in bounds), bounds)
