"""The C program: single precision digit by digit, exact arithmetic against the law, and the compiled text."""

import os
import shutil
import subprocess
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
import sympy as sp

from derivations.programs import positional_pid as law
from loopbook.controllers.pid_forms import PidStandard
from loopbook.documents.open import printed as load
from loopbook.documents.pid_article import c_program
from loopbook.documents.pid_article.c_program import CProgram
from loopbook.loop.without_dead_time import reference_to_output
from loopbook.process.construct import tf
from loopbook.response.simulation import simulate

COMPILER = next((c for c in (os.environ.get("CC", ""), "cc", "gcc", "clang") if c and shutil.which(c)), None)


@pytest.fixture(scope="module")
def program() -> CProgram:
    values = load("pid-article").values
    names = {"u_min": "min_u", "u_max": "max_u", "t_end": "t_sim", "level": "u"}
    fields = ("k", "T1", "T2", "Kp", "Ti", "Td", "u_min", "u_max", "h", "t_end", "level")
    return CProgram(**{f: values[f"c-{names.get(f, f)}"].fraction for f in fields})


@pytest.mark.parametrize("real", ["float", "double"])
@pytest.mark.skipif(COMPILER is None, reason="no C compiler on this machine (looked for $CC, cc, gcc, clang)")
@pytest.mark.builds
def test_compiled_program_writes_what_python_computes_line_by_line(program, tmp_path, real):
    source = tmp_path / "loop.c"
    source.write_text(c_program.c_source(program, real))
    options = ["-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", "-ffp-contract=off"]
    subprocess.run([COMPILER, *options, "-o", tmp_path / "loop", source], check=True)
    subprocess.run([tmp_path / "loop", tmp_path / "open.txt", tmp_path / "closed.txt"], check=True)
    number = {"float": np.float32, "double": float}[real]
    for name, rows in (
        ("open", c_program.open_loop(program, number)),
        ("closed", c_program.closed_loop(program, number)),
    ):
        written = (tmp_path / f"{name}.txt").read_text().splitlines()
        assert len(written) > 1900
        assert written == c_program.text(rows).splitlines()


def test_time_accumulates_so_there_are_2000_rows_in_either_precision(program):
    single, double = c_program.open_loop(program), c_program.open_loop(program, float)
    assert (len(single), len(double)) == (2000, 2000)
    assert f"{float(single[-1][0]):.4f}" == "19.9904"
    assert f"{double[-1][0]:.4f}" == "19.9900"
    assert all(isinstance(v, np.float32) for v in single[-1])


def test_exact_arithmetic_follows_the_derived_law(program):
    rows = c_program.closed_loop(CProgram(**{**vars(program), "t_end": Fraction(8, 100), "u_max": 1000}), Fraction)
    numbers = {law.h: program.h, law.Kp: program.Kp, law.Ti: program.Ti, law.Td: program.Td}
    errors = [1 - row[1] for row in rows]
    for i in range(1, len(rows) - 1):
        values = numbers | {law.e: errors[i], law.last: errors[i - 1], law.total: sum(errors[: i + 1])}
        expected = law.law().subs({n: sp.Rational(v.numerator, v.denominator) for n, v in values.items()})
        assert Fraction(int(expected.p), int(expected.q)) == rows[i + 1][3]


def test_output_stays_within_its_limits_and_starts_without_a_derivative(program):
    u = np.array([row[3] for row in c_program.closed_loop(program, float)])
    assert u.max() == 2.0 and u.min() > -2.0
    assert u[0] == 0.0
    wide = CProgram(**{**vars(program), "u_max": 1000, "u_min": -1000})
    assert c_program.closed_loop(wide, float)[1][3] == pytest.approx(2.9635 * (1 + 0.01 / 4.8004), rel=1e-12)
    kicked = c_program.closed_loop(wide, float, first_difference=True)[1][3]
    assert kicked == pytest.approx(2.9635 * (1 + 0.01 / 4.8004 + 0.7152 / 0.01), rel=1e-12)


def test_without_anti_windup_the_sum_grows_while_the_limit_acts(program):
    low = CProgram(**{**vars(program), "u_max": Fraction(2, 5)})
    frozen = c_program.closed_loop(low, float)
    wound = c_program.closed_loop(low, float, anti_windup=False)
    assert max(row[1] for row in wound) > max(row[1] for row in frozen)


def test_bumpless_start_holds_the_control_signal(program):
    manual, output = 0.2, 0.55
    numbers = {law.Kp: 2.9635, law.Ti: 4.8004, law.h: 0.01, law.e: 1 - output, law.manual: manual}
    stored = float(law.bumpless_total().subs(numbers))
    rows = c_program.closed_loop(program, float, total=stored, x1=output, u=manual)
    assert rows[1][3] == pytest.approx(manual, abs=1e-12)
    assert abs(c_program.closed_loop(program, float, x1=output, u=manual)[1][3] - manual) > 1


@pytest.mark.parametrize(
    "change, words",
    [({"h": 0}, "h = 0 must be a positive time"), ({"u_min": 3}, "u_min = 3 must lie below u_max = 2")],
)
def test_impossible_numbers_are_refused(program, change, words):
    with pytest.raises(ValueError, match=words):
        CProgram(**{**vars(program), **change})


def test_type_name_is_checked(program):
    with pytest.raises(ValueError, match="float or double"):
        c_program.c_source(program, "half")


def test_the_regulator_on_the_exact_plant_tends_to_the_continuous_loop(program):
    """Without limits and with a short step, derivative on the measurement in effect: the first sample has none."""
    wide = replace(program, u_min=-1000, u_max=1000)
    plant, pid = tf(3, [[2, 1], [3, 1]]), PidStandard(*(float(x) for x in (wide.Kp, wide.Ti, wide.Td)), c=0.0)
    run = simulate(plant, c_program.ProgramRegulator(wide), 0.01, 1000, reference=1.0)
    exact = reference_to_output(plant, pid).step(run.t)
    assert abs(run.y - exact).max() < 0.01
