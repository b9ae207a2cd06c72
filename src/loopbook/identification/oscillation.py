"""A record that oscillates steadily, by a relay or on the edge of stability: the process at that frequency.

    G(i w) = Y/U,    Y, U: first harmonics of output and input over the steady part

measured, not by the relay's describing function: hysteresis, dead time and an uneven load do not enter. Where the phase
is -180 degrees, |G| and 2 pi/w are K180 and T180; a relay with hysteresis stops short of it; the model then tells them.
"""

from dataclasses import dataclass, replace

import numpy as np

from loopbook.experiments.data import FrequencyData
from loopbook.identification.fit import Fit, Parameter
from loopbook.identification.least_squares import fit_structure
from loopbook.identification.models import INTEGRATING
from loopbook.records.record import Record
from loopbook.records.steps import Steps, noise_level

STEADY = 0.5  # of the record, its later part
FEWEST_PERIODS = 3.0
IN_OUTPUT, IN_INPUT = 0.9, 0.8  # share of the spread that harmonics explain
SAME = 0.15  # how much the amplitude of the two halves may differ
CLOSE = 3.0  # degrees: so near -180 the point is K180 and T180
FARTHEST = {"relay": 60.0, "sustained": 15.0}  # degrees from -180: beyond, something else made the input
LEVELS = 0.02  # of the input's range
HARMONICS = 5


@dataclass(frozen=True)
class Oscillation:
    """kind: "relay" or "sustained". period [s], gain |G| [y/u], phase [degrees] with the period's and the gain's 95 %
    half-widths. periods: how many were used. begin: the first sample of the steady part.
    """

    kind: str
    period: float
    gain: float
    phase: float
    period_width: float
    gain_width: float
    periods: float
    begin: int

    @property
    def frequency(self) -> FrequencyData | None:
        """K180 and T180, where the phase is -180 degrees or close to it."""
        if self.kind == "sustained":
            Kv, L = self.integrator
            return FrequencyData(Kv * 2 * L / np.pi, 4 * L)
        return FrequencyData(self.gain, self.period) if abs(self.phase + 180) <= CLOSE else None

    @property
    def integrator(self) -> tuple[float, float]:
        """(Kv, L) of the integrator with dead time that has this gain and this phase at this period."""
        w = 2 * np.pi / self.period
        return float(self.gain * w), float(np.radians(-self.phase - 90) / w)

    def describe(self) -> str:
        """In words."""
        what = "A relay made the loop oscillate" if self.kind == "relay" else "The loop oscillates steadily"
        return (
            f"{what}: period {self.period:.4g} s ± {self.period_width:.2g} s over {self.periods:.0f} periods, process "
            f"gain {self.gain:.4g} ± {self.gain_width:.2g} at {self.phase:.0f} degrees."
        )


def find_oscillation(record: Record) -> Oscillation | None:
    """The steady oscillation of input and output in the later part of a record; None where there is none."""
    begin = int((1 - STEADY) * len(record.time))
    t, u, y = (values[begin:] for values in (record.time, record.u, record.y))
    if len(t) < 30 or np.ptp(u) == 0 or np.ptp(y) == 0 or np.mean(np.diff(u) != 0) * len(u) < 2 * FEWEST_PERIODS - 2:
        return None
    length = float(t[-1] - t[0])
    w = _refined(t, y, _dominant(t, y))
    if w * length < 2 * np.pi * FEWEST_PERIODS:
        return None
    of_y, left_y = _harmonics(t, y, w, 3)
    of_u, left_u = _harmonics(t, u, w, HARMONICS)
    if np.var(left_y) > (1 - IN_OUTPUT) * np.var(y) or np.var(left_u) > (1 - IN_INPUT) * np.var(u):
        return None
    half = len(t) // 2
    sizes = [abs(_harmonics(t[part], y[part], w, 1)[0]) for part in (slice(0, half), slice(half, None))]
    if abs(sizes[0] - sizes[1]) > SAME * max(sizes):
        return None
    late = w * record.sampling / 2  # the input is held from one sample to the next
    G = of_y / (of_u * np.exp(-1j * late) * np.sinc(late / np.pi))
    phase = float(np.degrees(np.angle(G)))
    phase = phase if phase <= 0 else phase - 360
    kind = "relay" if _switches(u) else "sustained"
    if abs(phase + 180) > FARTHEST[kind]:
        return None
    sigma = float(np.std(left_y)) / max(abs(of_y), 1e-300)
    spread_w = np.sqrt(24 / len(t)) * sigma / length
    return Oscillation(
        kind,
        float(2 * np.pi / w),
        float(abs(G)),
        phase,
        float(1.96 * 2 * np.pi / w**2 * spread_w),
        float(1.96 * abs(G) * sigma * np.sqrt(2 / len(t))),
        float(w * length / (2 * np.pi)),
        begin,
    )


def integrator_through(record: Record, swing: Oscillation) -> tuple[Record, Steps, Fit]:
    """(steady part of the record, its input, the integrator with dead time through the point at -180 degrees)."""
    part = slice(swing.begin, None)
    time = record.time[part] - record.time[part][0]
    whole = replace(
        record, time=time, u=record.u[part], y=record.y[part], held=None, left_out=None, others=(), setpoint=None
    )
    changes = np.flatnonzero(np.diff(whole.u))
    listed = [(float(whole.time[k + 1]), float(whole.u[k + 1] - whole.u[k])) for k in changes]
    steps = Steps(listed, len(whole.time), noise_level(whole.y), (), True)
    Kv, L = swing.integrator
    of_gain, of_period = swing.gain_width / swing.gain / 1.96, swing.period_width / swing.period / 1.96
    spread = np.array([Kv * np.hypot(of_gain, of_period), L * of_period])
    parameters = (Parameter("Kv", Kv, 1.96 * float(spread[0])), Parameter("L", L, 1.96 * float(spread[1])))
    fit = fit_structure(whole, INTEGRATING, steps, "drift", {"K": Kv, "L": L})
    rest = float(whole.y.mean())
    return whole, steps, replace(fit, rest=rest, drift=0.0, parameters=parameters, covariance=np.diag(spread**2))


def _switches(u: np.ndarray) -> bool:
    """Does the input stand on two levels?"""
    low, high = float(u.min()), float(u.max())
    near = LEVELS * (high - low)
    return bool(np.mean((u < low + near) | (u > high - near)) > 0.95)


def _dominant(t: np.ndarray, y: np.ndarray) -> float:
    """The angular frequency [rad/s] of the largest line in the spectrum, the trend taken away."""
    even = np.linspace(t[0], t[-1], len(t))
    values = np.interp(even, t, y)
    values = values - np.polyval(np.polyfit(even, values, 1), even)
    spectrum = np.abs(np.fft.rfft(values * np.hanning(len(values))))
    spectrum[:2] = 0.0
    return float(2 * np.pi * np.argmax(spectrum) / (even[1] - even[0]) / len(values))


def _refined(t: np.ndarray, y: np.ndarray, w: float) -> float:
    """The angular frequency that explains most of y."""
    from scipy.optimize import minimize_scalar

    if not w:
        return 0.0
    step = 2 * np.pi / (t[-1] - t[0])
    cost = lambda at: float(np.sum(_harmonics(t, y, at, 3)[1] ** 2))  # noqa: E731
    grid = np.linspace(max(w - step, step), w + step, 21)
    best = grid[int(np.argmin([cost(at) for at in grid]))]
    return float(minimize_scalar(cost, bounds=(best - step / 10, best + step / 10), method="bounded").x)


def _harmonics(t: np.ndarray, values: np.ndarray, w: float, number: int) -> tuple[complex, np.ndarray]:
    """(complex amplitude of the first harmonic, what is left beside a mean, a trend and `number` harmonics)."""
    turned = [w * k * (t - t[0]) for k in range(1, number + 1)]
    columns = np.column_stack([np.ones_like(t), t - t.mean(), *[f(x) for x in turned for f in (np.cos, np.sin)]])
    found = np.linalg.lstsq(columns, values, rcond=None)[0]
    return complex(found[2], -found[3]), values - columns @ found
