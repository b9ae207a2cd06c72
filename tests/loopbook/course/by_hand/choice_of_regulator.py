"""The overshoot from the step response on a fine grid, the settling by bisection."""

import math

import numpy as np


def solve(n, own):
    z, w = n["zeta"], n["w0"]
    damped = w * math.sqrt(1 - z * z)
    t = np.linspace(0, 2 * math.pi / damped, 400001)
    y = 1 - np.exp(-z * w * t) * (np.cos(damped * t) + z * w / damped * np.sin(damped * t))
    top = int(np.argmax(y))

    def until(level):
        low, high = 0.0, 50 / (z * w)
        for _ in range(200):
            middle = (low + high) / 2
            above = math.exp(-z * w * middle) / math.sqrt(1 - z * z) > level
            low, high = (middle, high) if above else (low, middle)
        return low

    both = [2 * math.degrees(math.asin(1 / (2 * m))) for m in (n["Ms"], n["other"])]
    return {
        "overshoot": (100 * (y[top] - 1), {"damping below the line left out": 100 * math.exp(-math.pi * z)}),
        "peak": (t[top], {"of the undamped loop": math.pi / w, "a whole period": 2 * t[top]}),
        "settling": (until(0.02), {"5 % for 2 %": until(0.05), "zeta left out": z * until(0.02)}),
        "area": (n["Ti"] / n["K"], {"upside down": n["K"] / n["Ti"], "Ti left out": 1 / n["K"]}),
        "margins": (both, {"2 left out": [b / 2 for b in both]}),
        "taken": (
            (
                "A",
                "its curve stays further from the point that a doubled gain moves it to, and it leaves the noise alone",
            ),
            {},
        ),
        "safe": (
            (
                "yes" if 1 / (1 - 1 / n["other"]) > 2 else "no",
                "its gain margin is at least Ms / (Ms - 1), and no more is known",
            ),
            {},
        ),
    }
