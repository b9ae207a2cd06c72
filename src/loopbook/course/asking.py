"""The functions that an author of sheets learns: `answer` and `require`."""

from collections.abc import Mapping, Sequence
from typing import Any

from loopbook.course.errors import SheetError
from loopbook.course.kinds.choice import Choice, as_options
from loopbook.course.kinds.curve import PlottedData
from loopbook.course.kinds.formula import Formula
from loopbook.course.kinds.function import Conditions, Function
from loopbook.course.kinds.kind import Kind
from loopbook.course.kinds.number import OneNumber, SeveralNumbers
from loopbook.course.kinds.polynomial import Polynomial
from loopbook.course.question import Asked
from loopbook.course.session import current
from loopbook.course.tolerance import Tolerance, read_tolerance

KINDS = ("number", "numbers", "polynomial", "formula", "choice", "curve", "function")


def require(condition: Any, why: str) -> None:
    """Numbers for which the condition fails are not used: others are drawn. why: what they would spoil.

    >>> require(0.1 < 0.3 < 0.7, "neither lag nor dead time alone decides")
    """
    current().require(condition, why)


def answer(
    name: str,
    value: Any,
    *,
    kind: str = "",
    unit: str = "",
    digits: int | None = None,
    tolerance: str | float | None = None,
    points: float = 1,
    wrong: Mapping[str, Any] | None = None,
    says: str = "",
    options: Sequence[str] | None = None,
    reason: str = "",
    reasons: Sequence[str] = (),
    symbols: str = "",
    symbol: str = "z",
    names: str = "",
    any_order: bool = False,
    x: Sequence[float] = (),
    of: str = "x",
    takes: str = "",
    holds: Conditions | None = None,
) -> Any:
    """Ask for `name`, whose right value is `value`; what it returns the sheet goes on with.

    That is the value, and where a student's work is judged the student's own: so a wrong answer costs its own points
    and not those of what follows from it.

    kind: number, numbers, polynomial, formula, choice, curve or function; default: by the value. unit: of numbers.
    digits (3) or tolerance ("3 %", or a number in the unit): see `read_tolerance`. points: what it is worth.
    wrong: the value that each named wrong method gives; at least three tolerances from the right one.
    says: what it is, where the name does not tell.
    formula: symbols, "K T_i h e[k] e[k-1]", are the letters that may stand in it. polynomial: symbol. numbers: names
    of each, "b1 b2", or any_order=True, as for roots. choice: options (yes and no), reasons with the right reason among
    them. curve: x, the places of its values, and of, their name. function: takes, its arguments.
    holds: a function of the answer that gives conditions by their words; any answer is right that fulfils all, and
    `value` is one that does. Raises SheetError.

    >>> from loopbook.course.session import Session, during
    >>> with during(Session()) as session:
    ...     K = answer("K", 1.25, unit="%/°C", points=2, wrong={"gain left out": 2.5})
    >>> K, session.asked["K"].right(1.249), session.asked["K"].right(2.5)
    (1.25, True, False)
    >>> with during(Session(own={"K": 2.5}, strict=False)):
    ...     answer("K", 1.25)
    2.5
    """
    session = current()
    if holds is not None and wrong:
        raise SheetError(f"{name}: an answer with conditions has no wrong methods; say the conditions")
    try:
        width = read_tolerance(digits, tolerance)
        chosen = kind or _kind_of(value)
        made = _made(
            chosen, value, width, unit, options, reason, reasons, symbols, symbol, names, any_order, x, of, takes
        )
        keys = {str(method): made.key(found) for method, found in (wrong or {}).items()}
        key = made.key(value)
    except SheetError as error:
        raise SheetError(f"answer {name!r}: {error}") from None
    return session.ask(Asked(str(name), made, value, key, float(points), keys, holds, session.cell, says))


def _kind_of(value: Any) -> str:
    if callable(value) and not hasattr(value, "free_symbols"):
        return "function"
    if isinstance(value, str) or type(value).__name__ in ("bool", "bool_", "BooleanTrue", "BooleanFalse"):
        return "choice"
    if getattr(value, "free_symbols", None):
        return "formula"
    return "numbers" if hasattr(value, "__len__") else "number"


def _made(
    kind: str,
    value: Any,
    width: Tolerance,
    unit: str,
    options: Sequence[str] | None,
    reason: str,
    reasons: Sequence[str],
    symbols: str,
    symbol: str,
    names: str,
    any_order: bool,
    x: Sequence[float],
    of: str,
    takes: str,
) -> Kind:
    match kind:
        case "number":
            return OneNumber(width, unit, whole=type(value) is int or bool(getattr(value, "is_Integer", False)))
        case "numbers":
            return SeveralNumbers(width, len(value), unit, tuple(names.split()), any_order)
        case "polynomial":
            return Polynomial(width, symbol, unit)
        case "formula":
            if not symbols:
                raise SheetError('a formula needs symbols="K T ...", the letters that may stand in it')
            return Formula(symbols, unit)
        case "choice":
            return Choice(as_options(options), tuple(reasons), reason, unit)
        case "curve":
            return PlottedData(width, tuple(float(v) for v in x), unit, of)
        case "function":
            return Function(takes, unit)
    raise SheetError(f"kind is one of {', '.join(KINDS)}, got {kind!r}")
