"""A simulation of a PID loop as a small program in single precision: run here digit by digit, or written out as C.

The plant k/((1 + s T1)(1 + s T2)) is stepped by Euler's method, the regulator is the positional PID law with a limited
output and conditional integration (pid-article, section "Regulator dyskretny", file pid_test.c). The arithmetic comes
from `derivations.programs.program_order`, which proves it equal to the derived difference equations and fixes the order
of operations; the Python run and the C text are both generated from it.

Single precision has 24 bits: every operation is rounded, and the time accumulates h as the machine rounds it. This is
why the number of rows is computed and not t_end/h + 1.
"""

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from typing import Any

from derivations.programs import program_order
from loopbook.numerics.real_numbers import Number

PLANT_INPUTS = ("x1", "x2", "u", "k", "T1", "T2", "h")
REGULATOR_INPUTS = ("e", "last", "total", "Kp", "Ti", "Td", "h")


@dataclass(frozen=True)
class CProgram:
    """The numbers of one simulation.

    k [y/u], T1, T2 [s]: the plant. Kp [u/y], Ti, Td [s]: the regulator. u_min, u_max: its limits. h [s]: step.
    t_end [s]: rows are written while t <= t_end. level: the step of u in the open loop, of the set-point in the closed.
    Give Fractions (a printed number exactly) or floats. Raises ValueError where h or a time constant is not positive
    or the limits are reversed.
    """

    k: Number
    T1: Number
    T2: Number
    Kp: Number
    Ti: Number
    Td: Number
    u_min: Number
    u_max: Number
    h: Number
    t_end: Number
    level: Number

    def __post_init__(self) -> None:
        for name in ("T1", "T2", "Ti", "h"):
            if not getattr(self, name) > 0:
                raise ValueError(f"{name} = {getattr(self, name)} must be a positive time in s")
        if not self.u_min < self.u_max:
            raise ValueError(f"u_min = {self.u_min} must lie below u_max = {self.u_max}")

    def cast(self, number: Callable) -> dict[str, Number]:
        """Every field in the arithmetic of the run; a decimal passes through double precision as a C literal does."""
        exact = number is Fraction
        return {n: number(v) if exact else number(float(v)) for n, v in vars(self).items()}


@cache
def _function(name: str) -> Callable:
    inputs, outputs = {"plant": (PLANT_INPUTS, "n1, n2"), "regulator": (REGULATOR_INPUTS, "up, ui, ud")}[name]
    lines = [f"    {s.target} = {s.text}" for s in getattr(program_order, name)()]
    source = "\n".join([f"def {name}({', '.join(inputs)}):", *lines, f"    return {outputs}"])
    scope: dict[str, Any] = {}
    exec(compile(source, f"<{name} from derivations.programs.program_order>", "exec"), scope)
    return scope[name]


def _single() -> Callable:
    import numpy as np

    return np.float32


def open_loop(program: CProgram, number: Callable | None = None) -> list[tuple]:
    """Rows (t, x1, x2) of the plant after a step of its input from rest; x1 is the output, x2 its rate.

    number: np.float32 (default, as the program), float, or Fraction for exact arithmetic over a few steps.
    """
    number = number or _single()
    p, plant = program.cast(number), _function("plant")
    t, x1, x2, rows = number(0), number(0), number(0), []
    while t <= p["t_end"]:
        rows.append((t, x1, x2))
        x1, x2 = plant(x1, x2, p["level"], p["k"], p["T1"], p["T2"], p["h"])
        t = t + p["h"]
    return rows


class ProgramRegulator:
    """The program's regulator with its state, one sample a step; also for `loopbook.response.simulation.simulate`.

    anti_windup: undo the sum of the errors while the output is limited. first_difference: let the D term act on the
    first sample too, from e(-1) = 0. total: the stored sum to start from. number: the arithmetic, as for `closed_loop`.
    """

    def __init__(
        self,
        program: CProgram,
        number: Callable = float,
        *,
        anti_windup: bool = True,
        first_difference: bool = False,
        total: Number = 0,
    ):
        self._numbers, self._number, self._anti_windup = program.cast(number), number, anti_windup
        self._started, self._total, self._last = first_difference, number(total), number(0)

    def step(self, y: Number, reference: Number) -> Any:
        """The control signal for the output y [y] and the set-point."""
        p, e = self._numbers, reference - y
        self._total = self._total + e
        up, ui, ud = _function("regulator")(e, self._last, self._total, p["Kp"], p["Ti"], p["Td"], p["h"])
        value = up + ui + (ud if self._started else self._number(0))
        self._started, self._last = True, e
        u = min(max(value, p["u_min"]), p["u_max"])
        if u != value and self._anti_windup:
            self._total = self._total - e
        return u


def closed_loop(
    program: CProgram,
    number: Callable | None = None,
    *,
    anti_windup: bool = True,
    first_difference: bool = False,
    total: Number = 0,
    x1: Number = 0,
    u: Number = 0,
    setpoint: Callable[[float], Number] | None = None,
) -> list[tuple]:
    """Rows (t, x1, x2, u, w) of the closed loop after a step of the set-point.

    The row at time t is written before the regulator runs: its u is the one that acted *up to* t.
    anti_windup, first_difference: as for `ProgramRegulator`. total, x1, u: the stored sum, the output and the control
    signal to start from (default rest); `derivations.programs.positional_pid.bumpless_total` gives the sum for a start
    without a bump. setpoint: w as a function of t [s], in place of the step.
    """
    number = number or _single()
    p, plant = program.cast(number), _function("plant")
    regulator = ProgramRegulator(
        program, number, anti_windup=anti_windup, first_difference=first_difference, total=total
    )
    t, x1, x2, u, rows = number(0), number(x1), number(0), number(u), []
    while t <= p["t_end"]:
        w = number(setpoint(float(t))) if setpoint else p["level"]
        rows.append((t, x1, x2, u, w))
        u = regulator.step(x1, w)
        x1, x2 = plant(x1, x2, u, p["k"], p["T1"], p["T2"], p["h"])
        t = t + p["h"]
    return rows


def text(rows: list[tuple], decimals: int = 4) -> str:
    """The rows as the program writes them: fixed decimals, semicolons, one line per row.

    >>> text([(0.0, 1 / 3)])
    '0.0000;0.3333\\n'
    """
    return "".join(";".join(f"{float(v):.{decimals}f}" for v in row) + "\n" for row in rows)


def _statements(name: str) -> str:
    return "\n".join(f"    const real {s.target} = {s.text};" for s in getattr(program_order, name)())


def c_source(program: CProgram, real: str = "float") -> str:
    """The same simulation as a C99 program: ``./a.out OPEN CLOSED`` writes both files.

    real: "float" or "double". The statements of plant and regulator are those that the Python run executes. Compile
    without contraction of a*b + c into one operation (``-ffp-contract=off``): it rounds once where this rounds twice.
    Raises ValueError for another type name.
    """
    if real not in ("float", "double"):
        raise ValueError(f"real = {real!r}: float or double")
    numbers = "\n".join(f"static const real {n} = {float(v)!r};" for n, v in vars(program).items())
    return _TEMPLATE.format(real=real, numbers=numbers, plant=_statements("plant"), regulator=_statements("regulator"))


_TEMPLATE = """\
/* A PID loop in one precision; generated, the arithmetic from derivations.programs.program_order. */
#include <stdbool.h>
#include <stdio.h>

typedef {real} real;

{numbers}

typedef struct {{ real x1, x2; }} Plant;
typedef struct {{ real total, last; bool started; }} Regulator;

/* one Euler step under the constant input u */
static void plant_step(Plant *s, real u) {{
    const real x1 = s->x1, x2 = s->x2;
{plant}
    s->x1 = n1;
    s->x2 = n2;
}}

/* the control signal for the error e: limited, the sum kept as it was while the limit acts */
static real regulator_step(Regulator *s, real e) {{
    const real last = s->last;
    const real total = s->total + e;
{regulator}
    const real wanted = up + ui + (s->started ? ud : 0);
    const real u = wanted > u_max ? u_max : wanted < u_min ? u_min : wanted;
    s->total = u == wanted ? total : total - e;
    s->last = e;
    s->started = true;
    return u;
}}

static void run_open(FILE *file) {{
    Plant plant = {{0, 0}};
    for (real t = 0; t <= t_end; t += h) {{
        fprintf(file, "%.4f;%.4f;%.4f\\n", t, plant.x1, plant.x2);
        plant_step(&plant, level);
    }}
}}

static void run_closed(FILE *file) {{
    Plant plant = {{0, 0}};
    Regulator regulator = {{0, 0, false}};
    real u = 0;
    for (real t = 0; t <= t_end; t += h) {{
        fprintf(file, "%.4f;%.4f;%.4f;%.4f;%.4f\\n", t, plant.x1, plant.x2, u, level);
        u = regulator_step(&regulator, level - plant.x1);
        plant_step(&plant, u);
    }}
}}

int main(int count, char **names) {{
    if (count != 3) {{
        fprintf(stderr, "usage: %s OPEN CLOSED (the two files to write)\\n", names[0]);
        return 2;
    }}
    for (int i = 1; i < 3; i++) {{
        FILE *file = fopen(names[i], "w");
        if (!file) {{
            perror(names[i]);
            return 1;
        }}
        (i == 1 ? run_open : run_closed)(file);
        if (fclose(file)) {{
            perror(names[i]);
            return 1;
        }}
    }}
    return 0;
}}
"""
