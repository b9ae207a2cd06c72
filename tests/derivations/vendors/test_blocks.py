"""Every vendor's entries give the setting's transfer function, in exact numbers; the manuals' own examples hold."""

from fractions import Fraction

import pytest
from sympy import Integer, Rational, simplify

from derivations.vendors import abb, codesys, emerson, honeywell, rockwell, siemens, textbook
from derivations.vendors.block import K, Su, Sy, Td, Tf, Ti, b, c, s
from derivations.vendors.catalogue import LEFT_OUT, by_name

BLOCKS = by_name()
VENDORS = (textbook, abb, codesys, emerson, honeywell, rockwell, siemens)
EXACT = {K: Rational(7, 3), Ti: Rational(500), Td: Rational(72), Tf: Rational(9, 2), Sy: Integer(150), Su: Integer(80)}
EXACT |= {b: Integer(1)}


@pytest.mark.parametrize("name", BLOCKS)
def test_the_entries_are_the_setting(name):
    assert BLOCKS[name].left() == (0, 0)


@pytest.mark.parametrize("name", BLOCKS)
def test_the_same_in_rational_numbers_at_a_frequency(name):
    """Another route: the numbers that are typed in, put into the block's equation, against the standard form."""
    block = BLOCKS[name]
    typed = {e.symbol: e.value.subs(EXACT) for e in block.entries}
    at = Rational(3, 100)
    weight = Integer(1) if block.on_error else Integer(0)
    filter = block.filter.subs(EXACT)
    D = 0 if block.derivative else EXACT[Td] * at / (1 + filter * at)
    scale = block.signals.subs(EXACT)
    for path, front, lead in ((block.feedback, 1, 1), (block.reference, 1, weight)):
        ours = scale * path.subs({**typed, b: 1, c: weight, s: at})
        assert simplify(ours - EXACT[K] * (front + 1 / (EXACT[Ti] * at) + lead * D)) == 0


@pytest.mark.parametrize("name", ["ideal", "emerson-series", "rockwell-pide-independent", "abb-knx"])
def test_a_wrong_entry_is_noticed(name):
    """The proof can fail: a gain of another size leaves a difference."""
    block = BLOCKS[name]
    first, *others = block.entries
    wrong = type(block)(
        **{**vars(block), "entries": (type(first)(**{**vars(first), "value": 2 * first.value}), *others)}
    )
    assert wrong.left()[0] != 0


@pytest.mark.parametrize("name", BLOCKS)
def test_a_block_says_where_it_was_read_and_what_selects_its_weights(name):
    block = BLOCKS[name]
    assert block.manual.title and block.manual.edition and block.manual.pages and block.manual.read
    assert set(block.weights) <= {0, 1}
    assert block.upwards and block.downwards


def test_every_vendor_that_was_asked_for_is_here_or_named_as_left_out():
    for vendor in ("siemens", "codesys", "rockwell", "abb", "emerson", "honeywell"):
        assert any(name.startswith(vendor) for name in BLOCKS)
    assert any("DeltaV" in name for name in LEFT_OUT)


def test_the_catalogue_is_what_the_files_hold():
    assert list(BLOCKS) == [block.name for vendor in VENDORS for block in vendor.blocks()]


def value(block: str, entry: str, **setting: object) -> object:
    found = next(e for e in BLOCKS[block].entries if e.name == entry)
    numbers = {K: 1, Ti: 60, Td: 0, Tf: 0, b: 1, Sy: 100, Su: 100}
    names = {"K": K, "Ti": Ti, "Td": Td, "Tf": Tf, "Sy": Sy, "Su": Su}
    return found.value.subs({**numbers, **{names[n]: Rational(v) for n, v in setting.items()}})


def test_udc_3300_page_123_twenty_repeats_are_five_hundredths_of_a_minute():
    Ti_of_20 = Fraction(60, 20)
    assert value("honeywell-udc-band", "RSET RPM", Ti=Ti_of_20) == 20
    assert value("honeywell-udc-gain", "RSET MIN", Ti=Ti_of_20) == Rational(5, 100)


def test_udc_3300_page_123_gain_times_band_is_a_hundred():
    gain = value("honeywell-udc-gain", "GAIN", K=Rational(5, 2), Sy=40, Su=80)
    assert gain * value("honeywell-udc-band", "PROP BD", K=Rational(5, 2), Sy=40, Su=80) == 100


def test_yokogawa_page_1_a_band_of_5_percent_of_0_to_1000_is_50():
    """Full output at 475, none at 525 around 500: 100 % of output over 50 of measurement."""
    K_of_example = Rational(100, 525 - 475)
    assert value("proportional-band", "PB", K=K_of_example, Sy=1000) == 5


def test_rockwell_1772_page_16_4_dependent_gains_turn_into_independent_ones():
    """KP = KC, KI = KC/(Ti 60), KD = KC Td 60, with Ti and Td in minutes."""
    setting = {"K": Rational(5, 4), "Ti": 90, "Td": 12, "Sy": 80}
    Kc, minutes, rate = (value("rockwell-pid-dependent", e, **setting) for e in (".KP", ".KI", ".KD"))
    P, I, D = (value("rockwell-pid-independent", e, **setting) for e in (".KP", ".KI", ".KD"))
    assert (P, I, D) == (Kc, Kc / (minutes * 60), Kc * rate * 60)


def test_acs320_page_230_an_error_of_100_percent_is_repeated_in_the_integration_time():
    """Gain 1, integration time 1 s: 100 % of change in 1 s. The step response of the integral part at t = Ti."""
    block = BLOCKS["abb-drive"]
    G, TI = (e.symbol for e in block.entries)
    integral = (block.feedback.subs({G: 1, TI: 1}) - 1) * s
    assert simplify(integral) == 1  # per second, of the error


def test_knx_page_93_the_recursion_is_the_equation():
    """ControlValue as the page computes it, on a ramp of the deviation, against P + 1/(I s) + D s."""
    P, I, D, h, slope = Fraction(3), Fraction(40), Fraction(7), Fraction(1, 1000), Fraction(1, 2)
    integral = Fraction(0)
    for k in range(1, 2001):
        deviation, old = slope * h * k, slope * h * (k - 1)
        integral += deviation * h / I
        control = deviation * P + integral + (deviation - old) / h * D
    t = h * 2000
    law = slope * (P * t + t**2 / (2 * I) + D)
    assert abs(control - law) < Fraction(1, 10000)


def test_siemens_page_246_the_derivative_is_delayed_by_the_coefficient_times_the_time():
    a, TD = (value("siemens-pid-compact", f"Retain.CtrlParams.{n}", Td=40, Tf=8) for n in ("TdFiltRatio", "Td"))
    assert a == Rational(1, 5) and a * TD == 8


def test_emerson_page_4_4_the_series_form_with_its_smoothing():
    """GAIN (1 + 1/(tr s)) (td s + 1)/(0.1 td s + 1) of numbers that come out even."""
    setting = {"K": 2, "Ti": 300, "Td": 60}
    G, tr, td = (value("emerson-series", e, **setting) for e in ("GAIN", "RESET", "RATE"))
    assert (G, tr, td) == (Rational(7, 5), 210, 100)
