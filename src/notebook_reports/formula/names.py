"""What the names in a formula mean where nothing else is said."""

from collections.abc import Callable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from sympy import Expr

_CIRCULAR = ("sin", "cos", "tan", "asin", "acos", "atan")
FUNCTIONS = ("sqrt", "exp", "log", *_CIRCULAR, "sinh", "cosh", "tanh", "abs", "min", "max")
"""What every formula may call; `log` is the natural logarithm."""

_NAMES_IN_SYMPY = {"abs": "Abs", "min": "Min", "max": "Max"}


class Symbols(dict[str, "Expr"]):
    """Names with a meaning; any other name becomes a symbol.

    >>> from sympy import Symbol
    >>> T = Symbol("T", positive=True)
    >>> names = Symbols(T=T)
    >>> names["T"] is T, names["K"]
    (True, K)
    """

    def __missing__(self, name: str) -> "Expr":
        from sympy import Symbol

        return Symbol(name)


def sample_point(name: str, shift: int) -> "Expr":
    """A sample as a function of the integer k.

    >>> sample_point("y", -1)
    y(k - 1)
    """
    from sympy import Function, Symbol

    return Function(name)(Symbol("k", integer=True) + shift)


def standard_functions() -> dict[str, Callable[..., "Expr"]]:
    """FUNCTIONS as SymPy has them."""
    import sympy

    return {name: getattr(sympy, _NAMES_IN_SYMPY.get(name, name)) for name in FUNCTIONS}
