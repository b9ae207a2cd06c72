"""The edge where the characteristic roots reach the imaginary axis, by bisection on the gain."""

import math

import numpy as np


def edge(polynomial, Kp):
    def worst(K):
        moved = np.array(polynomial, float)
        moved[-1] += K * Kp
        roots = np.roots(moved)
        return roots[np.argmax(roots.real)]

    low, high = 0.0, 1.0
    while worst(high).real < 0:
        high *= 2
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if worst(middle).real < 0 else (low, middle)
    return low, abs(worst(low).imag)


def solve(n, own):
    T1, T2, T3, Kp = n["T1"], n["T2"], n["T3"], n["Kp"]
    whole = list(np.polymul(np.polymul([T1, 1], [T2, 1]), [T3, 1]))
    used = own.get("denominator", whole)
    gain, w = edge([*used[:3], 1.0], Kp)
    ku, tu = own.get("Ku", gain), own.get("Tu", 2 * math.pi / w)
    return {
        "denominator": (whole, {"the middle terms exchanged": [whole[0], whole[2], whole[1], whole[3]]}),
        "Ku": (gain, {"1 of 1 + K Kp left out": gain + 1 / Kp, "Kp left out": gain * Kp}),
        "Tu": (2 * math.pi / w, {"the frequency": w, "2 π left out": 1 / w}),
        "pid": (
            [0.6 * ku, 0.5 * tu, 0.125 * tu],
            {"those of a PI regulator": [0.45 * ku, tu / 1.2, 0.0], "Tu multiplied": [0.6 * ku, 2 * tu, 8 * tu]},
        ),
        "margin": (1 / n["share"], {"the share itself": n["share"]}),
        "lags": (("as before", "time alone is stretched, and the ultimate gain does not depend on its unit"), {}),
    }
