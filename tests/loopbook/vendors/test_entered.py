"""Settings in a controller's own form: values, ranges, refusals, and what the block does otherwise."""

import pytest
import vendor_forms as tool
from hypothesis import given, settings
from hypothesis import strategies as st

import loopbook as lb
from derivations.vendors import block as symbols
from derivations.vendors.catalogue import by_name
from loopbook.vendors.entered import VendorFormError, block_named, enter, vendor_forms

PID = lb.PidStandard(2.0, 300.0, 60.0, b=1.0, N=10)
RANGES = (0, 150), (0, 100)


def test_the_page_in_the_documentation_is_what_the_blocks_say():
    assert tool.PAGE.read_text(encoding="utf-8") == tool.page(), "python tools/vendor_forms.py writes it"


def test_a_series_form_is_refused_where_the_zeros_are_complex():
    with pytest.raises(VendorFormError, match=r"Ti = 100 s, Td = 40 s.*needs Ti >= 4 Td"):
        enter(lb.PidStandard(2, 100, 40, N=10), "series")
    enter(lb.PidStandard(2, 160, 40, b=1, c=1), "series")  # the edge itself


def test_percent_forms_scale_with_the_ranges():
    assert enter(PID, "rockwell-pide-independent", *RANGES).values == {"PGain": 3.0, "IGain": 0.6, "DGain": 3.0}
    assert enter(PID, "proportional-band", *RANGES).values["PB"] == pytest.approx(100 / 3)


def test_without_a_measuring_range_the_gain_is_given_per_span():
    (typed, *_) = enter(PID, "emerson-standard", None, (0, 100)).typed
    assert typed.value is None and typed.per_span * 150 == pytest.approx(3.0) and not typed.inverse
    (typed, *_) = enter(PID, "proportional-band", None, (0, 100)).typed
    assert typed.inverse and typed.per_span / 150 == pytest.approx(100 / 3)


def test_without_the_output_s_range_a_percent_form_is_refused():
    with pytest.raises(VendorFormError, match="u_range"):
        enter(PID, "siemens-pid-compact")


@pytest.mark.parametrize(("y_range", "u_range"), [((1, 1), (0, 100)), ((0, float("inf")), (0, 1)), ((0, 1), (5, 2))])
def test_ranges_without_a_span_are_refused(y_range, u_range):
    with pytest.raises(VendorFormError, match="finite ends are expected"):
        enter(PID, "percent-repeats", y_range, u_range)


def test_a_number_that_the_controller_does_not_take_is_refused():
    with pytest.raises(VendorFormError, match=r"RSET MIN = 83.33 min/repeat, and it takes 0.02 to 50"):
        enter(lb.PidStandard(2, 5000), "honeywell-udc-gain", *RANGES)


def test_a_falling_process_turns_the_direction_and_keeps_the_gain():
    up, down = (enter(lb.PidStandard(K, 300), "siemens-pid-compact", *RANGES) for K in (2, -2))
    assert up.values == down.values and up.selections != down.selections
    assert down.realised.K == -2


def test_what_a_block_does_otherwise_is_said():
    notes = " ".join(enter(lb.PidStandard(2, 300, 60, b=0.0, N=10), "codesys-pid").notes)
    assert (
        "weight 0 cannot be entered" in notes and "acts on the error" in notes and "no filter instead of 6 s" in notes
    )


def test_derivative_action_whose_form_the_manual_leaves_open_is_refused():
    for form in ("honeywell-udc-gain", "abb-drive"):
        with pytest.raises(VendorFormError, match="take a PI"):
            enter(PID, form, *RANGES)
        enter(lb.PidStandard(2.0, 300.0), form, *RANGES)


def test_an_unknown_name_is_told_the_nearest():
    with pytest.raises(VendorFormError, match="siemens-pid-compact"):
        enter(PID, "siemens-pid")


def test_no_integral_action_is_refused():
    with pytest.raises(VendorFormError, match="Ti = inf"):
        enter(lb.PidStandard(2.0), "ideal")


positive = st.floats(1e-3, 1e3)


@settings(max_examples=25, deadline=None)
@given(positive, positive, st.floats(0.01, 0.22), st.sampled_from(sorted(vendor_forms())))
def test_the_block_s_loop_is_the_realised_setting(K, Ti, share, form):
    """The typed numbers in the block's equation, at a complex frequency, against what `realised` says."""
    pid = lb.PidStandard(K, Ti, share * Ti if not block_named(form).derivative else 0.0, N=8)
    try:
        entered = enter(pid, form, (0, 40), (0, 25))
    except VendorFormError as error:
        assert "takes" in str(error)
        return
    block = by_name()[form]
    values = {e.symbol: entered.values.get(e.name, 0.0) for e in block.entries}
    s = 1j / Ti
    numeric = {symbols.s: s, symbols.Sy: 40.0, symbols.Su: 25.0, **values}
    ours = complex((block.signals * block.feedback).subs(numeric))
    assert ours == pytest.approx(complex(entered.realised(s)), rel=1e-9)
