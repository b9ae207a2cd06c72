"""The programs of pid-report, figures 4.7 and 4.9 to 4.13, as data: assignments in the order they run.

A program has gains (computed when a setting changes), assignments between reading y and setting u, and assignments
after. All of them come from the derived equations by renaming samples to variables, by splitting off what is known
before y is read, and by substitution; none is typed in. From this data come the controllers that run, the counts of
operations, the listings and the proofs of `derivations.programs.equivalence` and `derivations.programs.bumpless`.

Settings keep their symbols (T_f, T_i ...); a listing drops the underscores.
"""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache

from sympy import Add, Eq, Expr, Piecewise, Symbol, collect, expand, factor, symbols

from derivations.algebra.differences import BACKWARD, at, discretise
from derivations.algebra.listing import written
from derivations.algebra.operations import Operations, operations
from derivations.pid import pid_updates as term
from derivations.pid.pid_laws import K, c, derivative_on_error

I, v, u, y, ysp, P, D, Df, x, w = symbols("I v u y y_sp P D D_f x w", real=True)
yf_now, yf_old, y_old, Df_old, F_temp, D_temp, error, error_old = symbols(
    "y_f y_fold y_old D_fold F_temp D_temp e e_old", real=True
)
p1, p2, p3, p4, p5, p6, p11, p13, p14, p15, p24 = symbols("p_1 p_2 p_3 p_4 p_5 p_6 p_11 p_13 p_14 p_15 p_24")
u_low, u_high = term.u_low, term.u_high

_VARIABLES = {
    at("y"): y,
    at("y", -1): y_old,
    at("y_sp"): ysp,
    at("y_f"): yf_now,
    at("y_f", -1): yf_old,
    at("D_f", -1): Df_old,
    at("I"): I,
    at("u"): u,
    at("v"): v,
    at("e"): error,
    at("e", -1): error_old,
}
INPUTS = (y, ysp)
OUTPUT = u


@dataclass(frozen=True)
class Assignment:
    """``target = value``, with the number of the equation it comes from."""

    target: Symbol
    value: Expr
    equation: str = ""


@dataclass(frozen=True)
class Program:
    """One code figure: gains, assignments before the output is set, assignments after."""

    figure: str
    gains: tuple[Assignment, ...]
    before: tuple[Assignment, ...]
    after: tuple[Assignment, ...]

    def gain_values(self) -> dict[Symbol, Expr]:
        return {a.target: a.value for a in self.gains}

    def assigned(self, target: Symbol) -> Expr:
        """What is assigned to a variable in the pass. Raises StopIteration where it is never assigned."""
        return next(a.value for a in self.before + self.after if a.target == target)

    def states(self) -> tuple[Symbol, ...]:
        """What one pass needs from the one before: variables read before they are assigned."""
        known = {*INPUTS, *self.gain_values()}
        needed: list[Symbol] = []
        targets = {a.target for a in self.before + self.after}
        for a in self.before + self.after:
            reads = sorted(a.value.free_symbols - known, key=str)
            needed += [s for s in reads if s in targets and s not in needed]
            known.add(a.target)
        return tuple(needed)

    def unused(self) -> tuple[Symbol, ...]:
        """Targets of assignments that nothing reads, in this pass or the next: lines that can be deleted."""
        read = set().union(*(a.value.free_symbols for a in self.before + self.after)) | {OUTPUT}
        return tuple(a.target for a in self.before + self.after if a.target not in read)

    def operations(self) -> Operations:
        """Operations between reading y and setting u, as the captions count them; limiting v costs none."""
        return sum((operations(a.value) for a in self.before if a.target != OUTPUT), Operations())

    def run(self, values: Mapping[Symbol, Expr]) -> dict[Symbol, Expr]:
        """One pass with any values (symbols, rationals) for states, inputs and gains; returns all variables.

        A value given for u stands for the limited output, whatever the limits are.
        """
        known = dict(values)
        for a in self.before + self.after:
            if a.target != OUTPUT or OUTPUT not in values:
                known[a.target] = a.value.xreplace(known)
        return known

    def listing(self) -> str:
        """The program as text: gains, then the pass, with the output set between the two halves."""
        lines = [_line(a) for a in self.gains] + ["repeat:", "    read y"]
        lines += ["    " + _line(a) for a in self.before] + ["    set u"]
        lines += ["    " + _line(a) for a in self.after] + ["    wait for the next sample"]
        return "\n".join(lines)

    def symbols(self) -> set[Symbol]:
        """Every name the program uses."""
        assigned = self.gains + self.before + self.after
        return {a.target for a in assigned}.union(*(a.value.free_symbols for a in assigned))


def statement(a: Assignment) -> str:
    """One assignment as program text."""
    if a.target == OUTPUT:
        text = "saturate(v, ulow, uhigh)"
    elif isinstance(a.value, Piecewise):
        text = f"{written(a.value.args[0].expr)} if u = v"
    else:
        text = written(a.value)
    return f"{written(a.target)} = {text}"


def _line(a: Assignment) -> str:
    return statement(a) + (f"    ({a.equation})" if a.equation else "")


def in_variables(expr: Expr, gains: Mapping[Symbol, Symbol] | None = None) -> Expr:
    """An expression in samples y(t_k) ... as one in program variables, with its gains renamed."""
    return expr.xreplace(_VARIABLES).xreplace(dict(gains or {}))


def _gains(part: term.UpdateLaw, names: Mapping[Symbol, Symbol], labels: Iterable[str]) -> list[Assignment]:
    return [Assignment(names[s], value, label) for (s, value), label in zip(part.gains.items(), labels, strict=True)]


def split(expr: Expr, newest: Symbol) -> tuple[Expr, Expr]:
    """A sum in two: what needs ``newest``, and what is known before it is read."""
    known, needs = (expr if expr.is_Add else expand(expr)).as_independent(newest, as_Add=True)
    return needs, known


@cache
def _common() -> dict[str, Assignment]:
    proportional = Assignment(P, in_variables(term.proportional().equation.rhs), "4.1")
    limited = Assignment(u, term.saturated(v), "4.2")
    return {"P": proportional, "u": limited}


def _integral(slow: Symbol, tracking: Symbol) -> tuple[list[Assignment], Assignment]:
    part, names = term.integral_tracking(), {term.p3: slow, term.p4: tracking}
    value = in_variables(part.equation.rhs, names)
    return _gains(part, names, ("4.3", "4.4")), Assignment(I, value, "4.5")


def _nominal(derivative_part: Symbol) -> Assignment:
    return Assignment(v, P + I + derivative_part)


@cache
def conditional() -> Program:
    """Figure 4.7: derivative on e without filter; the integral moves only where the output is not limited."""
    slope = in_variables(discretise(derivative_on_error(), BACKWARD).rhs)
    before = (
        Assignment(error, in_variables(term.sampled_error())),
        Assignment(P, K * error),
        Assignment(D, slope),
        _nominal(D),
        _common()["u"],
    )
    step = Piecewise((in_variables(term.integral().rhs), Eq(u, v)), (I, True))
    return Program("4.7", (), before, (Assignment(I, step), Assignment(error_old, error)))


def _separate() -> tuple[list[Assignment], Expr, Expr, Assignment]:
    low_pass, slope = term.low_pass(), term.derivative()
    names = {term.p1: p11, term.p5: p15}
    integral_gains, integral = _integral(p13, p14)
    gains = [*_gains(low_pass, names, ("4.8",)), *integral_gains, *_gains(slope, names, ("4.6",))]
    return gains, in_variables(low_pass.equation.rhs, names), in_variables(slope.equation.rhs, names), integral


@cache
def separate() -> Program:
    """Figure 4.9: the measurement is filtered, then differentiated."""
    gains, filtered, slope, integral = _separate()
    before = (
        _common()["P"],
        Assignment(yf_now, filtered, "4.9"),
        Assignment(D, slope, "4.7"),
        _nominal(D),
        _common()["u"],
    )
    return Program("4.9", tuple(gains), before, (integral, Assignment(yf_old, yf_now)))


@cache
def separate_split() -> Program:
    """Figure 4.10: what the filter and the derivative know before y is read moves behind the output."""
    gains, filtered, slope, integral = _separate()
    needs_y, filter_known = split(filtered, y)
    needs_yf, slope_known = split(slope, yf_now)
    before = (
        _common()["P"],
        Assignment(yf_now, F_temp + needs_y),
        Assignment(D, needs_yf - D_temp),
        _nominal(D),
        _common()["u"],
    )
    advance = {yf_old: yf_now}
    after = (
        integral,
        Assignment(yf_old, yf_now),
        Assignment(F_temp, filter_known.xreplace(advance)),
        Assignment(D_temp, -slope_known.xreplace(advance)),
    )
    return Program("4.10", tuple(gains), before, after)


def _merged() -> tuple[list[Assignment], Expr, Assignment]:
    part = term.filtered_derivative()
    names = {term.p3: p3, term.p24: p24}
    integral_gains, integral = _integral(p5, p6)
    return [*_gains(part, names, ("4.11", "4.12")), *integral_gains], in_variables(part.equation.rhs, names), integral


@cache
def merged() -> Program:
    """Figure 4.11: filter and derivative in one equation."""
    gains, filtered, integral = _merged()
    before = (_common()["P"], Assignment(Df, filtered, "4.13"), _nominal(Df), _common()["u"])
    after = (integral, Assignment(Df_old, Df), Assignment(y_old, y))
    return Program("4.11", tuple(gains), before, after)


@cache
def merged_state() -> Program:
    """Figure 4.12: the part known before y is read becomes the state x."""
    gains, filtered, integral = _merged()
    needs_y, known = split(filtered, y)
    before = (_common()["P"], Assignment(Df, x + needs_y, "4.14"), _nominal(Df), _common()["u"])
    state = Assignment(x, known.xreplace({Df_old: Df, y_old: y}), "4.15")
    after = (Assignment(Df_old, Df), Assignment(y_old, y), state, integral)
    return Program("4.12", tuple(gains), before, after)


@cache
def state_gain() -> tuple[Expr, Expr]:
    """The update of x by itself and y (eq. 4.16) and the gain p4 in it (eq. 4.17)."""
    program = merged_state()
    combined = expand(program.assigned(x).xreplace({Df: program.assigned(Df)}))
    gain = factor(combined.coeff(y).subs(program.gain_values()))
    return Add(combined.coeff(x) * x, p4 * y), gain


def _shortest(slope_input: Expr) -> tuple[list[Assignment], Expr, Expr, Assignment]:
    """Output and state update of figure 4.13 for a derivative that acts on ``slope_input`` instead of y."""
    program = merged_state()
    slope = program.assigned(Df).subs(y, slope_input)
    nominal = expand((P + I + Df).subs({P: _common()["P"].value, Df: slope}))
    update, gain = state_gain()
    values = program.gain_values()
    gain_sp, gain_y = collect(nominal.coeff(ysp), K), -nominal.coeff(y)
    integral_gains, integral = _integral(p5, p6)
    gains = [
        Assignment(p1, gain_sp.subs(p24, values[p24]), "4.18"),
        Assignment(p2, gain_y.subs(p24, values[p24]), "4.19"),
        Assignment(p3, values[p3], "4.11"),
        Assignment(p4, gain, "4.17"),
        *integral_gains,
    ]
    rest = nominal - nominal.coeff(ysp) * ysp - nominal.coeff(y) * y
    return gains, p1 * ysp - p2 * y + expand(rest), update.subs(y, slope_input), integral


@cache
def minimal() -> Program:
    """Figure 4.13: P and D share one multiplication by y."""
    gains, nominal, update, integral = _shortest(y)
    before = (Assignment(v, nominal, "4.20"), _common()["u"])
    return Program("4.13", tuple(gains), before, (Assignment(x, update, "4.16"), integral))


@cache
def weighted() -> Program:
    """Figure 4.13 with a second set-point weight c: the derivative acts on y - c y_sp. With c = 0 it is figure 4.13."""
    gains, nominal, update, integral = _shortest(y - c * ysp)
    before = (Assignment(v, nominal), _common()["u"])
    return Program("weighted", tuple(gains), before, (Assignment(x, update), integral))


@cache
def shortest() -> Program:
    """Shorter than figure 4.13: everything but ``p2*y`` is known before y is read, if the set-point is."""
    program = minimal()
    needs_y, known = split(program.assigned(v), y)
    before = (Assignment(v, w + needs_y), _common()["u"])
    return Program("shortest", program.gains, before, (*program.after, Assignment(w, known)))


def programs() -> dict[str, Program]:
    """The five programs that the document presents as one controller, by figure."""
    return {p.figure: p for p in (separate(), separate_split(), merged(), merged_state(), minimal())}


def derivative_gain() -> Expr:
    """p24 = K T_d / (T_f + h): what one unit of y takes from the output through the derivative at once."""
    return merged().gain_values()[p24]
