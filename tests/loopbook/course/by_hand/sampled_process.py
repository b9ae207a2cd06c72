"""Sampling by integrating the lag in a thousand small steps; the edge of stability by running the loop."""

import numpy as np


def solve(n, own):
    y, m = 0.0, 20000
    for _ in range(m):  # trapezoidal steps of the lag with u = 1
        y = (y * (1 - n["h"] / m / 2 / n["T"]) + n["h"] / m / n["T"]) / (1 + n["h"] / m / 2 / n["T"])
    a, b = 1 - y, n["Kp"] * y
    ab = own.get("ab", [a, b])
    run, x = [], 0.0
    for _ in range(6):
        x = ab[0] * x + ab[1]
        run.append(x)
    K, h = n["K"], n["h"]
    p, i, d = np.array([K, -K, 0]), np.array([K * h / n["Ti"], 0, 0]), K * n["Td"] / h * np.array([1, -2, 1])
    low, high = 0.0, 100.0
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if abs(ab[0] - ab[1] * middle) < 1 else (low, middle)
    d_ = n["d"]
    u = "u[k]" if d_ == 0 else f"u[k-{d_}]"
    less = "u[k]" if d_ == 1 else f"u[k-{d_ - 1}]"
    return {
        "ab": (
            [a, b],
            {
                "backward Euler": [n["T"] / (n["T"] + h), n["Kp"] * h / (n["T"] + h)],
                "forward Euler": [1 - h / n["T"], n["Kp"] * h / n["T"]],
                "gain one": [a, 1 - a],
            },
        ),
        "equation": (
            f"b*{u} + a*y[k]",
            {"one sample more": f"a*y[k] + b*u[k-{d_ + 1}]", "one sample less": f"a*y[k] + b*{less}"},
        ),
        "y": (run, {"one sample late": [0.0, *run[:5]], "b added without a": [ab[1] * j for j in range(1, 7)]}),
        "q": (list(p + i + d), {"the D part once": [K + K * h / n["Ti"] + d[0], -K - d[0], d[0]]}),
        "most": (low, {"(1 - a) / b": (1 - ab[0]) / ab[1], "1 / b": 1 / ab[1]}),
        "continuous": (
            (
                "for every positive gain",
                "one lag turns the phase by less than a quarter, holding adds half a sample of dead time",
            ),
            {},
        ),
    }
