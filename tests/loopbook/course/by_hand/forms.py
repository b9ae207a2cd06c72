"""Forms compared at points of the s-plane; the poles by NumPy's roots."""

import math

import numpy as np


def solve(n, own):
    K, Ti, Td = n["K"], n["Ti"], n["Td"]
    zeros = np.sort(np.abs(np.roots([Ti * Td, Ti, 1])))
    slow, fast = 1 / zeros[0], 1 / zeros[1]
    gain = K * slow / Ti
    s = 1e9j
    high = abs(K * (1 + 1 / (Ti * s) + Td * s / (1 + s * Td / n["N"])))
    T, Kp = n["T"], n["Kp"]
    wished = np.polyadd(np.polymul([T, 1], [Ti, 0]), K * Kp * np.array([Ti, 1])) / (T * Ti)
    coefficients = own.get("characteristic", list(wished))
    w0 = math.sqrt(coefficients[2])
    used = own.get("w0", w0)
    return {
        "Ki": (K / Ti, {"1 / Ti": 1 / Ti, "K Ti": K * Ti}),
        "Kd": (K * Td, {"Td alone": Td}),
        "series": (
            [gain, slow, fast],
            {
                "the numbers of the standard form": [K, Ti, Td],
                "back from series to standard": [K + K * Td / Ti, Ti + Td, 1 / (1 / Ti + 1 / Td)],
            },
        ),
        "high": (high, {"K N": K * n["N"], "1 + N": 1 + n["N"], "K N Td": K * n["N"] * Td}),
        "characteristic": (
            list(wished),
            {
                "1 in 1 + K Kp left out": [1, K * Kp / T, K * Kp / T / Ti],
                "K left out of the I part": [1, (1 + K * Kp) / T, Kp / T / Ti],
            },
        ),
        "w0": (w0, {"no root drawn": coefficients[2]}),
        "zeta": (coefficients[1] / 2 / used, {"2 left out": coefficients[1] / used}),
    }
