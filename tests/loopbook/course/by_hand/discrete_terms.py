"""The alias by comparing samples of cosines; the filter by running it."""

import math

import numpy as np


def solve(n, own):
    h, k = n["h"], np.arange(400)
    seen = np.cos(2 * math.pi * n["hum"] * h * k)
    grid = np.linspace(0, 0.5 / h, 20001)
    candidates = [f for f in grid if abs(math.cos(2 * math.pi * f * h) - seen[1]) < 1e-2]
    alias = min(candidates, key=lambda f: np.abs(np.cos(2 * math.pi * f * h * k) - seen).sum())
    x, run = 0.0, []
    for _ in range(8):
        x += h / (n["Tf"] + h) * (1 - x)
        run.append(x)
    integral = sum(n["K"] * h / n["Ti"] * 1.0 for _ in range(20))
    tau = n["Td"] / n["N"]
    return {
        "seen": (alias, {"the remainder, not folded": math.fmod(n["hum"], 1 / h), "half the sampling rate": 0.5 / h}),
        "law": (
            "x[k-1] + h/(T_f + h)*(y[k] - x[k-1])",
            {
                "forward difference": "(1 - h/T_f)*x[k-1] + h/T_f*y[k]",
                "weights swapped": "(h*x[k-1] + T_f*y[k])/(h + T_f)",
            },
        ),
        "output": (
            run,
            {
                "the exact exponential": [1 - math.exp(-i * h / n["Tf"]) for i in range(1, 9)],
                "one sample late": [0.0, *run[:7]],
            },
        ),
        "I": (
            integral,
            {"h left out": integral / h, "K left out": integral / n["K"], "Ti multiplied": integral * n["Ti"] ** 2},
        ),
        "ab": (
            [tau / (tau + h), n["K"] * n["Td"] / (tau + h)],
            {"without the filter": [0.0, n["K"] * n["Td"] / h]},
        ),
    }
