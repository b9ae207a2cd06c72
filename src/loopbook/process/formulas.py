"""How transfer functions are written: in LaTeX for a notebook, short in a terminal."""

from collections.abc import Sequence

from loopbook.numerics import polynomial_text
from loopbook.numerics.exponential_polynomial import ExponentialPolynomial

SHOWN, LONGEST = 85, 110


def ratio(num: Sequence[float], den: Sequence[float], delay: float = 0.0) -> str:
    """num/den exp(-delay s) in LaTeX; the denominator as lags where four digits tell them exactly.

    >>> ratio([2], [40, 14, 1], 3)
    '\\\\frac{2}{(10 s + 1) (4 s + 1)} e^{-3 s}'
    """
    below = polynomial_text.lags(den)
    above = polynomial_text.descending(num)
    whole = above if below == "1" else rf"\frac{{{above}}}{{{below}}}"
    turn = exponential(delay)
    if not turn:
        return whole
    if below == "1" and above == "1":
        return turn
    return (f"({whole})" if below == "1" and sum(c != 0 for c in num) > 1 else whole) + f" {turn}"


def exponential(delay: float) -> str:
    """e^(-delay s) in LaTeX, nothing for no delay.

    >>> exponential(0.5), exponential(-2), exponential(0)
    ('e^{-0.5 s}', 'e^{2 s}', '')
    """
    return f"e^{{{polynomial_text.number(-delay)} s}}" if delay else ""


def terms(f: ExponentialPolynomial) -> str:
    """A sum of polynomials times exponentials in LaTeX.

    >>> of = ExponentialPolynomial.of
    >>> terms(of([3, 1]) - of([2], 1.5))
    '3 s + 1 - 2 e^{-1.5 s}'
    """
    text = ""
    for delay, p in f.terms:
        negative = p[0] < 0
        shown = ratio([-c for c in p] if negative else p, [1.0], delay)
        text += f" {'-' if negative else '+'} {shown}" if text else f"-{shown}" if negative else shown
    return text or "0"


def short_row(row: Sequence[float]) -> str:
    """A row for a terminal; of a long one its ends and how many there are.

    >>> short_row((1.0, 2.0)), short_row(tuple(map(float, range(30))))
    ('(1.0, 2.0)', '(0.0, 1.0, ..., 29.0; 30 numbers)')
    """
    text = repr(tuple(row))
    return text if len(text) <= SHOWN else f"({row[0]!r}, {row[1]!r}, ..., {row[-1]!r}; {len(row)} numbers)"


def plain(f: ExponentialPolynomial) -> str:
    """A sum of polynomials times exponentials for a terminal; of a long one its beginning.

    >>> of = ExponentialPolynomial.of
    >>> plain(of([3, 0, 1]) - of([2], 1.5))
    '3 s^2 + 1 - 2 exp(-1.5 s)'
    """
    text = ""
    for delay, p in f.terms:
        for i, c in enumerate(p):
            power = len(p) - 1 - i
            if c:
                size, s = f"{abs(c):.5g}", "" if not power else "s" if power == 1 else f"s^{power}"
                turn = f"exp({-delay:.5g} s)" if delay else ""
                factors = [part for part in (s, turn) if part]
                factor = " ".join(([] if size == "1" and factors else [size]) + factors)
                sign = "-" if c < 0 else "+"
                text += f" {sign} {factor}" if text else factor if c > 0 else f"-{factor}"
    return f"{text[:LONGEST]} ..." if len(text) > LONGEST + 4 else text or "0"
