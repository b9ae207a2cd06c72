"""Identification on data made from known processes: recovered within the stated intervals, or refused in words."""

import numpy as np
import pytest

from loopbook.identification import intervals
from loopbook.identification.choice import identify
from loopbook.identification.least_squares import fit_structure
from loopbook.identification.models import (
    FIRST_ORDER,
    INTEGRATING,
    INTEGRATING_LAG,
    INVERSE_RESPONSE,
    SECOND_ORDER,
    STRUCTURES,
    UNDERDAMPED,
    Structure,
)
from loopbook.process.transfer_function import Process
from loopbook.records.faults import find_faults
from loopbook.records.record import Other, Record, RecordError
from loopbook.records.steps import find_steps, noise_level

pytestmark = pytest.mark.long

TRUE = {
    FIRST_ORDER: ((2.0, 10.0, 3.0), 0.03),
    SECOND_ORDER: ((2.0, 10.0, 4.0, 2.0), 0.01),
    INTEGRATING: ((0.2, 3.0), 0.05),
    INTEGRATING_LAG: ((0.2, 4.0, 3.0), 0.03),
}


def made(structure: Structure, values, noise: float, seed: int = 0, length: float = 60.0, step_at: float = 5.0, h=0.25):
    """A record of one unit step through a known model, with white measurement noise."""
    time = np.arange(0.0, length, h)
    u = np.where(time >= step_at, 1.0, 0.0)
    first = float(time[np.argmax(u)])
    clean = values[0] * structure.response(time, [(first, 1.0)], tuple(values[1:-1]), values[-1])
    return Record(time, u, 20 + clean + np.random.default_rng(seed).normal(0, noise, len(time)))


@pytest.mark.parametrize("structure", STRUCTURES, ids=lambda s: s.name)
def test_the_shape_is_the_exact_response_of_the_process(structure):
    lags = (7.0, 2.0)[: structure.lags]
    process = structure.process(1.5, lags, 3.0)
    time = np.linspace(0, 40, 81)
    ours = 1.5 * structure.response(time, [(0.0, 1.0)], lags, 3.0)
    assert np.allclose(ours, process.step(time), atol=1e-9)


def test_nearly_equal_lags_are_no_trap():
    time = np.linspace(0, 40, 81)
    near = SECOND_ORDER.shape(time, (5.0, 5.0 * 0.979))
    equal = SECOND_ORDER.shape(time, (5.0, 5.0 * 0.981))
    assert np.abs(near - equal).max() < 2e-3


@pytest.mark.parametrize("structure", TRUE, ids=lambda s: s.name)
@pytest.mark.long
def test_known_processes_are_recovered_within_their_intervals_in_nine_of_ten_seeds(structure):
    values, noise = TRUE[structure]
    hits = np.zeros(len(values))
    for seed in range(20):
        fit = fit_structure(made(structure, values, noise, seed), structure)
        hits += [p.interval[0] <= v <= p.interval[1] for p, v in zip(fit.parameters, values, strict=True)]
    assert (hits >= 18).all(), hits


@pytest.mark.parametrize("structure", TRUE, ids=lambda s: s.name)
def test_the_structure_that_made_the_data_is_chosen(structure):
    values, noise = TRUE[structure]
    found = identify(made(structure, values, noise))
    assert found.chosen.structure is structure
    assert found.criteria[structure] <= 10 and len(found.reasons) == len(STRUCTURES)


def _quantised(seed: int, step: float) -> Record:
    """A record whose measurement moves in steps much coarser than its noise, from any level at rest."""
    record = made(FIRST_ORDER, TRUE[FIRST_ORDER][0], 0.01, seed)
    shifted = record.y + np.random.default_rng(1000 + seed).uniform(0, step)
    return Record(record.time, record.u, np.round(shifted / step) * step)


def _irregular(seed: int) -> Record:
    random = np.random.default_rng(seed)
    time = np.sort(np.arange(0.0, 60.0, 0.25) + random.uniform(-0.12, 0.12, 240))
    u = np.where(time >= 5, 1.0, 0.0)
    clean = 2 * FIRST_ORDER.response(time, [(float(time[np.argmax(u)]), 1.0)], (10.0,), 3.0)
    return Record(time, u, clean + random.normal(0, 0.03, 240))


def _several(seed: int) -> Record:
    time = np.arange(0.0, 160.0, 0.25)
    steps = [(5.0, 1.0), (60.0, -1.5), (110.0, 1.0)]
    u = sum(np.where(time >= at, size, 0.0) for at, size in steps)
    clean = 2 * FIRST_ORDER.response(time, steps, (10.0,), 3.0)
    return Record(time, u, clean + np.random.default_rng(seed).normal(0, 0.03, len(time)))


def _drifting(seed: int) -> Record:
    record = made(FIRST_ORDER, TRUE[FIRST_ORDER][0], 0.03, seed, length=100.0, step_at=30.0)
    return Record(record.time, record.u, record.y + 0.01 * record.time)


def _following(seed: int) -> Record:
    """Noise that forgets slowly, as a filtered measurement has it."""
    record = made(FIRST_ORDER, TRUE[FIRST_ORDER][0], 0.0, seed)
    noise = np.random.default_rng(seed).normal(0, 0.02, len(record.time))
    for k in range(1, len(noise)):
        noise[k] += 0.7 * noise[k - 1]
    return Record(record.time, record.u, record.y + noise)


@pytest.mark.parametrize(
    "record",
    [
        lambda seed: _quantised(seed, 0.05),
        lambda seed: _quantised(seed, 0.1),
        lambda seed: _quantised(seed, 0.3),
        _irregular,
        _several,
        _drifting,
        _following,
        lambda seed: made(FIRST_ORDER, TRUE[FIRST_ORDER][0], 0.03, seed, length=25.0),
    ],
    ids=["quantised", "coarse", "very coarse", "irregular", "several steps", "drift", "slow noise", "early end"],
)
@pytest.mark.long
def test_records_that_are_not_clean_keep_the_promise_of_the_intervals(record):
    hits = np.zeros(3)
    for seed in range(20):
        fit = fit_structure(record(seed), FIRST_ORDER)
        hits += [p.interval[0] <= v <= p.interval[1] for p, v in zip(fit.parameters, (2.0, 10.0, 3.0), strict=True)]
    assert (hits >= 18).all(), hits


def test_the_cost_of_correlation():
    random = np.random.default_rng(0).normal(size=20_000)
    following = random.copy()
    for k in range(1, len(following)):
        following[k] += 0.8 * following[k - 1]
    assert intervals.cost_of_correlation(random) == pytest.approx(1.0, abs=0.1)
    assert intervals.cost_of_correlation(following) == pytest.approx(1.8 / 0.2, rel=0.2)


def test_a_measurement_that_stands_still_has_one_error_for_all_its_samples():
    """The mean of n equal samples is as uncertain as one; of n that change levels, n times less so."""
    mean = np.ones((400, 1))
    still, moving = np.repeat([1.0, 1.5], 200), np.tile([1.0, 1.5], 200)
    (wide, _), (narrow, _) = (intervals.covariance(mean, np.zeros(400), y) for y in (still, moving))
    assert wide[0, 0] == pytest.approx(0.5**2 / 12 / 2) and narrow[0, 0] == pytest.approx(0.5**2 / 12 / 400)
    assert intervals.quantum(np.arange(400.0)) == 0.0


def test_intervals_shrink_with_the_noise():
    loud, quiet = (fit_structure(made(FIRST_ORDER, TRUE[FIRST_ORDER][0], s), FIRST_ORDER) for s in (0.1, 0.01))
    for a, b in zip(loud.parameters, quiet.parameters, strict=True):
        assert b.half_width < 0.3 * a.half_width


def test_several_steps_drift_and_quantisation():
    time = np.arange(0, 200, 0.5)
    u = np.select([time < 20, time < 80, time < 140], [0.0, 1.0, -0.5], 0.5)
    steps = [(20.0, 1.0), (80.0, -1.5), (140.0, 1.0)]
    clean = 3 * FIRST_ORDER.response(time, steps, (12.0,), 4.0)
    quantised = np.round((clean + np.random.default_rng(3).normal(0, 0.02, len(time))) / 0.05) * 0.05
    found = identify(Record(time, u, quantised))
    assert len(found.steps.list) == 3
    for parameter, true in zip(found.chosen.parameters, (3.0, 12.0, 4.0), strict=True):
        assert parameter.value == pytest.approx(true, rel=0.02)
    drifting = fit_structure(Record(time, u, clean + 0.002 * time), FIRST_ORDER)
    assert drifting.drift == pytest.approx(0.002, rel=1e-3)


def test_noise_level_ignores_the_response_and_the_jump():
    time = np.arange(0, 100, 0.1)
    noise = np.random.default_rng(1).normal(0, 0.05, len(time))
    signal = np.where(time > 50, 10 * (1 - np.exp(-(time - 50) / 5)), 0)
    assert noise_level(signal + noise) == pytest.approx(0.05, rel=0.1)


def test_a_record_that_ends_too_early_is_used_with_a_warning():
    found = identify(made(FIRST_ORDER, (2.0, 30.0, 3.0), 0.002, length=50))
    assert any("extrapolation" in warning for warning in found.warnings)


@pytest.mark.parametrize(
    ("u", "y", "message"),
    [
        (np.ones(100), np.arange(100.0), "no step found: the input 'u' is 1 from the first sample"),
        (np.arange(100) >= 20, np.full(100, 3.0), "does not answer the step"),
        (np.arange(100) >= 20, np.random.default_rng(0).normal(size=100), "does not answer|lost in the noise"),
        (np.random.default_rng(0).normal(size=100), np.arange(100.0), "a drift explains"),
        (
            np.arange(100) >= 20,
            np.sin(np.arange(100) * 1.9) + np.arange(100) % 17,
            "no model explains|does not answer|lost in the noise",
        ),
    ],
)
def test_records_that_support_no_model_are_refused_in_words(u, y, message):
    with pytest.raises(RecordError, match=message):
        identify(Record(np.arange(100.0), np.asarray(u, float), y))


def test_a_ramp_and_a_random_course_are_used_as_recorded():
    time = np.arange(0.0, 200.0, 0.5)
    random = np.random.default_rng(4)
    courses = (
        np.clip((time - 20) / 60, 0, 1),
        np.repeat(random.choice([0.0, 1.0], 40), 10),
        np.where(time < 20, 0, np.sin((time - 20) / 15)),
    )
    for u in courses:
        moves = np.flatnonzero(np.diff(u))
        steps = [(float(time[k + 1]), float(u[k + 1] - u[k])) for k in moves]
        clean = sum(2 * h * FIRST_ORDER.shape(time - at - 3, (10.0,)) for at, h in steps)
        found = identify(Record(time, u, clean + random.normal(0, 0.01, len(time))))
        assert found.chosen.structure is FIRST_ORDER
        for p, true in zip(found.chosen.parameters, (2.0, 10.0, 3.0), strict=True):
            assert p.value == pytest.approx(true, rel=0.05)


@pytest.mark.parametrize("structure", STRUCTURES, ids=lambda s: s.name)
def test_many_steps_in_one_pass_are_the_sum_of_their_responses(structure):
    time = np.linspace(0, 60, 301)
    random = np.random.default_rng(1)
    steps = [
        (float(t), float(h)) for t, h in zip(np.sort(random.uniform(0, 50, 30)), random.normal(size=30), strict=True)
    ]
    lags = (6.0, 1.5)[: structure.lags]
    added = sum(h * structure.shape(time - at - 2.3, lags) for at, h in steps)
    assert np.allclose(structure.response(time, steps, lags, 2.3), added, atol=1e-9)


def test_a_start_off_rest_is_estimated_along():
    record = made(FIRST_ORDER, (2.0, 10.0, 3.0), 0.01, length=120.0, step_at=15.0)
    decaying = Record(record.time, record.u, record.y + 1.5 * np.exp(-record.time / 10))
    found = identify(decaying)
    assert found.chosen.nuisance == "start"
    for p, true in zip(found.chosen.parameters, (2.0, 10.0, 3.0), strict=True):
        assert p.value == pytest.approx(true, rel=0.03)


def test_a_further_input_is_a_known_disturbance():
    record = made(FIRST_ORDER, (2.0, 10.0, 3.0), 0.01, length=120.0)
    other = np.where(record.time >= 60, 2.0, 0.0)
    y = record.y + 0.7 * 2.0 * FIRST_ORDER.response(record.time, [(60.0, 1.0)], (10.0,), 3.0)
    found = identify(Record(record.time, record.u, y, others=(Other("Q2", other),)))
    assert found.chosen.effects["Q2"] == pytest.approx(0.7, rel=0.03)
    assert any("Q2 moves too" in reason for reason in found.reasons)


def test_outliers_and_a_cut_sensor_are_left_out():
    record = made(FIRST_ORDER, (2.0, 10.0, 3.0), 0.02, length=80.0)
    y = np.minimum(record.y, 20 + 2 * 0.9)
    y[[50, 120]] += 9.0
    faults = find_faults(record.time, record.u, y)
    assert faults.left_out[[50, 120]].all() and 0.3 < faults.cut < 0.9 and len(faults.notes) == 2
    found = identify(Record(record.time, record.u, y, left_out=faults.left_out, cut=faults.cut))
    for p, true in zip(found.chosen.parameters, (2.0, 10.0, 3.0), strict=True):
        assert p.value == pytest.approx(true, rel=0.1)


def test_a_clean_record_has_no_faults():
    for structure, (values, noise) in TRUE.items():
        for size in (0.0, noise, 10 * noise):
            record = made(structure, values, size)
            assert not find_faults(record.time, record.u, record.y).left_out.any(), (structure, size)


def test_the_step_is_found_where_the_input_moves():
    record = made(FIRST_ORDER, (2.0, 10.0, 3.0), 0.01, step_at=7.0)
    steps = find_steps(record)
    assert steps.list == [(7.0, 1.0)] and steps.before == 28


def test_the_fit_gives_a_process():
    fit = fit_structure(made(FIRST_ORDER, (2.0, 10.0, 3.0), 0.0), FIRST_ORDER)
    assert isinstance(fit.process, Process)
    assert (fit.process.static_gain, fit.process.delay) == pytest.approx((2.0, 3.0), rel=1e-3)


RINGING, WRONG_WAY = (2.0, 8.0, 0.25, 3.0), (2.0, 10.0, 5.0, 6.0, 2.0)


@pytest.mark.parametrize(("structure", "values"), [(UNDERDAMPED, RINGING), (INVERSE_RESPONSE, WRONG_WAY)])
def test_unusual_structures_are_recovered_within_their_intervals(structure, values):
    """The response is that of the process, by another route; each parameter's interval holds it."""
    hits, process = np.zeros(len(values)), structure.process(values[0], values[1:-1], values[-1])
    time = np.arange(0.0, 150.0, 0.5)
    clean = process.step(time - 10.0)
    assert np.allclose(values[0] * structure.response(time, [(10.0, 1.0)], values[1:-1], values[-1]), clean, atol=1e-8)
    for seed in range(5):
        y = 20 + clean + np.random.default_rng(seed).normal(0, 0.03, len(time))
        found = identify(Record(time, np.where(time >= 10, 1.0, 0.0), y)).chosen
        assert found.structure is structure
        hits += [p.interval[0] <= v <= p.interval[1] for p, v in zip(found.parameters, values, strict=True)]
    assert (hits >= 4).all(), hits


@pytest.mark.parametrize("seed", range(6))
def test_unusual_structures_are_not_chosen_where_lags_made_the_record(seed):
    structure = (FIRST_ORDER, SECOND_ORDER, INTEGRATING_LAG)[seed % 3]
    found = identify(made(structure, TRUE[structure][0], TRUE[structure][1], seed))
    assert found.chosen.structure.common and all(s.common for s in found.fits)
