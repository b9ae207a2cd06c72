"""SIMC as published; the largest sensitivity by looking at forty thousand frequencies."""

import numpy as np


def peak(gain, lag, delay, K, Ti):
    s = 1j * np.linspace(1e-3, 6, 400000) / delay
    return float(np.max(1 / np.abs(1 + gain * np.exp(-s * delay) / (lag * s + 1) * K * (1 + 1 / (Ti * s)))))


def solve(n, own):
    gain, lag, delay = own.get("Kp", n["K"]), own.get("T", n["T"]), own.get("L", n["L"])
    K, Ti = lag / gain / (delay + delay), min(lag, 4 * (delay + delay))
    used = own.get("K", K), own.get("Ti", Ti)
    Ms = peak(gain, lag, n["more"] * delay, *used)
    return {
        "Kp": (n["K"], {"not divided by the step": n["K"] * n["step"]}),
        "L": (n["L"], {}),
        "T": (
            n["T"],
            {
                "from the start of the step, dead time not taken off": n["T"] + n["L"],
                "95 % of the final value in place of 63 %": 3 * n["T"],
            },
        ),
        "K": (K, {"gain of the process left out": K * gain, "T + L in place of T": K + K * delay / lag}),
        "Ti": (Ti, {"T + L in place of T": lag + delay}),
        "law": (
            "u[k-1] + K*(1 + h/T_i)*e[k] - K*e[k-1]",
            {
                "forward Euler": "u[k-1] + K*e[k] - K*(1 - h/T_i)*e[k-1]",
                "the integral part alone": "u[k-1] + K*h*e[k]/T_i",
            },
        ),
        "Ms": (Ms, {"the dead time as it was": peak(gain, lag, delay, *used)}),
        "keeps": (
            (
                "yes" if own.get("Ms", Ms) < 1.8 else "no",
                "more dead time turns the phase further at the same gain",
            ),
            {},
        ),
    }
