"""Seeded plants and their records, simulated here: nothing of the package reads, identifies or simulates in this file.

Each plant is a small state space; its input is held over a tenth of a sampling interval, in which the state moves
exactly (a matrix exponential by its own series). Dead times are whole tenths.
"""

from dataclasses import dataclass, field

import numpy as np

FINE = 10


@dataclass
class Case:
    """A record with what is true of it. truth: by the names of the fitted parameters. records: (t, u, y, set-point)."""

    kind: str
    seed: int
    structure: str
    truth: dict[str, float]
    records: list[tuple[np.ndarray, ...]]
    point: tuple[float, float] | None = None
    told: dict = field(default_factory=dict)


def exponential(A: np.ndarray) -> np.ndarray:
    """e^A by scaling and squaring of its series."""
    halvings = max(int(np.ceil(np.log2(max(np.abs(A).sum(axis=1).max(), 1e-300)))) + 6, 0)
    X, term, total = A / 2**halvings, np.eye(len(A)), np.eye(len(A))
    for k in range(1, 12):
        term = term @ X / k
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total


class Plant:
    """State space (A, b, c) with a dead time, stepped by h/10 with the input held."""

    def __init__(self, A, b, c, delay: float, h: float):
        A, b = np.array(A, float), np.array(b, float)
        n, fine = len(A), h / FINE
        block = np.zeros((n + 1, n + 1))
        block[:n, :n], block[:n, n] = A * fine, b * fine
        moved = exponential(block)
        self.Ad, self.bd, self.c = moved[:n, :n], moved[:n, n], np.array(c, float)
        self.x, self.late = np.zeros(n), [0.0] * round(delay / fine)

    def output(self) -> float:
        return float(self.c @ self.x)

    def hold(self, u: float) -> None:
        for _ in range(FINE):
            self.late.append(u)
            self.x = self.Ad @ self.x + self.bd * self.late.pop(0)


def plant(kind: str, v: dict[str, float], h: float) -> Plant:
    """The plant of a kind with the values v."""
    L = v["L"]
    if kind == "first":
        return Plant([[-1 / v["T"]]], [v["Kp"] / v["T"]], [1], L, h)
    if kind == "second":
        return Plant([[-1 / v["T1"], 0], [1 / v["T2"], -1 / v["T2"]]], [v["Kp"] / v["T1"], 0], [0, 1], L, h)
    if kind == "integrating":
        return Plant([[0.0]], [v["Kv"]], [1], L, h)
    if kind == "integrating lag":
        return Plant([[-1 / v["T"], 0], [1, 0]], [v["Kv"] / v["T"], 0], [0, 1], L, h)
    if kind == "underdamped":
        w = 1 / v["T"]
        return Plant([[0, 1], [-w * w, -2 * v["zeta"] * w]], [0, v["Kp"] * w * w], [1, 0], L, h)
    a = v["T1"] * v["T2"]
    return Plant([[0, 1], [-1 / a, -(v["T1"] + v["T2"]) / a]], [0, v["Kp"] / a], [1, -v["Tz"]], L, h)


KINDS = {
    "first": "first order",
    "second": "second order",
    "integrating": "integrating with dead time",
    "integrating lag": "integrating with a lag",
    "underdamped": "underdamped",
    "inverse": "two lags with a zero",
    "closed loop": "first order",
    "relay": "second order",
    "pooled": "first order",
}


def draw(kind: str, r: np.random.Generator) -> tuple[dict[str, float], float, float]:
    """(values, sampling interval, slowest time): parameters that a record of this length shows."""
    h = float(f"{10 ** r.uniform(-2, 1.5):.1g}")
    T = h * r.uniform(20, 40)
    share = r.uniform(0.2, 0.6)
    L = round(T * share / (h / FINE)) * h / FINE
    gain = float(10 ** r.uniform(-1, 1) * r.choice([-1, 1]))
    if kind == "integrating":
        return {"Kv": gain / T, "L": L}, h, T
    if kind == "integrating lag":
        return {"Kv": gain / T, "T": T, "L": L}, h, 2 * T
    if kind == "second" or kind == "relay":
        return {"Kp": abs(gain), "T1": T, "T2": T * r.uniform(0.25, 0.5), "L": L}, h, 1.5 * T
    if kind == "underdamped":
        return (
            {"Kp": gain, "T": T / 3, "zeta": r.uniform(0.15, 0.45), "L": round(L / 3 / h * FINE) * h / FINE},
            h,
            2 * T,
        )
    if kind == "inverse":
        return {"Kp": gain, "T1": T, "T2": T * r.uniform(0.3, 0.6), "Tz": T * r.uniform(0.5, 1.2), "L": L}, h, 1.6 * T
    return {"Kp": gain, "T": T, "L": L}, h, T


def step_record(kind, values, h, slow, r, height=1.0):
    """Rest, one step or two, sensor noise."""
    p, n = plant(kind, values, h), min(int(8 * (slow + values["L"]) / h) + 40, 900)
    at, back = 30, 30 + (n - 30) // 2 if r.uniform() < 0.4 else n
    u = np.zeros(n)
    u[at:back] = height
    y = np.empty(n)
    for k in range(n):
        y[k] = p.output()
        p.hold(u[k])
    return np.arange(n) * h, u, y


def noisy(y, r, low, high, colour=0.0):
    """Noise of the sensor, the output's range being between low and high times its standard deviation."""
    sigma = float(np.ptp(y)) / np.exp(r.uniform(np.log(low), np.log(high)))
    e, w = r.standard_normal(len(y)), np.zeros(len(y))
    for k in range(1, len(y)):
        w[k] = colour * w[k - 1] + np.sqrt(1 - colour**2) * e[k]
    return sigma * w


def closed_record(values, h, slow, r):
    """PI with limits and anti-windup, two set-point steps, noise in the loop, white or coloured."""
    p = plant("first", values, h)
    K = 0.5 * values["T"] / (values["Kp"] * (values["L"] + 0.2 * values["T"]))
    Ti, n = values["T"], min(int(12 * (slow + values["L"]) / h), 900)
    colour, span = float(r.choice([0.0, 0.6, 0.9])), abs(1.6 / values["Kp"])
    noise = noisy(np.array([0.0, 1.0] * (n // 2 + 1))[:n], r, 30.0, 120.0, colour)
    I, rows = 0.0, []
    for k in range(n):
        aim = 0.0 if k < 40 else 1.0 if k < n // 2 else 0.3
        y = p.output() + noise[k]
        v = K * (aim - y) + I
        u = float(np.clip(v, -span, span))
        I += K * h / Ti * (aim - y) + (u - v) * h / Ti
        rows.append((k * h, u, y, aim))
        p.hold(u)
    return tuple(np.array(rows).T)


def relay_record(values, h, slow, r):
    """A relay with hysteresis, the noise in the loop."""
    p, n = plant("second", values, h), min(int(16 * (values["T2"] + values["L"]) * 2 / h) + 200, 1200)
    size = 0.4 * values["Kp"] * (values["L"] + values["T2"]) / values["T1"]
    hysteresis, sigma = size * r.uniform(0.05, 0.3), size / r.uniform(40, 120)
    u, rows = 0.0, []
    for k in range(n):
        y = p.output() + sigma * r.standard_normal()
        u = 0.0 if k < 20 else 1.0 if k == 20 or y < -hysteresis else -1.0 if y > hysteresis else u
        rows.append((k * h, u, y))
        p.hold(u)
    return tuple(np.array(rows).T)


def ultimate(values) -> tuple[float, float]:
    """(K180, T180) of two lags and a dead time, by bisection of the phase."""
    phase = lambda w: -np.arctan(w * values["T1"]) - np.arctan(w * values["T2"]) - w * values["L"] + np.pi  # noqa: E731
    low, high = 1e-6 / values["T1"], np.pi / values["L"]
    for _ in range(80):
        mid = (low + high) / 2
        low, high = (mid, high) if phase(mid) > 0 else (low, mid)
    gain = values["Kp"] / np.hypot(1, low * values["T1"]) / np.hypot(1, low * values["T2"])
    return float(gain), float(2 * np.pi / low)


def make(kind: str, seed: int) -> Case:
    """The case of a kind and a seed; the same for the same seed."""
    r = np.random.default_rng([list(KINDS).index(kind), seed])
    values, h, slow = draw(kind, r)
    offset = float(r.uniform(-3, 3)), float(r.uniform(0, 50))
    if kind == "closed loop":
        t, u, y, aim = closed_record(values, h, slow, r)
        return Case(kind, seed, KINDS[kind], values, [(t, u + offset[1], y + offset[0], aim + offset[0])])
    if kind == "relay":
        t, u, y = relay_record(values, h, slow, r)
        return Case(kind, seed, KINDS[kind], values, [(t, u + offset[1], y + offset[0])], ultimate(values))
    shape = "first" if kind == "pooled" else kind
    records = []
    for height in (1.0, -0.7, 1.4) if kind == "pooled" else (1.0,):
        t, u, y = step_record(shape, values, h, slow, r, height)
        ends = (150.0, 600.0) if kind == "integrating lag" else (25.0, 150.0)  # of a ramp's height the lag is a tenth
        records.append((t, u + offset[1], y + offset[0] + noisy(y, r, *ends)))
    return Case(kind, seed, KINDS[kind], values, records)
