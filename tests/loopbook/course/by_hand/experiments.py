"""The frequency of -180 degrees by bisection on complex numbers; the relay by the Fourier integral of a square wave."""

import cmath
import math

import numpy as np


def solve(n, own):
    x = (np.arange(200000) + 0.5) * math.pi / 100000
    harmonic = float(np.mean(np.sign(np.sin(x)) * np.sin(x))) * 2 * n["d"]

    def process(w):
        return n["Kp"] * cmath.exp(-1j * w * n["L"]) / (1j * w * n["T"] + 1)

    low, high = 0.4 * math.pi / n["L"], math.pi / n["L"]
    for _ in range(80):
        middle = (low + high) / 2
        low, high = (middle, high) if process(middle).imag < 0 else (low, middle)
    w = low
    at = own.get("w180", w)
    size = abs(process(at))
    k180 = own.get("K180", size)
    relay = harmonic / n["peak"]
    return {
        "Kv": (n["slope"], {"not divided by the step": n["slope"] * n["du"]}),
        "Ku": (
            relay,
            {
                "peak to peak for the amplitude": relay / 2,
                "no first harmonic: d / a": n["d"] / n["peak"],
                "2 d for d": 2 * relay,
            },
        ),
        "w180": (
            w,
            {
                "the lag left out": math.pi / n["L"],
                "the lag as a quarter turn": math.pi / 2 / n["L"],
                "degrees for radians": w * 180 / math.pi,
            },
        ),
        "K180": (size, {"Kp left out": size / n["Kp"], "1 + w T for the root": n["Kp"] / (1 + at * n["T"])}),
        "K_u": (1 / k180, {"the magnitude itself": k180}),
        "kappa": (k180 / n["Kp"], {"upside down": n["Kp"] / k180}),
        "limit": (
            ("one", "at the low frequency where the dead time alone turns by a half, the lag takes nothing away"),
            {},
        ),
    }
