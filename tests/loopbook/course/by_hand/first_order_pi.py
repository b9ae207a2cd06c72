"""The rise from the step response on a fine grid; the loads by summing the response."""

import math

import numpy as np


def solve(n, own):
    Kp, T = n["Kp"], n["T"]
    K = own.get("K", T / n["closed"] / Kp)
    lag = T / (Kp * K)
    t = np.linspace(0, 6 * lag, 600001)
    y = 1 - np.exp(-t / lag)
    start, end = t[np.searchsorted(y, 0.1)], t[np.searchsorted(y, 0.9)]
    kz = (2 * n["zeta"] * n["w0"] * T - 1) / Kp
    k = own.get("Kz", kz)
    remains = 1 - K * Kp / (1 + K * Kp)
    return {
        "K": (T / n["closed"] / Kp, {"Kp left out": T / n["closed"], "upside down": Kp * n["closed"] / T}),
        "rise": (
            end - start,
            {
                "ln 10: from the start": end,
                "decimal logarithm": (end - start) * math.log10(math.e),
                "the time constant": lag,
            },
        ),
        "area": (T / K, {"1 / K": 1 / K, "Kp T / K": Kp * T / K}),
        "Kz": (kz, {"the process's own 1 left out": kz + 1 / Kp, "Kp left out": kz * Kp}),
        "Tz": (Kp * k / n["w0"] / n["w0"] / T, {"w0 not squared": Kp * k / n["w0"] / T}),
        "share": (100 * remains, {"the share that is reached": 100 - 100 * remains}),
        "cure": (
            (
                "only for a known gain and no load",
                "the factor belongs to one value of the gain, and a load moves the output all the same",
            ),
            {},
        ),
    }
