"""Fifty settings in eight scenarios: what the proof feeds to every language. Seeded, and the same on every machine.

The numbers have as many digits as the type they are for: products of two short numbers would be exact in double, and
their order would not show. The measurements come from a loop closed around the reference: a first-order plant for each
lane, with noise.
"""

from collections.abc import Iterator

import numpy as np
from reference_pid import NAMES, ReferenceMachine

SCENARIOS = ("automatic", "manual", "bump", "reset", "limits", "rate", "NaN", "parameter change")
SETTINGS = 50
SETS = 4  # settings that a lane changes between; the last is out of range
INPUTS = ("y_sp", "y", "ff", "elapsed", "u_manual", "manual", "reset", "start", "index", "power")


def exact_in(number: type, values) -> np.ndarray:
    """The nearest numbers of this type, as floats."""
    with np.errstate(over="ignore"):
        return np.asarray(values, number).astype(float)


def settings(number: type, count: int = SETTINGS, seed: int = 18) -> np.ndarray:
    """(SETS, 11, count * 8): settings of each lane; lane = setting * 8 + scenario."""
    draw = np.random.default_rng(seed)
    made = np.zeros((SETS, len(NAMES), count, len(SCENARIOS)))
    for s in range(count):
        for one in range(SETS):
            made[one, :, s, :] = np.array([_settings(draw, s + one, name) for name in SCENARIOS]).T
    for s in range(count):
        for k in range(len(SCENARIOS)):
            _spoil(made[SETS - 1, :, s, k], s * len(SCENARIOS) + k)
    return exact_in(number, made.reshape(SETS, len(NAMES), -1))


def _settings(draw: np.random.Generator, kind: int, scenario: str) -> list[float]:
    h = 10 ** draw.uniform(-2, 1)
    K = draw.choice([-1, 1]) * 10 ** draw.uniform(-1, 1)
    Ti = (h * 10 ** draw.uniform(0, 2.5), h * 10 ** draw.uniform(-0.5, 1), 0.0, np.inf)[
        min(kind % 10, 3) if kind % 5 else 0
    ]
    if scenario == "NaN":
        K = np.sign(K) * (10.0 if kind % 2 else 0.1)
    Td = 0.0 if kind % 3 == 0 else h * 10 ** draw.uniform(-1, 1)
    Tf = 0.0 if kind % 4 == 0 else h * 10 ** draw.uniform(-1, 1)
    Tt = (h * 10 ** draw.uniform(0, 2), 0.0, h * 0.6, np.inf, 0.0)[kind % 5]
    high = {"limits": 5.0, "automatic": 1000.0}.get(scenario, 60.0) * draw.uniform(0.5, 1.5)
    low, high = (-np.inf, np.inf) if scenario == "automatic" and kind % 6 == 0 else (-high, high)
    if scenario in ("reset", "bump") and kind % 2 == 0:
        low, high = (high / 10, high) if kind % 4 else (low, low / 10)
    rate = {"rate": 3.0 / h * draw.uniform(0.1, 1)}.get(scenario, (0.0, np.inf, 0.0, 40 / h)[kind % 4])
    b, c = draw.choice([0.0, 0.5, 1.0]), draw.choice([0.0, 0.0, 0.3, 1.0])
    return [K, Ti, Td, Tf, b, c, Tt, h, low, high, rate]


def _spoil(values: np.ndarray, kind: int) -> None:
    """One setting out of its range."""
    at = {name: i for i, name in enumerate(NAMES)}
    bad = [("K", 0), ("K", np.nan), ("Ti", -1), ("Td", -1), ("Td", np.inf), ("Tf", -1), ("Tf", np.nan), ("b", 1.5)]
    bad += [
        ("b", -0.5),
        ("c", 2),
        ("c", np.nan),
        ("h", 0),
        ("h", np.inf),
        ("rate", -1),
        ("u_low", np.inf),
        ("Ti", np.nan),
    ]
    name, value = bad[kind % len(bad)]
    values[at[name]] = value
    if kind % 17 == 16:
        values[at["Tt"]] = values[at["h"]] / 2


class Scenario:
    """Inputs in chunks, for one type of number: the largest numbers that appear depend on it."""

    def __init__(self, table: np.ndarray, number: type = float, seed: int = 2007):
        self.table, self.number, self.largest = table, number, float(np.finfo(number).max)
        lanes = table.shape[2]
        self.draw = np.random.default_rng(seed)
        self.author = ReferenceMachine(table, np.float64)
        self.kind = np.arange(lanes) % len(SCENARIOS)
        self.plant = self.draw.uniform(0.5, 0.95, lanes)
        self.gain = self.draw.uniform(0.3, 1.2, lanes) * np.sign(table[0, 0])
        self.y = np.zeros(lanes)
        self.state = {n: np.zeros(lanes) for n in ("y_sp", "ff", "u_manual", "manual", "index")}
        self.first, self.huge = True, np.zeros(lanes, bool)

    def _exact(self, values: np.ndarray) -> np.ndarray:
        return exact_in(self.number, values)

    def _on(self, name: str) -> np.ndarray:
        return self.kind == SCENARIOS.index(name)

    def _chance(self, often: float) -> np.ndarray:
        return self.draw.random(len(self.kind)) < often

    def _row(self) -> dict[str, np.ndarray]:
        draw, state, lanes = self.draw, self.state, len(self.kind)
        wild, lane = self._on("NaN"), np.arange(lanes)
        state["y_sp"] = np.where(self._chance(0.01), self._exact(draw.normal(0, 10, lanes)), state["y_sp"])
        state["ff"] = np.where(self._chance(0.01), self._exact(draw.normal(0, 2, lanes)), state["ff"])
        turn = self._chance(np.where(self._on("manual"), 0.02, np.where(self._on("bump"), 0.01, 0.001)))
        state["manual"] = np.where(turn, 1 - state["manual"], state["manual"])
        edge = np.where(self._chance(0.3), self.table[0, 9], self._exact(draw.normal(0, 20, lanes)))
        edge = np.where(self._chance(0.1), np.nan, np.where(np.isfinite(edge), edge, 0))
        state["u_manual"] = np.where(turn | self._chance(0.01), edge, state["u_manual"])
        change = self._chance(np.where(self._on("parameter change"), 0.02, 0.002) + 0.6 * self.huge)
        pick = draw.integers(1, SETS, lanes)
        state["index"] = np.where(change, (state["index"] + pick) % SETS, state["index"])
        self.author_refused(change)
        row = {n: a.copy() for n, a in state.items()}
        row["reset"] = (self._on("reset") & self._chance(0.05)).astype(float)
        row["start"] = (self._on("bump") & self._chance(0.1)).astype(float)
        row["power"] = (self._on("parameter change") & self._chance(0.02)).astype(float)
        row["y"] = self._exact(self.y + draw.normal(0, 0.05, lanes))
        h = self.table[state["index"].astype(int), 7, lane]
        options = np.array([0 * h, h, 0.4 * h, self._exact(3 * h) / 2, 1.6 * h, np.full(lanes, np.nan)])
        row["elapsed"] = self._exact(np.where(np.isfinite(h), options[draw.integers(0, 6, lanes), lane], 0))
        bad = wild & (self._chance(0.08) | (self.first & self._chance(0.5)))
        which, value = draw.integers(0, 3, lanes), draw.choice([np.nan, np.inf, -np.inf], lanes)
        huge = wild & ~bad & self._chance(0.2)
        row["start"] = np.where((huge | bad) & self._chance(0.35), 1.0, row["start"])
        size = draw.choice([0.95, -0.95, 0.3, -0.3, 0.01], lanes) * self.largest
        for i, name in enumerate(("y", "y_sp", "ff")):
            row[name] = np.where(bad & (which == i), value, np.where(huge & (which == i), size, row[name]))
        self.first, self.huge = False, huge
        return row

    def author_refused(self, change: np.ndarray) -> None:
        """A lane leaves refused settings for others than those in force: coming back to these is no change at all."""
        state, lanes = self.state, np.arange(len(self.kind))
        current = self.table[state["index"].astype(int), :, lanes].T
        same = np.all([current[i] == getattr(self.author.pid, n) for i, n in enumerate(NAMES)], axis=0)
        back = change & same & self.author.pid.refused
        state["index"] = np.where(back, (state["index"] + 1) % (SETS - 1), state["index"])

    def chunks(self, samples: int, size: int = 2000) -> Iterator[dict[str, np.ndarray]]:
        """The inputs, (size, lanes) at a time."""
        while samples > 0:
            rows = []
            with np.errstate(all="ignore"):
                for _ in range(min(size, samples)):
                    row = self._row()
                    rows.append(row)
                    u = self.author.sample(row)[0]
                    moved = self.plant * self.y + (1 - self.plant) * self.gain * np.where(np.isfinite(u), u, 0)
                    self.y = np.clip(moved, -1e6, 1e6)
            yield {n: np.array([row[n] for row in rows]) for n in INPUTS}
            samples -= size
