"""Expressions as a person writes them in a program: positive terms first, names without underscores."""

from sympy import Expr
from sympy.printing.str import StrPrinter


class _Listing(StrPrinter):
    def _print_Add(self, expr: Expr, order: str | None = None) -> str:
        terms = sorted(expr.args, key=lambda part: (part.could_extract_minus_sign(), str(part)))
        first, *rest = (self.parenthesize(part, 0) for part in terms)
        return first + "".join(f" - {part[1:]}" if part.startswith("-") else f" + {part}" for part in rest)


def written(expr: Expr) -> str:
    """One line of program text.

    >>> from sympy import symbols
    >>> y, y_sp, p_5 = symbols("y y_sp p_5")
    >>> written(p_5 * (y_sp - y))
    'p5*(ysp - y)'
    """
    return _Listing().doprint(expr).replace("_", "")
