"""The parabola by solving three equations; the line by its two ends."""

import numpy as np


def solve(n, own):
    area = n["low"] + n["growth"] * (n["level"] + n["level"] ** 2)
    kv = own.get("Kv", n["flow"] / area)
    points = [
        (x, round((n["low"] + n["growth"] * (x + x * x)) / (n["flow"] * n["closed"]), 4)) for x in (0.5, 1.0, 2.0)
    ]
    (x0, k0), _, (x2, k2) = points
    (xa, ka), (xb, kb) = points[:2] if n["level"] < 1 else points[1:]
    line = ka + (n["level"] - xa) / (xb - xa) * (kb - ka)
    parabola = np.linalg.solve([[x * x, x, 1.0] for x, _ in points], [k for _, k in points])
    return {
        "Kv": (
            n["flow"] / area,
            {"the surface at the bottom": n["flow"] / n["low"], "the surface multiplied": n["flow"] * area},
        ),
        "K": (1 / kv / n["closed"], {"Kv multiplied": kv / n["closed"]}),
        "between": (
            line,
            {
                "the nearest entry": min(points, key=lambda p: abs(p[0] - n["level"]))[1],
                "along the line from the first to the last": k0 + (n["level"] - x0) / (x2 - x0) * (k2 - k0),
            },
        ),
        "parabola": (list(parabola), {}),
        "slow": (1 / (k0 * kv), {"the time constant that was wished": n["closed"], "upside down": k0 * kv}),
        "jump": (n["step"] / 10, {"to the new value": n["step"] * 1.1}),
        "free": (
            ("inside", "the integral holds the value of u itself, which the gain then does not multiply"),
            {},
        ),
    }
