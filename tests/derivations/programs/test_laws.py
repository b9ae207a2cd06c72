"""The controllers as programs: closed in themselves, and at rest where they are started at rest."""

import pytest
from sympy import S, Symbol

from derivations.programs import on_off, pid_step, rst_program, scheduled_pid, start
from derivations.programs import pid_code as code
from derivations.programs.form import Do, If

PROGRAMS = {
    "on-off": on_off.program(),
    "RST": rst_program.program(2, 1, 1, 2),
    "RST, shortest": rst_program.program(0, 0, 0),
    "scheduled": scheduled_pid.program(3),
    "scheduled, compensated": scheduled_pid.program(2, compensated=True),
}


def called(body):
    for statement in body:
        if isinstance(statement, Do):
            yield statement.operation
        elif isinstance(statement, If):
            yield from called((*statement.then, *statement.otherwise))


@pytest.mark.parametrize("law", PROGRAMS)
def test_what_a_program_calls_it_has_and_has_before(law):
    """Structured Text and C99 both know an operation only after its definition."""
    known = set()
    for operation in PROGRAMS[law].operations:
        assert set(called(operation.body)) <= known, operation.name
        known.add(operation.name)
    assert {"step", "reset", "init", "change"} <= known


@pytest.mark.parametrize("law", PROGRAMS)
def test_names_are_those_of_one_thing_and_the_output_is_a_state(law):
    program = PROGRAMS[law]
    variables = (*program.settings, *program.gains, *program.states, *program.flags)
    assert len({str(v.symbol) for v in variables}) == len(variables)
    assert program.output in {v.symbol for v in program.states}


def test_a_step_of_the_pid_takes_the_set_point_the_measurement_and_the_feedforward():
    plain, compensated = pid_step.step(False), pid_step.step(True)
    assert plain.arguments == compensated.arguments and plain.result == compensated.result
    assert plain.body != compensated.body


def test_the_states_at_rest_keep_the_output_and_themselves():
    rest = start.rest()
    assert (start.law().subs(rest) - start.u0).expand() == S.Zero
    assert start.gain_residual() == S.Zero
    assert rest[code.x].subs({code.y: 0, code.ysp: 0}) == S.Zero
    assert start.integral_from(Symbol("u")).has(Symbol("u"))
