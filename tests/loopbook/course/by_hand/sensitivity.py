"""The margins from the circle's points by search; the loop by complex numbers; a regulator found by trying many."""

import cmath
import math

import numpy as np


def solve(n, own):
    r = 1 / n["goal"]
    angle = np.linspace(0, math.pi, 400001)
    circle = -1 + r * np.exp(1j * angle)
    crossing = circle[np.argmin(np.abs(np.abs(circle) - 1))]
    phi = math.degrees(abs(cmath.phase(-crossing)))
    nearest = 1 - r
    s = 1j * n["w"]
    process = n["Kp"] * cmath.exp(-s * n["L"]) / (1 + s * n["T"])
    loop = process * (n["K"] + n["K"] / (s * n["Ti"]))
    turn = math.degrees(cmath.phase(loop))
    turn -= 360 if turn > 0 else 0
    size, phase = own.get("size", abs(loop)), own.get("phase", turn)
    at = size * cmath.exp(1j * math.radians(phase))
    simc = (n["T"] / (n["Kp"] * 2 * n["L"]), min(n["T"], 8 * n["L"]))
    return {
        "Am": (1 / nearest, {"of Mt: 1 + 1/Mt": 1 + r}),
        "phi_m": (phi, {"2 left out": phi / 2, "degrees for radians": math.radians(phi)}),
        "size": (abs(loop), {"the process alone": abs(process), "the I part left out": abs(process) * n["K"]}),
        "phase": (
            turn,
            {
                "the dead time left out": turn + math.degrees(n["w"] * n["L"]),
                "degrees for radians": math.radians(turn),
            },
        ),
        "S": (1 / abs(1 + at), {"1 + |G0| below the line": 1 / (1 + size), "above the line": abs(1 + at)}),
        "tuned": ([0.92 * simc[0], 1.02 * simc[1]], {}),
    }
