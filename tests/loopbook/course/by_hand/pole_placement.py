"""The polynomial equation as two linear equations, taken at two values of z; the response by running the program."""

import math

import numpy as np


def solve(n, own):
    a, b = math.exp(-n["h"] / n["T"]), -n["Kp"] * math.expm1(-n["h"] / n["T"])
    T, h, Kp = n["T"], n["h"], n["Kp"]
    ab = own.get("ab", [a, b])
    wished = list(np.poly([n["pole"], n["slow"]]))
    p = own.get("wished", wished)

    def regulator(sign):
        rows, right = [], []
        for z in (0.3, 1.9):
            rows.append([ab[1] * z, ab[1]])
            right.append(np.polyval(p, z) - (z - ab[0]) * (z - sign))
        return np.linalg.solve(rows, right)

    s = own.get("s", list(regulator(1.0)))
    t0 = own.get("t0", s[0] + s[1])

    def run(t, samples=9):
        y, u, old, found = 0.0, 0.0, 0.0, []
        for _ in range(samples):
            u = u + t - s[0] * y - s[1] * old
            old, y = y, ab[0] * y + ab[1] * u
            found.append(y)
        return found

    found = regulator(1.0)
    return {
        "ab": ([a, b], {"backward Euler": [T / (T + h), Kp * h / (T + h)], "forward Euler": [1 - h / T, Kp * h / T]}),
        "wished": (wished, {"signs of the zeros": [1, -wished[1], wished[2]]}),
        "s": (list(found), {"sign of R's one": list(regulator(-1.0)), "b left out": list(found * ab[1])}),
        "t0": (s[0] + s[1], {"one over b": 1 / ab[1]}),
        "robust": (
            ("yes, as long as it is stable", "at rest the integrator makes T r = S y, whatever the process"),
            {},
        ),
        "y": (run(t0)[:6], {"one sample early": run(t0)[1:7], "the set-point weighted by s0": run(s[0])[:6]}),
    }
