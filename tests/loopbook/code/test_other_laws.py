"""RST, on-off, gain-scheduled PID and Smith predictor: equal in every language, and equal to plain exact programs."""

from collections import deque
from fractions import Fraction
from itertools import zip_longest
from random import Random

import numpy as np
import pytest
from any_law import in_c, in_python, in_script, in_text, samples
from machines import NoTool
from plain_pid import PlainPid
from prove import differing

from derivations.programs import smith_predictor
from loopbook.code import controller, emit, on_off_block, rst_block, scheduled_block, smith_block
from loopbook.controllers import OnOff
from loopbook.controllers.rst import Rst
from loopbook.controllers.settings import PidSettings

pytestmark = pytest.mark.builds

PID = PidSettings(K=1.3, Ti=7.0, Td=0.9, Tf=0.2, b=0.6, c=0.3, h=0.5, u_low=-20.0, u_high=25.0, rate=30.0)
ZONES = [{"K": 1.3, "Ti": 7.0, "Td": 0.9}, {"K": 2.1, "Ti": 4.0, "Td": 0.0}, {"K": 0.7, "Ti": None, "Td": 0.4}]
BLOCKS = {
    "RST": rst_block(Rst((1, -1.3, 0.3), (3, -1.65, 0.11), (1.4, 0.06), 0.7, (1, -0.45)), -60.0, 80.0),
    "RST, shortest": rst_block(Rst((1.0,), (0.7,), (0.9,), 0.7), -20.0, 25.0, name="gain"),
    "on-off": on_off_block(-2.0, 3.0, 0.75),
    "scheduled": scheduled_block(ZONES, [-5.0, 8.0], 1.5, PID),
    "Smith": smith_block(PID, 1.7, 4.0, 2.3),
    "Smith, compensated": smith_block(PID, -1.7, 4.0, 0.2, compensated=True, name="smith_short"),
}
LANGUAGES = {
    "C double": lambda block, chunk, folder: in_c(block, chunk, "double", folder, "-O2"),
    "JavaScript": lambda block, chunk, folder: in_script(block, chunk),
    "LREAL": lambda block, chunk, folder: in_text(block, chunk, "double"),
    "C float": lambda block, chunk, folder: in_c(block, chunk, "float", folder, "-O3"),
    "REAL": lambda block, chunk, folder: in_text(block, chunk, "float"),
}


@pytest.mark.parametrize("law", BLOCKS)
@pytest.mark.parametrize("language", LANGUAGES)
def test_a_language_gives_the_bits_of_the_emitted_python(law, language, tmp_path):
    block, chunk = BLOCKS[law], samples(2000, 7)
    number = np.float32 if language in ("C float", "REAL") else float
    try:
        seen = LANGUAGES[language](block, chunk, tmp_path)
    except NoTool as tool:
        pytest.skip(f"no {tool} on this machine: {language} is not run")
    with np.errstate(all="ignore"):
        wanted = in_python(block, chunk, number)
    assert not differing(seen, wanted).any()
    assert len({tuple(row) for row in wanted.tolist()}) > (3 if law == "on-off" else 150)


@pytest.mark.parametrize("law", BLOCKS)
def test_both_parsers_take_the_function_block(law):
    blark = pytest.importorskip("blark", reason="blark is not installed: Structured Text is not parsed by it")
    tree_sitter = pytest.importorskip("tree_sitter")
    grammar = pytest.importorskip("tree_sitter_iec61131_3_st")
    text = emit(BLOCKS[law], "st")[f"{BLOCKS[law].name}.st"]
    assert blark.parse_source_code(text).transform().items
    parser = tree_sitter.Parser(tree_sitter.Language(grammar.language()))
    assert not parser.parse(text.encode()).root_node.has_error


def some(draw: Random, low: int = -8, high: int = 8) -> Fraction:
    return Fraction(draw.randint(low, high), 4)


@pytest.mark.parametrize("seed", range(12))
def test_rst_is_its_difference_equation(seed):
    draw = Random(seed)
    R, S, T = ([some(draw) for _ in range(draw.randint(1, 3))] for _ in range(3))
    R, A_o = [Fraction(1), *R], [Fraction(1), Fraction(-1, 4)]
    block = rst_block(
        Rst(tuple(map(float, R)), tuple(map(float, S)), tuple(map(float, T)), 1.0, (1.0, -0.25)), -9.0, 9.0
    )
    loop = controller(block, Fraction)
    past = {n: deque([Fraction(0)] * 4, maxlen=4) for n in "ruyv"}
    loop.start(Fraction(5), Fraction(3))
    y_rest, u_rest = Fraction(5), Fraction(3)
    for _ in range(120):
        y, sp = some(draw, -40, 40), some(draw, -40, 40)
        past["y"].appendleft(y - y_rest)
        past["r"].appendleft(sp - y_rest)

        def applied(polynomial, signal, skip=0):
            return sum((c * past[signal][i - skip] for i, c in enumerate(polynomial) if i >= skip), Fraction(0))

        memory = [a - r for a, r in zip_longest(A_o, R, fillvalue=Fraction(0))]
        v = applied(T, "r") - applied(S, "y") + applied(memory, "u", 1) - applied(A_o, "v", 1)
        u = min(max(v + u_rest, Fraction(-9)), Fraction(9))
        past["v"].appendleft(v)
        past["u"].appendleft(u - u_rest)
        assert loop.step(sp, y) == u


def test_on_off_is_the_controller_of_the_library():
    draw = Random(3)
    ours, theirs = controller(on_off_block(-2.0, 3.0, 0.75)), OnOff(-2.0, 3.0, hysteresis=0.75)
    for _ in range(500):
        y, sp = draw.gauss(0, 2), draw.choice([0.0, 1.0])
        assert ours.step(sp, y) == theirs.step(y, sp)
    assert theirs.switches > 50


def exact_pid(K: float, Ti: float | None, Td: float) -> dict[str, Fraction]:
    """The settings that a zone adds to what all share."""
    names = ("Tf", "b", "c", "Tt", "h", "u_low", "u_high", "rate")
    shared = {n: Fraction(getattr(PID, n)) for n in names}
    return {"K": Fraction(K), "Ti": Fraction(Ti or 0), "Td": Fraction(Td), **shared}


def test_the_scheduled_controller_is_the_plain_one_with_changes():
    draw = Random(5)
    loop, plain = controller(BLOCKS["scheduled"], Fraction), PlainPid(**exact_pid(**ZONES[0]))
    zone, value, visited = 0, Fraction(-10), set()
    for k in range(150):
        value += some(draw, -16, 16) + (1 if k < 60 else -1)
        y, sp = some(draw), Fraction(k // 25)
        while zone < 2 and value > [-5, 8][zone] + Fraction(3, 2):
            zone += 1
        while zone > 0 and value < [-5, 8][zone - 1] - Fraction(3, 2):
            zone -= 1
        if zone != getattr(loop, "zone", 0):
            plain.change(**exact_pid(**ZONES[zone]))
        visited.add(zone)
        assert loop.step(sp, y, Fraction(0), value) == plain.step(sp, y, Fraction(0))
        assert loop.zone == zone
    assert visited == {0, 1, 2}


def test_the_smith_predictor_is_the_plain_controller_on_the_undelayed_model():
    draw = Random(6)
    block = BLOCKS["Smith"]
    loop = controller(block, Fraction)
    plain = PlainPid(**exact_pid(PID.K, PID.Ti, PID.Td))
    gain, pole, part = loop.model_gain, loop.model_pole, loop.model_part
    loop.start(Fraction(2), Fraction(2), Fraction(7), Fraction(0))
    plain.start(Fraction(2), Fraction(2), Fraction(7), Fraction(0))
    x, xs, us, d = Fraction(0), [], [], 5
    assert len(loop.line) == d
    for _ in range(60):
        y, sp = 2 + some(draw), Fraction(draw.randint(0, 6))
        late = part * xs[-d] + gain * (1 - part) * us[-d] if len(xs) >= d else Fraction(0)
        u = plain.step(sp, y + x - late, Fraction(0))
        assert loop.step(sp, y, Fraction(0)) == u
        xs.append(x)
        us.append(u - 7)
        x = pole * x + gain * (1 - pole) * (u - 7)


def test_the_smith_predictor_sees_no_dead_time_when_its_model_is_the_process():
    """A process that is the model, dead time and all, in steps of 1/100 of a sample: y_seen is the undelayed lag."""
    gain, T, L, h = 1.7, 4.0, 2.3, 0.5
    block = smith_block(PidSettings(K=1.0, Ti=4.0, h=h, u_low=-50.0, u_high=50.0), gain, T, L)
    loop = controller(block)
    loop.start(0.0, 0.0, 0.0, 0.0)
    fine, past = round(h / 0.005), []
    late = lag = 0.0
    pole = np.exp(-0.005 / T)
    for _ in range(120):
        u = loop.step(1.0, late, 0.0)
        assert loop.y_last == pytest.approx(lag, abs=1e-9)
        for _ in range(fine):
            past.append(u)
            before = past[-1 - round(L / 0.005)] if len(past) > round(L / 0.005) else 0.0
            late = pole * late + gain * (1 - pole) * before
            lag = pole * lag + gain * (1 - pole) * u
    assert late == pytest.approx(1.0, abs=1e-3)


def test_the_models_update_solves_its_differential_equation():
    a, b = (str(smith_predictor.held_lag().subs({smith_predictor.model_pole: p})) for p in (0, 1))
    assert (a, b) == ("model_gain*u_moved", "x_model")
