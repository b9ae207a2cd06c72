"""What peers have, too: every function beside python-control or SciPy, on the same problem, with how far they differ.

A peer that holds no dead time gets a Padé approximation, of the order that is named. Each time is the fastest of many
runs; imports are not measured.
"""

import time
import warnings
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

import loopbook as lb

ENOUGH = 0.25  # seconds per measurement
PLANT = lb.tf([1, 3], [[1, 1], [2, 1], [1, 0.8, 4]])
OTHER = lb.tf([2], [3, 4, 1])
DEAD = lb.tf(2, [[10, 1], [4, 1]], delay=3)
REGULATOR = lb.PidParallel(1.0, 0.1)
IN_Z = lb.DiscreteProcess.in_z([0.04798, 0.0464], [1, -1.81, 0.9048], 0.1)
TIMES = np.linspace(0.0, 60.0, 1000)


def fastest(run: Callable[[], Any]) -> tuple[float, Any]:
    """(seconds, result) of the fastest of as many runs as fit into the time for one measurement."""
    result, best, spent = run(), np.inf, 0.0
    while spent < ENOUGH:
        start = time.perf_counter()
        result = run()
        took = time.perf_counter() - start
        best, spent = min(best, took), spent + took
    return best, result


def apart(ours: Any, theirs: Any) -> float:
    """The largest difference relative to the largest number."""
    ours, theirs = (np.atleast_1d(np.asarray(x, complex)) for x in (ours, theirs))
    return float(np.abs(ours - theirs).max() / np.abs(theirs).max())


def in_order(roots: Any) -> np.ndarray:
    """Roots sorted so that two lists of the same can be compared."""
    return np.array(sorted(np.asarray(roots, complex), key=lambda r: (round(r.real, 6), r.imag)))


def at(system: Any, points: Any) -> np.ndarray:
    """The values of a transfer function of either side."""
    return np.array([complex(system(point)) for point in points])


def pairs() -> Iterator[tuple[str, Callable[[], Any], str, Callable[[], Any], Callable[[Any], Any]]]:
    """(what, ours, the peer's name, the peer's, what of both results is compared)."""
    import control as ct
    import scipy.signal as sig

    P, Q = (ct.tf(list(G.num), list(G.den)) for G in (PLANT, OTHER))
    C = ct.tf([1.0, 0.1], [1.0, 0.0])
    somewhere = np.array([0.1j, 0.3 + 1j, 3j])
    for what, ours, theirs in (
        ("P*Q", lambda: PLANT * OTHER, lambda: P * Q),
        ("P + Q", lambda: PLANT + OTHER, lambda: P + Q),
        ("feedback(P, Q)", lambda: lb.feedback(PLANT, OTHER), lambda: ct.feedback(P, Q)),
    ):
        yield what, ours, "python-control", theirs, lambda G: at(G, somewhere)
    yield "poles of P", lambda: lb.tf(PLANT.num, PLANT.den).poles, "python-control", P.poles, in_order
    yield "static gain", lambda: PLANT.static_gain, "python-control", P.dcgain, lambda y: y
    yield from _responses(ct, sig, P)
    yield from _dead_time(ct, C)
    yield from _sampling(ct, sig, P, somewhere)
    yield from _polynomials_and_states(ct, sig)
    yield from _figures(ct, P * C)


def _responses(ct: Any, sig: Any, P: Any) -> Iterator[tuple]:
    yield (
        "step response of P, 1000 points",
        lambda: PLANT.step(TIMES),
        "python-control",
        lambda: ct.step_response(P, TIMES).outputs,
        np.asarray,
    )
    yield (
        "impulse response of P, 1000 points",
        lambda: lb.impulse_response(PLANT, 60.0)(TIMES),
        "python-control",
        lambda: ct.impulse_response(P, TIMES).outputs,
        np.asarray,
    )
    yield (
        "ramp response of P, 1000 points",
        lambda: lb.ramp_response(PLANT, 60.0)(TIMES),
        "python-control",
        lambda: ct.forced_response(P, TIMES, TIMES).outputs,
        np.asarray,
    )


def _dead_time(ct: Any, C: Any) -> Iterator[tuple]:
    order = 12
    approximate = ct.tf(list(DEAD.num), list(DEAD.den)) * ct.tf(*ct.pade(DEAD.delay, order))

    def rightmost(roots: Any) -> np.ndarray:
        return np.array(sorted(getattr(roots, "roots", roots), key=lambda r: (-round(r.real, 9), r.imag))[:4])

    yield (
        "rightmost poles of a loop with dead time",
        lambda: lb.poles(lb.Loop(DEAD, REGULATOR)),
        f"python-control, Padé {order}",
        lambda: ct.feedback(approximate * C).poles(),
        rightmost,
    )
    yield (
        "its reference step, 1000 points",
        lambda: lb.Loop(DEAD, REGULATOR).step("reference", 60.0).y(TIMES),
        f"python-control, Padé {order}",
        lambda: ct.step_response(ct.feedback(approximate * C), TIMES).outputs,
        np.asarray,
    )
    two = lb.tf([1], [2, 1], delay=1) + lb.tf([0.5], [2, 1], delay=3)
    sum_ = sum(ct.tf([k], [2, 1]) * ct.tf(*ct.pade(L, 8)) for k, L in ((1, 1.0), (0.5, 3.0)))
    yield (
        "margins of a loop with two dead times",
        lambda: (lambda m: (m.gain, m.Ms.value))(lb.GeneralLoop(two, 0.5).margins()),
        "python-control, Padé 8",
        lambda: (lambda m: (m[0], 1 / m[2]))(ct.stability_margins(0.5 * sum_)),
        np.asarray,
    )
    yield (
        "step response of that loop, 1000 points",
        lambda: lb.step_response(lb.GeneralLoop(two, 0.5), 60.0)(TIMES),
        "python-control, Padé 8",
        lambda: ct.step_response(ct.feedback(0.5 * sum_), TIMES).outputs,
        np.asarray,
    )
    yield (
        "Padé of order 5",
        lambda: lb.pade(3.0, 5),
        "python-control",
        lambda: ct.tf(*ct.pade(3.0, 5)),
        lambda G: at(G, [0.1j, 1j]),
    )


def _sampling(ct: Any, sig: Any, P: Any, somewhere: np.ndarray) -> Iterator[tuple]:
    h, in_z = 0.2, ct.tf([0.04798, 0.0464], [1, -1.81, 0.9048], 0.1)
    circle = np.exp(somewhere.imag * 0.2j)
    for method in ("zoh", "foh", "tustin", "matched", "euler"):
        yield (
            f"c2d by {method}" + ", zeros at infinity to -1 (the peer drops them)" * (method == "matched"),
            lambda method=method: lb.DiscreteProcess.of(lb.c2d(PLANT, h, method)),
            "python-control",
            lambda method=method: ct.sample_system(P, h, method),
            lambda G: at(G, circle),
        )
    yield (
        "c2d by tustin with prewarp",
        lambda: lb.c2d(PLANT, h, "tustin", prewarp=2.0),
        "python-control",
        lambda: ct.sample_system(P, h, "tustin", prewarp_frequency=2.0),
        lambda G: at(G, circle),
    )
    yield (
        "gain and phase margin of a plant in z",
        lambda: (lambda m: (m.gain, m.phase))(lb.crossovers(IN_Z)),
        "python-control",
        lambda: ct.margin(in_z)[:2],
        np.asarray,
    )
    yield (
        "its margins, the least distance to -1 included",
        lambda: (lambda m: (m.gain, m.phase, 1 / m.Ms.value))(lb.DiscreteLoop(IN_Z).margins()),
        "python-control, on a grid",
        lambda: ct.stability_margins(in_z)[:3],
        np.asarray,
    )


def _polynomials_and_states(ct: Any, sig: Any) -> Iterator[tuple]:
    rng = np.random.default_rng(1)
    A, B, C = rng.normal(size=(5, 5)), rng.normal(size=(5, 1)), rng.normal(size=(1, 5))
    poles = [-1.0, -1.5, -2.0, -2 + 1j, -2 - 1j]
    yield (
        "transfer function of five states",
        lambda: lb.ss(A, B, C),
        "python-control",
        lambda: ct.ss2tf(A, B, C, np.zeros((1, 1))),
        lambda G: at(G, [0.5j, 2j]),
    )
    yield (
        "the same, rounded once",
        lambda: lb.ss(A, B, C).num,
        "SciPy, rounded at every step",
        lambda: np.trim_zeros(sig.ss2tf(A, B, C, np.zeros((1, 1)))[0][0], "f"),
        np.asarray,
    )
    yield (
        "state feedback of five states",
        lambda: lb.state_feedback(A, B, poles),
        "python-control, acker",
        lambda: ct.acker(A, B, poles),
        np.asarray,
    )
    yield (
        "the same",
        lambda: lb.state_feedback(A, B, poles),
        "SciPy, place_poles",
        lambda: sig.place_poles(A, B, np.array(poles)).gain_matrix,
        np.asarray,
    )
    yield (
        "observer of five states",
        lambda: lb.observer(A, C, poles),
        "python-control, place",
        lambda: ct.place(A.T, C.T, poles).T,
        np.asarray,
    )


def _figures(ct: Any, rational: Any) -> Iterator[tuple]:
    import matplotlib.pyplot as plt

    loop = lb.Loop(PLANT, REGULATOR)

    def drawn(make: Callable[[], Any]) -> Callable[[], Any]:
        def run() -> None:
            make()
            plt.close("all")

        return run

    yield (
        "Bode diagram",
        drawn(lambda: lb.bode(loop)),
        "python-control",
        drawn(lambda: ct.bode_plot(rational)),
        lambda _: 1.0,
    )
    yield (
        "Nyquist diagram",
        drawn(lambda: lb.nyquist(loop)),
        "python-control",
        drawn(lambda: ct.nyquist_plot(rational)),
        lambda _: 1.0,
    )


def rows() -> list[tuple[str, float, str]]:
    """(what, seconds of ours, the peer's time and the difference of the results)."""
    found = []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for what, ours, name, theirs, compared in pairs():
            mine, result = fastest(ours)
            seconds, other = fastest(theirs)
            difference = apart(compared(result), compared(other))
            times = f"{name}: {seconds * 1e3:.3g} ms, {seconds / mine:.3g} times the time"
            remark = f"{times}; they differ by {difference:.0e}"
            found.append((what, mine, remark))
    return found
