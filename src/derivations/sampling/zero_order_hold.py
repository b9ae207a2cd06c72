"""Zero-order-hold sampling of a linear process with dead time, derived from its impulse response.

Between samples the input is constant, so the output at sample k is a sum over earlier inputs of

    h_i = integral of g(t) over ((i - 1) h - L, i h - L),      g(t) = sum of the residues of G(s) e^(st)

where g(t) = 0 for t < 0. Every mode e^(pt) of g obeys (1 - e^(ph) z^-1) mode = 0 from its first samples on, so with

    A(z) = product of (1 - e^(p h) z^-1)      B(z) = A(z) sum of h_i z^-i

the numerator B is finite: n + d terms, or one more where the dead time is no whole number of samples. Multiple poles,
such as two equal lags, need no special case: their residue carries the factor t.
"""

from dataclasses import dataclass
from functools import cache, cached_property

import sympy as sp

from derivations.algebra.delay_polynomials import Z, coefficients, polynomial
from derivations.algebra.rational import factored
from derivations.errors import LoopbookError

S = sp.Symbol("s")
T = sp.Symbol("t", positive=True)


class SamplingError(LoopbookError):
    """The process cannot be sampled as asked; the message says what is wrong with which argument."""


@dataclass(frozen=True)
class Sampled:
    """A process sampled with a zero-order hold: y = (B/A) u, both in z^-1, A starting with 1.

    h: sampling interval, s. whole, part: the dead time is (whole + part) h with 0 <= part < 1.
    """

    A: sp.Expr
    B: sp.Expr
    h: sp.Expr
    whole: int
    part: sp.Expr
    z: sp.Symbol = Z

    @cached_property
    def coefficients(self) -> dict[str, sp.Expr]:
        """a_1, a_2, ..., b_1, b_2, ...: number = delay; the b of the dead time, which are zero, are left out."""
        a, b = coefficients(self.A, "A", self.z), coefficients(self.B, "B", self.z)
        named = {f"a_{i}": c for i, c in enumerate(a) if i} | {f"b_{i}": c for i, c in enumerate(b) if c != 0}
        return named

    @cached_property
    def transfer(self) -> sp.Expr:
        """B/A as a fraction of polynomials in z."""
        n = max(len(coefficients(p, z=self.z)) for p in (self.A, self.B)) - 1
        return sp.expand(self.B * self.z**n) / sp.expand(self.A * self.z**n)


def modes(G: sp.Expr, s: sp.Symbol = S, t: sp.Symbol = T) -> dict[sp.Expr, sp.Expr]:
    """{p: r} such that g(t) is the sum of r(t) e^(pt): the residues of G(s) e^(st); r is a polynomial in t.

    Raises SamplingError where G is not strictly proper and rational, or its denominator has an irreducible factor of
    degree 3 or more.

    >>> from sympy.abc import a
    >>> modes(1 / (S + a)), modes(1 / (S + a) ** 2)
    ({-a: 1}, {-a: t})
    """
    found, poles = {}, _poles(G, s)
    num, den = sp.fraction(sp.cancel(sp.together(G)))
    lead = sp.LC(den, s)
    for pole, order in poles.items():
        others = sp.Mul(*((s - other) ** times for other, times in poles.items() if other != pole))
        regular = num / (lead * others) * sp.exp(s * t)
        residue = sp.diff(regular, s, order - 1) / sp.factorial(order - 1)
        found[pole] = sp.expand(sp.expand(residue * sp.exp(-s * t)).subs(s, pole))
    return found


def impulse_response(G: sp.Expr, s: sp.Symbol = S, t: sp.Symbol = T) -> sp.Expr:
    """g(t) for t > 0: the sum of the `modes` of G.

    >>> impulse_response(1 / (S * (S + 1)))
    1 - exp(-t)
    """
    return sp.Add(*(r * sp.exp(p * t) for p, r in modes(G, s, t).items()))


def _poles(G: sp.Expr, s: sp.Symbol) -> dict[sp.Expr, int]:
    """The poles of G with their orders."""
    num, den = sp.fraction(sp.cancel(sp.together(G)))
    if not (num.is_polynomial(s) and den.is_polynomial(s)):
        raise SamplingError(f"G = {G} must be rational in {s}; give the dead time as whole and part")
    if sp.degree(num, s) >= sp.degree(den, s):
        raise SamplingError(f"G = {G} must be strictly proper: the output cannot jump with the input")
    poles = sp.roots(sp.Poly(den, s), cubics=False, quartics=False)
    if sum(poles.values()) != sp.degree(den, s):
        raise SamplingError(f"G = {G}: the denominator must be a product of factors of degree 1 and 2")
    return dict(sorted(poles.items(), key=lambda item: sp.default_sort_key(item[0])))


def zero_order_hold(
    G: sp.Expr, h: sp.Expr, whole: int = 0, part: sp.Expr = sp.S.Zero, s: sp.Symbol = S, z: sp.Symbol = Z
) -> Sampled:
    """Sample G(s) e^(-Ls), L = (whole + part) h, with a zero-order hold.

    G: strictly proper rational function of s, symbolic or exact. h: sampling interval, s, > 0. whole: 0, 1, 2, ....
    part: 0 <= part < 1, a number or a symbol. Symbols without assumptions stand for real numbers, h for a positive one.
    Complex pairs of poles give cosines and sines. Raises SamplingError for what is out of these ranges.

    >>> first_order = zero_order_hold(1 / (1 + S * sp.Symbol("T", positive=True)), sp.Symbol("h", positive=True))
    >>> first_order.coefficients
    {'a_1': -exp(-h/T), 'b_1': 1 - exp(-h/T)}
    >>> zero_order_hold(1 / (S**2 + 1), sp.pi / 2).coefficients
    {'a_1': 0, 'a_2': 1, 'b_1': 1, 'b_2': 1}
    """
    h, part = sp.sympify(h, strict=True), sp.sympify(part, strict=True)
    if h.is_positive is False or h.has(sp.Float):
        raise SamplingError(f"h = {h}: the sampling interval must be an exact number or a symbol, > 0 s")
    if not (isinstance(whole, int) and whole >= 0):
        raise SamplingError(f"whole = {whole}: the whole samples of dead time must be 0, 1, 2, ...")
    if part.is_number and not (0 <= part < 1):
        raise SamplingError(f"part = {part}: the fraction of a sample of dead time must lie in [0, 1)")
    G = sp.sympify(G, strict=True)
    if any(e.has(z) for e in (G, h, part)):
        raise SamplingError(f"G, h or part holds {z}, the variable of the sampled model: name that quantity otherwise")
    plain = _without_assumptions((G, h, part), s, positive=h)
    if plain:
        try:
            found = zero_order_hold(G.subs(plain), h.subs(plain), whole, part.subs(plain), s, z)
        except SamplingError as error:
            text = str(error)
            for symbol, dummy in plain.items():
                text = text.replace(str(dummy), str(symbol))
            raise SamplingError(text) from None
        back = {dummy: symbol for symbol, dummy in plain.items()}
        return Sampled(found.A.subs(back), found.B.subs(back), h, whole, part, z)
    poles = _poles(G, s)
    x = {p: sp.Dummy(f"x{i}") for i, p in enumerate(poles) if p != 0}  # e^(ph)
    y = {p: sp.Dummy(f"y{i}") if part != 0 else sp.S.One for i, p in enumerate(x)}  # e^(-p part h)
    a = [sp.S.One]
    for pole in (p for p, order in poles.items() for _ in range(order)):
        a = [c - x.get(pole, 1) * previous for c, previous in zip([*a, 0], [0, *a], strict=True)]
    area = _step_response(modes(G, s), h, part, x, y)
    last = len(a) - 1 + whole + (part != 0)
    steps = [area(i - whole) for i in range(last + 1)]
    pulse = [sp.S.Zero] + [steps[i] - steps[i - 1] for i in range(1, last + 1)]
    b = [sum((a[j] * pulse[i - j] for j in range(min(i, len(a) - 1) + 1)), sp.S.Zero) for i in range(last + 1)]
    oscillating = [p for p in x if p.has(sp.I) and sp.im(p) != 0]
    if oscillating:
        a, b = ([_of_real_modes(c, x, y, oscillating, h, part) for c in values] for values in (a, b))
    back = {x[p]: sp.exp(p * h) for p in x} | {y[p]: sp.exp(-p * part * h) for p in x if part != 0}
    a, b = ([c.subs(back) if oscillating else factored(c).subs(back) for c in values] for values in (a, b))
    return Sampled(polynomial(a, z), polynomial(b, z), h, whole, part, z)


@cache
def _primitive(power: int) -> tuple[sp.Expr, sp.Symbol]:
    """R(t, p) with d/dt (R e^(pt)) = t^power e^(pt), found by integration; p is not zero."""
    p = sp.Symbol("p", nonzero=True)
    return sp.expand(sp.integrate(T**power * sp.exp(p * T), T) * sp.exp(-p * T)), p


def _step_response(
    found: dict[sp.Expr, sp.Expr], h: sp.Expr, part: sp.Expr, x: dict[int, sp.Expr], y: dict[int, sp.Expr]
) -> sp.Expr:
    """n -> integral of g from 0 to (n - part) h, zero where that is not positive, with x, y for the exponentials."""

    def integral(pole: sp.Expr, r: sp.Expr, n: int) -> sp.Expr:
        total, until = sp.S.Zero, (n - part) * h
        for (power,), c in sp.Poly(r, T).terms():
            if pole == 0:
                total += c * until ** (power + 1) / (power + 1)
                continue
            R, p = _primitive(power)
            R = R.subs(p, pole)
            total += c * (R.subs(T, until) * x[pole] ** n * y[pole] - R.subs(T, 0))
        return total

    return lambda n: sum((integral(p, r, n) for p, r in found.items()), sp.S.Zero) if n > 0 else sp.S.Zero


def _without_assumptions(given: tuple[sp.Expr, ...], s: sp.Symbol, positive: sp.Expr) -> dict[sp.Symbol, sp.Symbol]:
    """For each symbol of which nothing is known: one of the same name that is real, or positive where it is h."""
    free = set().union(*(e.free_symbols for e in given)) - {s}
    unknown = sorted((x for x in free if x.is_real is None), key=str)
    return {x: sp.Dummy(x.name, **({"positive": True} if x == positive else {"real": True})) for x in unknown}


def _of_real_modes(c: sp.Expr, x: dict, y: dict, oscillating: list[sp.Expr], h: sp.Expr, part: sp.Expr) -> sp.Expr:
    """A coefficient in which e^(ph) and e^(-p part h) of complex poles p are decay times cosine and sine.

    Conjugate poles stand in it alike, so that its imaginary part vanishes as a polynomial in real symbols.
    """
    inside: dict[sp.Symbol, sp.Expr] = {}
    back: dict[sp.Symbol, sp.Expr] = {}
    for p in oscillating:
        decay, turn = sp.re(p), sp.im(p)
        sign = -1 if turn.could_extract_minus_sign() else 1
        speed = sign * turn
        for symbol, time in ((x[p], h), (y[p], -part * h)):
            if symbol == 1:
                continue
            key = sp.exp(decay * time), sp.cos(speed * time), sp.sin(speed * time)
            size, cosine, sine = (_named(back, e) for e in key)
            inside[symbol] = size * (cosine + sp.I * sign * sine)
    real = sp.expand(sp.expand_complex(sp.expand(c)).subs(inside)) if not c.is_number else sp.expand_complex(c)
    real = sp.expand(sum(_real_part(term) for term in sp.Add.make_args(real)))
    sines = {symbol: e for symbol, e in back.items() if isinstance(e, sp.sin)}
    for symbol, e in sines.items():
        cosine = next(c for c, other in back.items() if other == sp.cos(e.args[0]))
        real = sp.expand(sp.rem(real, symbol**2 + cosine**2 - 1, symbol)) if real.has(symbol) else real
    return sp.factor_terms(real).subs(back)


def _named(back: dict[sp.Symbol, sp.Expr], e: sp.Expr) -> sp.Expr:
    """A real symbol for the expression, the same one for the same expression; numbers stay."""
    if e.is_number and e in (0, 1, -1):
        return e
    for symbol, other in back.items():
        if other == e:
            return symbol
    symbol = sp.Dummy(f"m{len(back)}", real=True)
    back[symbol] = e
    return symbol


def _real_part(term: sp.Expr) -> sp.Expr:
    number, rest = term.as_independent(*(f for f in term.atoms(sp.Dummy)), as_Add=False)
    return sp.re(number) * rest


def dead_time_in_samples(L: sp.Expr, h: sp.Expr) -> tuple[int, sp.Expr]:
    """(whole, part) with L = (whole + part) h and 0 <= part < 1.

    L, h: exact numbers or symbols whose ratio is a number >= 0. Raises SamplingError where it is not.

    >>> dead_time_in_samples(sp.Rational(5, 2), 1), dead_time_in_samples(2, 1)
    ((2, 1/2), (2, 0))
    """
    ratio = sp.cancel(sp.sympify(L, strict=True) / sp.sympify(h, strict=True))
    if not ratio.is_Rational:
        raise SamplingError(f"L/h = {ratio} must be an exact number: say how many samples with whole and part")
    if ratio < 0:
        raise SamplingError(f"L/h = {ratio}: a dead time cannot be negative")
    whole = int(sp.floor(ratio))
    return whole, ratio - whole


def two_lags(T1: sp.Expr, T2: sp.Expr, gain: sp.Expr = sp.S.One, s: sp.Symbol = S) -> sp.Expr:
    """gain / ((T1 s + 1)(T2 s + 1)), time constants in s."""
    return gain / ((T1 * s + 1) * (T2 * s + 1))
