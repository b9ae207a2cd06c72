"""Seeded synthetic records: a true process, an input course, a sensor with its faults, a logger with its habits."""

import csv
import io
from dataclasses import dataclass, field
from datetime import datetime, timedelta
from pathlib import Path

import numpy as np
from processes import True_, recorded

NAMES = (
    ("Time [s]", "u", "y"),
    ("time", "Heater power", "Oven temperature"),
    ("Zeit [s]", "Stellgröße", "Istwert"),
    ("Tid (s)", "Styrsignal", "Ärvärde"),
    ("Czas [s]", "Sterowanie", "Temperatura pieca"),
    ("Tiempo (s)", "Entrada", "Salida"),
    ("t", "PWM controller", "Tank level"),
    ("time", "OP", "PV"),
    ("Zeit [s]", "Heizleistung [%]", "Ofentemperatur [°C]"),
    ("elapsed", "valve position", "Flow rate"),
)
SCALES = ((0.0, 100.0), (0.0, 1.0), (0.0, 10.0), (1241.0, 2482.0), (0.0, 255.0), (4.0, 20.0))
SHAPES = ("step", "step", "step", "up and down", "stairs", "doublet", "ramp", "long ramp", "random")
FAULTS = ("none", "none", "none", "glitch", "outliers", "cut", "off rest", "quantised", "second input", "two ways")
GUISES = (
    *("plain", "semicolon", "tab", "ms", "minutes", "time_ms", "date and time", "stamps", "midnight", "interval"),
    *(
        "comment head",
        "narrow head",
        "wide head",
        "preamble",
        "counter",
        "on off",
        "xlsx",
        "parquet",
        "library",
        "extra",
    ),
)


@dataclass
class Made:
    """A record on disk with what is true of it. told: options a user would give. noise, signal [y], long: in lags."""

    seed: int
    file: Path
    process: True_
    shape: str
    fault: str
    guise: str
    noise: float
    signal: float
    length: float
    quantum: float
    y_rest: float
    told: dict = field(default_factory=dict)

    @property
    def good(self) -> bool:
        """A record that has to be designed for."""
        return self.signal > 10 * self.noise and self.length >= 3

    def __str__(self) -> str:
        ratio = self.signal / max(self.noise, 1e-12)
        kinds = f"{self.shape}, {self.fault}, {self.guise}"
        return f"{self.seed}: {self.process}, {kinds}, noise 1:{ratio:.0f}, {self.length:.1f} lags"


def make(seed: int, folder: Path) -> Made:
    """The record of a seed; the same for the same seed."""
    r = np.random.default_rng(seed)
    dt = float(10 ** r.uniform(-2, 1.5))
    dt = float(f"{dt:.1g}")
    fault, guise, shape = (str(r.choice(options)) for options in (FAULTS, GUISES, SHAPES))
    low, high = SCALES[r.integers(len(SCALES))]
    if guise == "on off":
        low, high, shape = 0.0, 1.0, str(r.choice(["step", "up and down"]))
    n = int(r.integers(250, 700))
    process = _process(r, dt, n, (high - low), fault)
    if fault == "two ways":
        shape = "up and down"
    if fault in ("off rest",):
        shape = str(r.choice(["step", "up and down", "stairs"]))
    u, last = _course(r, shape, n, low, high, process, dt)
    other = np.zeros(n)
    if fault == "second input":
        other[int(n * r.uniform(0.4, 0.7)) :] = r.uniform(0.3, 1.0) * (high - low)
    clean = recorded(process, u, other, dt, 0.0)
    signal = float(np.ptp(clean))
    if fault == "off rest":
        clean = recorded(process, u, other, dt, float(r.choice([-1, 1]) * r.uniform(0.2, 0.6) * signal))
    ratio = float(10 ** r.uniform(0.7, 2.5))
    noise = signal / ratio
    y_rest = float(r.uniform(-1, 3) * signal)
    y = y_rest + clean + noise * r.standard_normal(n)
    quantum = 0.0
    if fault == "quantised":
        quantum = float(f"{signal / r.uniform(15, 80):.1g}")
        y = np.round(y / quantum) * quantum
    if fault == "glitch":
        y[0] = y_rest - 3 * signal
    if fault == "outliers":
        for k in r.integers(5, n - 5, 4):
            y[k] += r.choice([-1, 1]) * signal * r.uniform(2, 5)
    if fault == "cut" and not process.integrating and shape in ("step", "doublet", "stairs", "up and down"):
        if clean.max() > -clean.min():
            y = np.minimum(y, y_rest + 0.93 * clean.max())
        else:
            y = np.maximum(y, y_rest + 0.93 * clean.min())
    elif fault == "cut":
        fault = "none"
    length = (n - last) * dt / process.slowest
    made = Made(seed, folder / f"r{seed:03}.csv", process, shape, fault, guise, noise, signal, length, quantum, y_rest)
    _write(r, made, dt, u, y, other if fault == "second input" else None)
    return made


def _process(r, dt: float, n: int, span: float, fault: str) -> True_:
    kind = str(r.choice(["first", "first", "second", "second", "no delay", "integrating", "integrating lag"]))
    if fault in ("two ways", "off rest") or (span == 1.0 and kind.startswith("integrating")):
        kind = "first"  # a valve that is only open or closed cannot hold an integrating process
    record = n * dt
    lags = record / r.uniform(5, 25)
    lags = max(lags, 5 * dt)
    gain = float(r.choice([-1, 1, 1]) * 10 ** r.uniform(-1, 1)) / span * 10
    delay = lags * float(r.choice([0.1, 0.2, 0.4, 0.8])) if kind != "no delay" else 0.0
    delay = round(delay / (dt / 20)) * dt / 20
    if kind in ("first", "no delay"):
        slower = lags * r.uniform(1.6, 3.0) if fault == "two ways" else 0.0
        if slower and gain < 0:
            gain = -gain
        second = gain * r.uniform(0.2, 0.8) if fault == "second input" else 0.0
        return True_(gain, (lags,), delay, False, slower, second)
    second = gain * 0.4 if fault == "second input" else 0.0
    if kind == "second":
        share = r.uniform(0.2, 0.9)
        return True_(gain, (lags / (1 + share), lags * share / (1 + share)), delay, False, 0.0, second)
    rate = gain / lags
    second = rate * 0.4 if fault == "second input" else 0.0
    return True_(rate, (lags,) if kind == "integrating lag" else (), max(delay, 2 * dt), True, 0.0, second)


def _course(r, shape: str, n: int, low: float, high: float, process: True_, dt: float) -> tuple[np.ndarray, int]:
    """The input at the samples and where it moved last."""
    span = high - low
    a, b = low + 0.0 * span, low + float(r.choice([0.3, 0.5, 1.0])) * span
    if process.integrating or r.uniform() < 0.5:
        a, b = low + 0.4 * span, low + float(r.choice([0.55, 0.7, 0.8])) * span
    if {low, high} == {0.0, 1.0} and shape in ("step", "up and down"):
        a, b = low, high
    u = np.full(n, a)
    at = int(r.integers(15, 40))
    if shape == "step":
        u[at:] = b
        return u, at
    if shape == "up and down":
        back = at + (n - at) // 2
        u[at:back] = b
        return u, back
    if shape == "stairs":
        for i, k in enumerate((at, at + (n - at) // 4, at + (n - at) // 2)):
            u[k:] = a + (i + 1) / 3 * (b - a)
        return u, at + (n - at) // 2
    if shape == "doublet":
        width = max((n - at) // 6, 3)
        u[at : at + width], u[at + width : at + 2 * width] = b, (a - (b - a) / 2 if a > low else a + (b - a) / 4)
        return u, at + 2 * width
    if shape in ("ramp", "long ramp"):
        width = (n - at) // (6 if shape == "ramp" else 2)
        u[at : at + width] = a + (b - a) * np.arange(1, width + 1) / width
        u[at + width :] = b
        return u, at + width
    hold = max(int(process.slowest / dt / 2), 3)
    levels = np.repeat(r.choice([a, b], n // hold + 1), hold)[:n]
    levels[:at], levels[at : at + hold] = a, b
    return levels, at


def _write(r, made: Made, dt: float, u: np.ndarray, y: np.ndarray, other: np.ndarray | None) -> None:
    """The record as a logger of that guise writes it."""
    n, guise = len(u), made.guise
    t = np.round(np.arange(n) * dt, 9)
    names = list(NAMES[r.integers(len(NAMES))])
    columns = [[f"{v:.10g}" for v in t], [f"{v:.8g}" for v in u], [f"{v:.9g}" for v in y]]
    sep, comma = ",", False
    begin = (
        datetime(2024, 3, 9, 23, 59, 30) if guise in ("midnight", "date and time") else datetime(2025, 7, 1, 8, 0, 0)
    )
    stamps = [begin + timedelta(seconds=float(v)) for v in t]
    clock = [s.strftime("%H:%M:%S.%f") for s in stamps]
    before: list[str] = []
    if guise == "semicolon":
        sep, comma = ";", True
    elif guise == "tab":
        sep = "\t"
    elif guise in ("ms", "time_ms"):
        names[0], columns[0] = ("Time (ms)" if guise == "ms" else "time_ms"), [f"{1000 * v:.10g}" for v in t]
    elif guise == "minutes":
        names[0], columns[0] = "Time [min]", [f"{v / 60:.12g}" for v in t]
    elif guise == "date and time":
        names[:1], columns[:1] = ["Date", "Time"], [[s.strftime("%d.%m.%Y") for s in stamps], clock]
        sep = ";"
    elif guise == "stamps":
        names[0], columns[0] = "Timestamp", [s.strftime("%Y-%m-%dT%H:%M:%S.%f") for s in stamps]
    elif guise == "midnight":
        names[0], columns[0] = "Time", clock
    elif guise == "interval":
        names, columns = names[1:], columns[1:]
        made.told["interval"] = dt
    elif guise == "counter":
        names, columns = ["Index", *names], [[str(i) for i in range(n)], *columns]
    elif guise == "on off":
        names[1], columns[1] = "Heater", [("on" if v > 0 else "off") for v in u]
    elif guise == "library":
        names, columns = ["time", "Setpoint", "Input", "Output"], [columns[0], ["50"] * n, columns[2], columns[1]]
    elif guise == "extra":
        names, columns = [*names, "Ambient temperature"], [*columns, ["21.5"] * n]
    if other is not None:
        names, columns = [*names, "Pump 2"], [*columns, [f"{v:.8g}" for v in other]]
    if guise in ("preamble",):
        before = ["Plant 7, logger 3", "started by hand", ""]
    rows = [list(row) for row in zip(*columns, strict=True)]
    if guise in ("xlsx", "parquet"):
        return _sheet(made, names, columns)
    if comma:
        rows = [[cell.replace(".", ",") for cell in row] for row in rows]
    if guise == "wide head":
        names = [*names, ""]
    if guise == "narrow head":
        rows = [[str(i), *row] for i, row in enumerate(rows)]
    out = io.StringIO()
    out.write("".join(line + "\n" for line in before))
    if guise == "comment head":
        out.write("# " + sep.join(names) + "\n")
    writer = csv.writer(out, delimiter=sep, lineterminator="\n")
    writer.writerows(rows if guise == "comment head" else [names, *rows])
    made.file.write_text(out.getvalue(), encoding="utf-8")


def _sheet(made: Made, names: list[str], columns: list[list[str]]) -> None:
    import pandas as pd

    frame = pd.DataFrame({name: [float(v) for v in column] for name, column in zip(names, columns, strict=True)})
    made.file = made.file.with_suffix("." + made.guise)
    try:
        if made.guise == "xlsx":
            frame.to_excel(made.file, index=False)
        else:
            frame.to_parquet(made.file, index=False)
    except ImportError:
        made.file = made.file.with_suffix(".csv")
        made.guise = "plain"
        frame.to_csv(made.file, index=False)
