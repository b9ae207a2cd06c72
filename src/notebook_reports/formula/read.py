"""Formulas written as text, read as mathematics by a grammar: what is read is never run.

    equations = equation (";" equation)*
    equation  = side ("=" side)?
    side      = sum | "[" sum ("," sum)* "]" | "[" row ("," row)* "]"         row = "[" sum ("," sum)* "]"
    sum       = product (("+" | "-") product)*
    product   = unary (("*" | "/") unary)*
    unary     = ("+" | "-") unary | atom (("**" | "^") unary)?
    atom      = number | name | name "(" sum ("," sum)* ")" | name "[" "k" (("+" | "-") digits)? "]" | "(" sum ")"

Numbers are exact decimals, a list is a column and a list of rows a matrix. Text from anybody may be read: its length,
nesting, numbers, powers and the terms that it has when multiplied out are limited (`formula.size`), so that reading
a formula and multiplying it out end soon.
"""

from collections.abc import Callable, Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, TypeVar

from notebook_reports.formula import size as limits
from notebook_reports.formula.names import FUNCTIONS, Symbols, sample_point, standard_functions
from notebook_reports.formula.size import Size
from notebook_reports.formula.words import FormulaError, Lexeme, UnknownName, lexemes
from notebook_reports.mathematics.errors import nearest

if TYPE_CHECKING:
    from sympy import Expr, MatrixBase

__all__ = ["FUNCTIONS", "FormulaError", "Symbols", "UnknownName", "read_equations", "read_formula"]


def read_formula(
    text: str,
    names: Mapping[str, "Expr"] | None = None,
    functions: Mapping[str, Callable[..., "Expr"]] | None = None,
    *,
    samples: Callable[[str, int], "Expr"] = sample_point,
    where: str = "",
) -> "Expr":
    """One expression in SymPy, from text that is never run.

    names: what the names mean, and with a plain dict no other may stand; default: a symbol for each. `pi` is the number
    unless it is given. functions: what may be called beside FUNCTIONS. samples: the meaning of `y[k-1]`, from
    ("y", -1); LookupError for one that may not stand. where: begins the message of an error.
    Raises UnknownName for what may not stand, and FormulaError for any other text that is no formula.

    >>> read_formula("K*(1 + 1/(T_i*s)) - 0.5*y[k-1]")
    K*(1 + 1/(T_i*s)) - y(k - 1)/2
    >>> read_formula("9**9**9")
    Traceback (most recent call last):
    ...
    notebook_reports.formula.read.FormulaError: character 2: the exponent is beyond 100
      9**9**9
       ^
    """
    reader = _Reader(text, names, functions, samples, where)
    value = reader.sum()[0]
    reader.end()
    return value


def read_equations(
    text: str,
    names: Mapping[str, "Expr"] | None = None,
    functions: Mapping[str, Callable[..., "Expr"]] | None = None,
    *,
    samples: Callable[[str, int], "Expr"] = sample_point,
    where: str = "",
) -> list[tuple["Expr | MatrixBase", "Expr | MatrixBase | None"]]:
    """(left, right) of each equation, separated by ";"; right is None for an expression alone. Else as `read_formula`.

    >>> read_equations("a + b = 2*q; [a, 1/2]")
    [(a + b, 2*q), (Matrix([
    [  a],
    [1/2]]), None)]
    """
    reader = _Reader(text, names, functions, samples, where)
    found = [reader.equation()]
    while reader.took(";"):
        found.append(reader.equation())
    reader.end()
    return found


_Measured = tuple["Expr", Size]
_T = TypeVar("_T")


class _Reader:
    """One text, read from left to right; each method reads the part of the grammar that it is named after."""

    def __init__(
        self,
        text: str,
        names: Mapping[str, "Expr"] | None,
        functions: Mapping[str, Callable[..., "Expr"]] | None,
        samples: Callable[[str, int], "Expr"],
        where: str,
    ):
        import sympy

        self.text, self.where, self.samples = text, where, samples
        self.names = Symbols() if names is None else names
        self.functions = standard_functions() | dict(functions or {})
        self.constants = {"pi": sympy.pi}
        self.without_value = (sympy.zoo, sympy.nan, sympy.oo, -sympy.oo)
        self.depth = self.at = 0
        self.words = lexemes(text, where)

    def error(self, reason: str, position: int, kind: type[FormulaError] = FormulaError) -> FormulaError:
        return kind(reason, self.text, position, self.where)

    @property
    def next(self) -> Lexeme:
        return self.words[self.at]

    def take(self) -> Lexeme:
        word = self.next
        self.at += word.kind != "end"
        return word

    def took(self, *signs: str) -> str:
        """The next sign, where it is one of these, and past it; else ""."""
        return self.take().text if self.next.kind == "sign" and self.next.text in signs else ""

    def expected(self, what: str) -> FormulaError:
        found = self.next.text if self.next.kind == "end" else f'"{self.next.text}"'
        return self.error(f"{what} is expected, not {found}", self.next.position)

    def end(self) -> None:
        if self.next.kind != "end":
            raise self.expected("an operator or the end")

    def equation(self) -> tuple["Expr | MatrixBase", "Expr | MatrixBase | None"]:
        left = self.side()
        return left, self.side() if self.took("=") else None

    def side(self) -> "Expr | MatrixBase":
        import sympy

        at = self.next.position
        if not self.took("["):
            return self.entry()
        rows = self.several("]", lambda: self.several("]", self.entry) if self.took("[") else [self.entry()])
        if len({len(row) for row in rows}) > 1:
            raise self.error("the rows of a matrix have the same length", at)
        return sympy.Matrix(rows)

    def entry(self) -> "Expr":
        return self.sum()[0]

    def several(self, closing: str, read: Callable[[], _T]) -> list[_T]:
        found = [read()]
        while self.took(","):
            found.append(read())
        if not self.took(closing):
            raise self.expected(f'an operator, "," or "{closing}"')
        return found

    def sum(self) -> _Measured:
        value, size = self.product()
        while sign := self.took("+", "-"):
            at = self.words[self.at - 1].position
            other, its = self.product()
            value, size = self.checked(value + other if sign == "+" else value - other, size + its, at)
        return value, size

    def product(self) -> _Measured:
        value, size = self.unary()
        while sign := self.took("*", "/"):
            at = self.words[self.at - 1].position
            other, its = self.unary()
            if sign == "/" and other == 0:
                raise self.error("division by zero", at)
            value = value * other if sign == "*" else value / other
            value, size = self.checked(value, size * (its if sign == "*" else its.inverse), at)
        return value, size

    def unary(self) -> _Measured:
        if self.depth >= limits.DEPTH:
            raise self.error(f"more than {limits.DEPTH} brackets, signs and powers in each other", self.next.position)
        self.depth += 1
        if sign := self.took("+", "-"):
            value, size = self.unary()
            value = -value if sign == "-" else value
        else:
            value, size = self.atom()
            if self.took("**", "^"):
                value, size = self.power(value, size, self.words[self.at - 1].position)
        self.depth -= 1
        return value, size

    def power(self, base: "Expr", size: Size, at: int) -> _Measured:
        exponent = self.unary()[0]
        power = limits.power(exponent)
        if abs(power) > limits.EXPONENT:
            raise self.error(f"the exponent is beyond {limits.EXPONENT}", at)
        if base == 0 and not exponent.is_positive:
            raise self.error("a power of zero has a positive exponent", at)
        if base.is_number and exponent.is_number and limits.digits(base) * limits.magnitude(exponent) > limits.DIGITS:
            raise self.error(f"the power has more than {limits.DIGITS} digits", at)
        return self.checked(base**exponent, size.to(int(power)), at)

    def checked(self, value: "Expr", size: Size, at: int) -> _Measured:
        if value in self.without_value:
            raise self.error("this has no value", at)
        if size.terms > limits.TERMS:
            raise self.error(f"multiplied out this has more than {limits.TERMS} terms", at)
        return value, size

    def atom(self) -> _Measured:
        word = self.take()
        if word.kind == "number":
            return self.number(word), Size()
        if word.kind == "name":
            if self.took("("):
                return self.call(word)
            return self.sampled(word) if self.took("[") else (self.named(word), Size())
        if word.kind == "sign" and word.text == "(":
            value, size = self.sum()
            if not self.took(")"):
                raise self.expected('an operator or ")"')
            return value, size
        self.at -= word.kind != "end"
        raise self.expected('a number, a name or "("')

    def number(self, word: Lexeme) -> "Expr":
        import sympy

        digits, _, exponent = word.text.lower().partition("e")
        if len(digits) > limits.DIGITS or (exponent and abs(int(exponent[:9])) > limits.EXPONENT):
            raise self.error(f"a number has at most {limits.DIGITS} digits, 1e{limits.EXPONENT}", word.position)
        exact = Fraction(word.text)
        return sympy.Rational(exact.numerator, exact.denominator)

    def named(self, word: Lexeme) -> "Expr":
        if word.text in self.constants and word.text not in self.names:
            return self.constants[word.text]
        try:
            return self.names[word.text]
        except KeyError:
            hint = nearest(word.text, self.names, prefix="")
            raise self.error(f'"{word.text}" is not known{hint}', word.position, UnknownName) from None

    def call(self, word: Lexeme) -> _Measured:
        if word.text not in self.functions:
            hint = nearest(word.text, self.functions, prefix="") or "; a product is written with *"
            raise self.error(f'"{word.text}" is no known function{hint}', word.position, UnknownName)
        arguments = self.several(")", self.entry)
        if any(a.is_number and limits.magnitude(a) > limits.ARGUMENT for a in arguments):
            raise self.error(f"the argument of {word.text} is beyond {limits.ARGUMENT}", word.position)
        try:
            value = self.functions[word.text](*arguments)
        except (TypeError, ValueError) as error:
            raise self.error(f"{word.text} of {len(arguments)}: {error}", word.position) from None
        return self.checked(value, Size(), word.position)

    def sampled(self, word: Lexeme) -> _Measured:
        shift, index = 0, self.take()
        if index.kind != "name" or index.text != "k":
            raise self.error("a sample is written as y[k], y[k-1] or y[k+1]", index.position)
        if sign := self.took("+", "-"):
            steps = self.take()
            if steps.kind != "number" or not steps.text.isdigit() or len(steps.text) > 4:
                raise self.error("a sample is a whole number of steps away, as in y[k-1]", steps.position)
            shift = int(steps.text) if sign == "+" else -int(steps.text)
        if not self.took("]"):
            raise self.expected('"]"')
        try:
            return self.samples(word.text, shift), Size()
        except LookupError:
            instant = f"k{shift:+d}" if shift else "k"
            raise self.error(f"the sample {word.text}[{instant}] is not known", word.position, UnknownName) from None
