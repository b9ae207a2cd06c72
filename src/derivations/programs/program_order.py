"""Formulas as a program evaluates them: one line of arithmetic per statement, in a fixed order of operations.

Rounding depends on the order of operations, so a run that must agree digit by digit with a compiled program needs the
order as well as the formula. A statement is text with + - * / and parentheses, which reads the same in C and in
Python. The text is never trusted: `plant` and `regulator` return it only after SymPy has shown that the statements
together equal the derived difference equations.
"""

import ast
import operator
from dataclasses import dataclass
from functools import cache

import sympy as sp
from sympy import Expr

from derivations.errors import LoopbookError
from derivations.programs import positional_pid, two_lag_euler

_ARITHMETIC = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv}


@dataclass(frozen=True)
class Statement:
    """``target = text``."""

    target: str
    text: str


class OrderMismatch(LoopbookError):
    """The statements do not add up to the derived equation; the message shows both."""


def composed(statements: tuple[Statement, ...]) -> dict[str, Expr]:
    """What every target is in terms of the inputs, by substituting the statements into each other.

    >>> composed((Statement("m", "a*b"), Statement("x", "1/m")))["x"]
    1/(a*b)
    """
    found: dict[str, Expr] = {}
    for statement in statements:
        found[statement.target] = _value(ast.parse(statement.text, mode="eval").body, found)
    return found


def _value(node: ast.expr, known: dict[str, Expr]) -> Expr:
    match node:
        case ast.BinOp(left, sign, right) if type(sign) in _ARITHMETIC:
            return _ARITHMETIC[type(sign)](_value(left, known), _value(right, known))
        case ast.UnaryOp(ast.USub(), operand):
            return -_value(operand, known)
        case ast.Name(name):
            return known.get(name, sp.Symbol(name))
        case ast.Constant(int(number)):
            return sp.Integer(number)
    raise ValueError(f"{ast.unparse(node)} is no arithmetic of names and whole numbers")


def _proved(statements: tuple[Statement, ...], derived: dict[str, Expr]) -> tuple[Statement, ...]:
    found = composed(statements)
    for target, expression in derived.items():
        plain = expression.subs({x: sp.Symbol(x.name) for x in expression.free_symbols})
        if sp.simplify(found[target] - plain) != 0:
            raise OrderMismatch(f"{target}: the statements give {found[target]}, derived is {plain}")
    return statements


@cache
def plant() -> tuple[Statement, ...]:
    """One Euler step of k/((1 + s T1)(1 + s T2)): n1 and n2 from x1, x2, u, h, in the order of pid_test.c."""
    statements = (
        Statement("m", "T1*T2"),
        Statement("d2", "-(T1 + T2)/m*x2 - 1/m*x1 + k/m*u"),
        Statement("n1", "x1 + h*x2"),
        Statement("n2", "x2 + h*d2"),
    )
    step = two_lag_euler.euler_step()
    return _proved(statements, {"n1": step[two_lag_euler.x1], "n2": step[two_lag_euler.x2]})


@cache
def regulator() -> tuple[Statement, ...]:
    """The positional PID law: up, ui, ud from e, last and the sum that holds e already, in the order of pid_test.c."""
    statements = (Statement("up", "Kp*e"), Statement("ui", "total*h*Kp/Ti"), Statement("ud", "(e - last)/h*Kp*Td"))
    terms = positional_pid.terms()
    return _proved(statements, {"up": terms["P"], "ui": terms["I"], "ud": terms["D"]})
