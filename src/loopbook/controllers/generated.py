"""Python functions written from the derived expressions: gains, one step, and a loop over arrays.

The formulas come from `derivations.programs.pid_code.weighted` (figure 4.13 of pid-report with a weight c on the
derivative) and `derivations.programs.bumpless`; this module adds limits, the rules of anti-windup and the order of
execution.
"""

from collections.abc import Callable, Mapping
from functools import cache, wraps
from typing import Any

from loopbook.lazy import late
from loopbook.printed.store import kept_for

laws, code = late("derivations.pid.pid_laws"), late("derivations.programs.pid_code")
bumpless = late("derivations.programs.bumpless")

GAINS = ("p_1", "p_2", "p_3", "p_4", "p_5", "p_6", "p_24", "c")
RULES = ("tracking", "none", "conditional", "conditional-safe", "clamping")
BOTH = tuple((rule, rate) for rule in RULES for rate in (False, True))


def _text(expr: Any, names: Mapping[str, str] | None = None) -> str:
    """Python text of an expression; symbols may be renamed, for example to attributes."""
    import sympy

    names = names or {}
    renamed = expr.xreplace({s: sympy.Symbol(names[s.name]) for s in expr.free_symbols if s.name in names})
    return sympy.pycode(renamed)


def _function(text: Callable[..., str]) -> Callable[..., Callable]:
    """The function whose text the decorated one writes; its text is its docstring."""

    @cache
    @wraps(text)
    def compiled(*args: Any) -> Callable:
        source, space = text(*args), {}  # type: str, dict[str, Any]
        exec(compile(source, f"<generated {text.__name__}>", "exec"), space)
        function = space[source.split("(", 1)[0].removeprefix("def ")]
        function.__doc__ = source
        return function

    return compiled


@_function
@kept_for()
def gains() -> str:
    """(K, Ti, Td, Tf, b, c, h, Tt) -> p_1 ... p_6, p_24 and c, as in eqs 4.3, 4.4, 4.11, 4.12, 4.17 to 4.19.

    Ti = None gives p_5 = p_6 = 0: without integral action I is a constant offset.
    """
    values = {s.name: v for s, v in code.weighted().gain_values().items()} | {"p_24": code.derivative_gain()}
    lines = ["def gains(K, T_i, T_d, T_f, b, c, h, T_t):"]
    lines += [f"    {p} = {_text(values[p])}" for p in GAINS if p not in ("p_5", "p_6", "c")]
    lines += [f"    {p} = 0 * K if T_i is None else {_text(values[p])}" for p in ("p_5", "p_6")]
    return "\n".join([*lines, f"    return {', '.join(GAINS)}"])


@_function
@kept_for()
def parallel_gains() -> str:
    """(P, I, D, Tf, b, c, h, Tt) -> the same, with K/Ti = I and K Td = D, so that each may be zero; I = None: none.

    No division by P is left; raises ArithmeticError if there were.
    """
    import sympy

    P, I, D = (sympy.Symbol(name) for name in ("P", "I", "D"))
    values = {s.name: v for s, v in code.weighted().gain_values().items()} | {"p_24": code.derivative_gain()}
    given = {
        name: sympy.cancel(values[name].subs({laws.Ti: laws.K / I, laws.Td: D / laws.K})).subs(laws.K, P)
        for name in values
    }
    if any(P in sympy.denom(sympy.together(value)).free_symbols for value in given.values()):
        raise ArithmeticError("a gain is divided by P")
    lines = ["def parallel_gains(P, I, D, T_f, b, c, h, T_t):"]
    lines += [f"    {p} = {_text(given[p])}" for p in GAINS if p not in ("p_5", "p_6", "c")]
    lines += [f"    {p} = 0 * h if I is None else {_text(given[p])}" for p in ("p_5", "p_6")]
    return "\n".join([*lines, f"    return {', '.join(GAINS)}"])


@cache
def expressions() -> dict[str, Any]:
    """v, the new x, the new I with tracking, and the new I without: SymPy expressions of the weighted program."""
    assigned = {a.target.name: a.value for a in code.weighted().before + code.weighted().after}
    tracked = assigned["I"]
    return {"v": assigned["v"], "x": assigned["x"], "I": tracked, "I_free": tracked.subs(code.p6, 0)}


def _integral_lines(rule: str, names: Mapping[str, str], low: str, high: str) -> list[str]:
    """How I moves after the output is set; v, u, y, y_sp and the old I are known."""
    state = names.get("I", "I")
    free = f"{state} = {_text(expressions()['I_free'], names)}"
    return {
        "tracking": [f"{state} = {_text(expressions()['I'], names)}"],
        "none": [free],
        "conditional": ["if u == v:", f"    {free}"],
        "conditional-safe": [f"if u == v or {names.get('p_5', 'p_5')} * (y_sp - y) * (v - u) < 0:", f"    {free}"],
        "clamping": [
            free,
            f"if {state} > {high}:",
            f"    {state} = {high}",
            f"elif {state} < {low}:",
            f"    {state} = {low}",
        ],
    }[rule]


def _limit_lines(rate: bool, low: str, high: str, last: str, step: str) -> list[str]:
    lines = [f"u = {high} if v > {high} else {low} if v < {low} else v"]
    if rate:
        lines += [
            f"if {last} is not None:",
            f"    if u > {last} + {step}:",
            f"        u = {last} + {step}",
            f"    elif u < {last} - {step}:",
            f"        u = {last} - {step}",
        ]
    return lines


@_function
@kept_for(*BOTH)
def step(rule: str, rate: bool) -> str:
    """One automatic sample: step(self, y, y_sp) -> u; sets self.v, self.u, self.I, self.x."""
    names = {name: f"self._{name}" for name in GAINS} | {"I": "self.I", "x": "self.x"}
    limits = ("self._low", "self._high")
    body = [
        f"v = {_text(expressions()['v'], names)}",
        *_limit_lines(rate, *limits, "self.u", "self._step"),
        f"self.x = {_text(expressions()['x'], names)}",
        *_integral_lines(rule, names, *limits),
        "self.v = v",
        "self.u = u",
        "return u",
    ]
    return "\n".join(["def step(self, y, y_sp):", *("    " + line for line in body)])


@_function
@kept_for(*BOTH)
def run_samples(rule: str, rate: bool) -> str:
    """Many samples: run(gains, state, y, y_sp, out) fills out and returns the state (I, x, v, u).

    All y and y_sp must be finite; states are local variables.
    """
    body = [
        f"{', '.join(GAINS)}, low, high, step = gains",
        "I, x, v, last = state",
        "k = 0",
        "for y, y_sp in zip(measurements, set_points):",
        f"    v = {_text(expressions()['v'])}",
        *("    " + line for line in _limit_lines(rate, "low", "high", "last", "step")),
        f"    x = {_text(expressions()['x'])}",
        *("    " + line for line in _integral_lines(rule, {}, "low", "high")),
        "    out[k] = last = u",
        "    k += 1",
        "return I, x, v, last",
    ]
    head = "def run(gains, state, measurements, set_points, out):"
    return "\n".join([head, *("    " + line for line in body)])


@_function
@kept_for()
def bumpless_change() -> str:
    """New x and I after a change of settings, from `derivations.programs.bumpless.keep_both_parts`."""
    new = {s.name: value for s, value in bumpless.keep_both_parts().items()}
    arguments = "I, x, y, y_sp, K_old, b_old, c_old, p_24old, K_new, b_new, c_new, p_24new"
    return f"def bumpless_change({arguments}):\n    return {_text(new['x'])}, {_text(new['I'])}"


@_function
@kept_for(("4.13",))
def program_pass(figure: str) -> str:
    """One pass of a printed program: f(values) -> values, with the names of the settings and variables as keys."""
    program = {**code.programs(), "4.7": code.conditional(), "shortest": code.shortest()}[figure]
    lines = ["def program_pass(known):"]
    names = sorted({s.name for a in program.before + program.after for s in a.value.free_symbols})
    lines += [f"    {name} = known.get({name!r})" for name in names]
    for a in program.before + program.after:
        value = "u_high if v > u_high else u_low if v < u_low else v" if a.target == code.OUTPUT else _text(a.value)
        lines.append(f"    {a.target.name} = {value}")
    kept = ", ".join(f"{s.name!r}: {s.name}" for s in (*program.states(), code.u, code.v))
    return "\n".join([*lines, f"    return {{{kept}}}"])


@_function
@kept_for(("4.13",))
def program_gains(figure: str) -> str:
    """(K, Ti, Td, Tf, b, h, Tt) -> gains by name for a printed program."""
    makers = {
        "4.7": code.conditional,
        "4.9": code.separate,
        "4.10": code.separate_split,
        "4.11": code.merged,
        "4.12": code.merged_state,
        "4.13": code.minimal,
        "shortest": code.shortest,
    }
    program = makers[figure]()
    pairs = ", ".join(f"{s.name!r}: {_text(value)}" for s, value in program.gain_values().items())
    return f"def program_gains(K, T_i, T_d, T_f, b, h, T_t):\n    return {{{pairs}}}"
