"""The programs of figures 4.7 and 4.9 to 4.13: operations, dead lines, states, one controller."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from sympy import Rational, Symbol, simplify, symbols

from derivations.algebra.differences import h
from derivations.algebra.operations import operations
from derivations.pid.pid_laws import K, Td, Ti, Tt, b, c
from derivations.pid.rc_filter import Tf
from derivations.programs import pid_code as code
from derivations.programs.equivalence import filter_order_residual, residuals, states_from, steady_derivative
from loopbook.documents import open as documents

FIGURES = list(code.programs())
REPORT = documents.printed("pid-report")


@pytest.mark.parametrize("figure", FIGURES)
def test_operations_of_the_captions(figure):
    counted = code.programs()[figure].operations()
    for name in ("multiplications", "subtractions", "additions"):
        assert getattr(counted, name) == int(REPORT.values[f"f{figure}-{name}"].printed), f"figure {figure}: {name}"
    assert counted.divisions == 0


def test_counting():
    p, q, r, s = symbols("p q r s")
    assert operations(-p - q).counts == (0, 1, 0, 0)
    assert operations(p * (q - r) / s).counts == (1, 1, 0, 1)
    assert operations(-p * q).counts == (1, 0, 0, 0)
    assert operations(Symbol("p")).total == 0


def test_shorter_than_figure_4_13():
    """One multiplication and one subtraction are enough: figure 4.13 is not minimal."""
    assert code.shortest().operations().counts == (1, 1, 0, 0)


@pytest.mark.parametrize(
    ("figure", "states", "unused"),
    [
        ("4.9", {"I", "y_fold"}, set()),
        ("4.10", {"I", "F_temp", "D_temp"}, {"y_fold"}),
        ("4.11", {"I", "D_fold", "y_old"}, set()),
        ("4.12", {"I", "x"}, {"D_fold", "y_old"}),
        ("4.13", {"I", "x"}, set()),
    ],
)
def test_states_and_dead_lines(figure, states, unused):
    program = code.programs()[figure]
    assert {s.name for s in program.states()} == states
    assert {s.name for s in program.unused()} == unused


LISTINGS = {
    "4.7": ["e = ysp - y", "P = K*e", "D = K*Td*(e - eold)/h", "I = I + K*e*h/Ti if u = v", "eold = e"],
    "4.9": ["p14 = h/Tt    (4.4)", "yf = p11*yfold + y*(1 - p11)    (4.9)", "D = p15*(yf - yfold)    (4.7)"],
    "4.10": ["yf = Ftemp + y*(1 - p11)", "D = p15*yf - Dtemp", "Ftemp = p11*yf", "Dtemp = p15*yf"],
    "4.11": ["p24 = K*Td/(Tf + h)    (4.12)", "Df = Dfold*p3 + p24*yold - p24*y    (4.13)"],
    "4.12": ["Df = x - p24*y    (4.14)", "x = Df*p3 + p24*y    (4.15)"],
    "4.13": [
        "p2 = K + K*Td/(Tf + h)    (4.19)",
        "p4 = K*Td*h/(Tf + h)**2    (4.17)",
        "v = I + p1*ysp + x - p2*y    (4.20)",
        "x = p3*x + p4*y    (4.16)",
        "I = I + p5*(ysp - y) + p6*(u - v)    (4.5)",
    ],
}


@pytest.mark.parametrize("figure", LISTINGS)
def test_listing(figure):
    program = {"4.7": code.conditional(), **code.programs()}[figure]
    lines = [line.strip() for line in program.listing().splitlines()]
    for line in LISTINGS[figure]:
        assert line in lines, f"figure {figure}"
    assert lines.index("read y") < lines.index("set u") < lines.index("wait for the next sample")


@pytest.mark.parametrize("figure", FIGURES)
def test_one_controller_by_induction(figure):
    """Same v and the same form of the states after a pass, for free inputs and settings."""
    assert set(residuals(figure).values()) == {0}, f"figure {figure}"


def test_filtering_before_or_after_the_derivative():
    assert filter_order_residual() == 0, "eqs 4.9 and 4.13"


def test_wrong_p4_leaves_a_derivative_at_rest():
    right, printed_gain = code.minimal().gain_values()[code.p4], K * Td * h / (h + Tf) * (Tf + h)
    assert steady_derivative(right) == 0, "eq. 4.17"
    left = steady_derivative(printed_gain).subs({K: 2, Td: 3, Tf: 1, h: 1, code.y: 5})
    assert left == 2 * 3 * 5 * (Rational(2) - Rational(1, 2))


def _play(program, gains, states, signals, low, high):
    """Every sample in exact rationals; the limits bind where they bind."""
    values = {p: value.subs(gains) for p, value in program.gain_values().items()}
    state, outputs = dict(states), []
    limits = {code.u_low: low, code.u_high: high}
    for ysp, y in signals:
        known = program.run({**gains, **values, **limits, **state, code.y: y, code.ysp: ysp})
        state = {s: known[s] for s in program.states()}
        outputs.append((known[code.v], known[code.u], known[code.I]))
    return outputs


small = st.integers(-12, 12).map(lambda n: Rational(n, 4))
positive = st.integers(1, 12).map(lambda n: Rational(n, 3))


@settings(max_examples=15, deadline=None)
@given(
    setting=st.tuples(small.filter(bool), positive, positive, positive, positive, positive, st.sampled_from([0, 1])),
    start=st.tuples(small, small, small),
    signals=st.lists(st.tuples(small, small), min_size=1, max_size=6),
)
@pytest.mark.long
def test_one_controller_sample_by_sample(setting, start, signals):
    """Five programs and the shortest one, exact rationals, from any common start, with limits that bind."""
    gains = dict(zip((K, Ti, Td, Tf, Tt, h, b), map(Rational, setting), strict=True)) | {c: Rational(0)}
    filtered, measured, integral = start
    runs = {}
    for figure, program in {**code.programs(), "weighted": code.weighted()}.items():
        initial = states_from("4.13" if figure == "weighted" else figure, filtered, measured)
        values = {p: v.subs(gains) for p, v in program.gain_values().items()}
        initial = {s: Rational(v.subs(values).subs(gains)) for s, v in initial.items()}
        runs[figure] = _play(program, gains, initial | {code.I: integral}, signals, Rational(-1), Rational(2))
    for figure in runs:
        assert runs[figure] == runs["4.9"], f"figure {figure} departs from figure 4.9"


def test_the_weight_on_the_derivative_replaces_y_by_y_minus_c_ysp():
    """v = K (b ysp - y) + I + x - p24 (y - c ysp), and x follows p4 (y - c ysp): eqs 4.16 to 4.20 with a weight c."""
    program = code.weighted()
    p24 = K * Td / (Tf + h)
    passed = program.run(
        {**program.gain_values(), code.u: code.u, **{s: s for s in (code.y, code.ysp, code.I, code.x)}}
    )
    slope = code.y - c * code.ysp
    assert simplify(passed[code.v] - (K * (b * code.ysp - code.y) + code.I + code.x - p24 * slope)) == 0, "eq. 4.20"
    update = Tf / (Tf + h) * code.x + K * Td * h / (Tf + h) ** 2 * slope
    assert simplify(passed[code.x] - update) == 0, "eqs 4.16 and 4.17"


def test_symbols_of_a_program():
    names = {s.name for s in code.minimal().symbols()}
    assert {"K", "T_i", "T_t", "p_4", "x", "I", "y", "y_sp", "u", "v", "u_low"} <= names
    assert "D_f" not in names


def test_other_starts_are_other_controllers():
    """Figure 4.10 remembers a start with F_temp : D_temp other than p11 : p15; the others have no such freedom."""
    gains = {K: Rational(1), Ti: Rational(1), Td: Rational(1), Tf: Rational(1), Tt: Rational(1), h: Rational(1)}
    gains[b] = Rational(1)
    signals = [(Rational(0), Rational(1))] * 3
    reference = _play(
        code.separate(), gains, {code.I: Rational(0), code.yf_old: Rational(1)}, signals, Rational(-9), Rational(9)
    )
    odd = {code.I: Rational(0), code.F_temp: Rational(1), code.D_temp: Rational(0)}
    assert _play(code.separate_split(), gains, odd, signals, Rational(-9), Rational(9))[0] != reference[0]
