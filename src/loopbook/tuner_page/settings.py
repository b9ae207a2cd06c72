"""What the page begins with: a process and a regulator as its knobs stand, plain data.

state        the knobs, by the names of `js/ui/state.js`; what is left out stands as usual; "inf" is infinite
process      {num, den} of a process that no knob can make; the knob K then multiplies it
record       {t, u, y, u0, y0} of a step test, shown behind the model
names        {y, u}: what the axes are called
name         of the program that is written out
pins         [knobs] that differ from the state: settings that are pinned, the first of them the one before half-time
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from derivations.errors import LoopbookError
from loopbook.controllers.pid_forms import PidStandard
from loopbook.controllers.settings import PidSettings
from loopbook.process.transfer_function import Process
from loopbook.tuning.by_name import tune
from loopbook.tuning.result import RuleDoesNotApply

TOLD = 1e-9  # relative: what lags may leave of a denominator that they tell
MOST_POINTS = 1500
FIRST_TRIED = ("simc", "amigo", "zn-ultimate")


class TunerError(LoopbookError):
    """What a tuner's page cannot show; the message says which argument and what is expected."""


def settings(
    process: Process,
    regulator: Any = None,
    *,
    limits: tuple[float, float] | None = None,
    h: float = 0.0,
    steps: tuple[float, float] | None = None,
    uncertainty: Mapping[str, float] | None = None,
    record: Mapping[str, Sequence[float] | float] | None = None,
    names: Mapping[str, str] | None = None,
    poles: Mapping[str, float] | None = None,
    before: Any = None,
    wave: tuple[float, float] | None = None,
    name: str = "",
) -> dict[str, Any]:
    """The page's data.

    regulator: a PID form, a `Tuning`, `PidSettings`, a gain; None for SIMC's, or AMIGO's where that does not apply.
    limits: of u, as deviations. h [s]: sampling interval, 0 for none. steps: (set-point [y], load [u]), default 1 and
    half of what holds it. uncertainty: {"K", "T", "L"} in per cent. poles: {"speed", "damping", "rest", "observer"} of
    a pole placement [rad/s] in the place of a regulator; needs h. before: a regulator that runs until half-time,
    when it gets the settings of the other. wave: (amplitude [y], frequency [Hz]) of a sine on the measurement.
    Raises TunerError for a regulator of another kind.
    """
    knobs, given = _knobs(process)
    gain = process.static_gain if math.isfinite(process.static_gain) and process.static_gain else 1.0
    r, d = steps or (1.0, 0.5 / abs(gain))
    state: dict[str, Any] = {**knobs, "r": r, "d": d, "h": h}
    if poles is not None:
        state |= {"kind": "rst", **{key: float(value) for key, value in poles.items()}}
        if not h:
            raise TunerError("poles are placed for a sampled process: give h, the sampling interval [s]")
    else:
        state |= _settings(regulator if regulator is not None else _first(process))
    if isinstance(regulator, PidSettings):
        state["h"] = float(regulator.h)
        limits = limits or (float(regulator.u_low), float(regulator.u_high))
    if limits is not None:
        low, high = (float(x) if math.isfinite(x) else None for x in limits)
        state |= {"low": low, "high": high}
    if wave is not None:
        state |= {"wave": float(wave[0]), "freq": float(wave[1])}
    pins = []
    if before is not None:
        state |= {"jump": True, "smooth": True}
        pins = [{key: _plain(value) for key, value in _settings(before).items()}]
    for key, share in (uncertainty or {}).items():
        state[f"u{key}"] = round(float(share), 3)
    data: dict[str, Any] = {"state": {key: _plain(value) for key, value in state.items()}}
    more = {
        "process": given,
        "record": record and _thinned(record),
        "names": names and dict(names),
        "name": name,
        "pins": pins,
    }
    return data | {key: value for key, value in more.items() if value}


def _plain(value: Any) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return "inf" if value > 0 else "-inf"
    return value


def _knobs(process: Process) -> tuple[dict[str, Any], dict[str, list[float]] | None]:
    """The process as K, T1, T2, T3, Tz, L, integrating; or as polynomials where no knobs tell it."""
    num, den = np.array(process.num), np.array(process.den)
    integrates = len(den) > 1 and den[-1] == 0
    rest = den[:-1] if integrates else den
    if len(num) <= 2 and num[-1] and rest[-1] and len(rest) <= 4:
        lags = _lags(rest)
        if lags is not None:
            zero = float(num[0] / num[1]) if len(num) == 2 else 0.0
            times = dict(zip(("T1", "T2", "T3"), [*lags, 0.0, 0.0, 0.0], strict=False))
            gain = float(num[-1] / rest[-1])
            return {"K": gain, **times, "Tz": zero, "L": process.delay, "integrating": bool(integrates)}, None
    return {"K": 1.0, "L": process.delay}, {"num": num.tolist(), "den": den.tolist()}


def _lags(den: np.ndarray) -> list[float] | None:
    """The T of (T1 s + 1)(T2 s + 1)... times a constant, where they are real and tell the polynomial again."""
    roots = np.roots(den)
    if np.any(abs(roots.imag) > 1e-4 * abs(roots)):
        return None
    exact = sorted((-1 / roots.real).tolist(), key=abs, reverse=True)
    for times in ([float(f"{T:.4g}") for T in exact], exact):
        again = np.array([1.0])
        for T in times:
            again = np.polymul(again, [T, 1.0])
        if np.allclose(again * den[-1], den, rtol=TOLD, atol=0):
            return times
    return None


def _standard(regulator: Any) -> PidStandard:
    if isinstance(regulator, int | float):
        return PidStandard(float(regulator))
    if isinstance(regulator, PidSettings):
        Ti = math.inf if regulator.Ti is None else float(regulator.Ti)
        K, Td, b, c, Tf = (float(x) for x in (regulator.K, regulator.Td, regulator.b, regulator.c, regulator.Tf))
        return PidStandard(K, Ti, Td, b=b, c=c, Tf=Tf)
    form = regulator.as_built() if hasattr(regulator, "as_built") else regulator
    if not hasattr(form, "standard"):
        raise TunerError(
            f"{type(regulator).__name__} has no knobs: give a PID form (PidStandard, PidParallel, PidSeries), what "
            "tune gives, PidSettings, a gain, or poles="
        )
    standard: PidStandard = form.standard()
    return standard


def _settings(regulator: Any) -> dict[str, Any]:
    """The knobs of a regulator."""
    pid = _standard(regulator)
    return {"Kc": pid.K, "Ti": pid.Ti, "Td": pid.Td, "N": pid.N if pid.Td else 10.0, "b": pid.b, "c": pid.c}


def _first(process: Process) -> Any:
    """Settings to begin with."""
    for name in FIRST_TRIED:
        try:
            return tune(process, name)
        except RuleDoesNotApply:
            continue
    return 1.0


def _thinned(record: Mapping[str, Any]) -> dict[str, Any]:
    """A record of at most `MOST_POINTS` samples, six digits each; every sample at which the input moves is kept."""
    t, u, y = (np.asarray(record[key], dtype=float) for key in ("t", "u", "y"))
    keep = np.zeros(len(t), dtype=bool)
    keep[np.linspace(0, len(t) - 1, min(len(t), MOST_POINTS)).round().astype(int)] = True
    moves = np.flatnonzero(np.diff(u) != 0) + 1
    if len(moves) <= MOST_POINTS:
        keep[moves] = True
    rows = {key: [float(f"{x:.6g}") for x in row[keep]] for key, row in (("t", t), ("u", u), ("y", y))}
    return {**rows, "u0": float(record.get("u0", u[0])), "y0": float(record.get("y0", y[0]))}
