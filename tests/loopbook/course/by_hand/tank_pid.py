"""Everything from the complex frequency response and bisection."""

import cmath
import math


def bisect(f, low, high):
    rising = f(high) > 0
    for _ in range(200):
        middle = (low + high) / 2
        low, high = (low, middle) if (f(middle) > 0) == rising else (middle, high)
    return low


def solve(n, own):
    T, L, Kp = n["T"], n["L"], n["Kp"]

    def turn(w, lags=2):
        return w * L - lags * cmath.phase(1 / (1 + 1j * w * T)) - math.pi

    w = bisect(turn, 1e-9, math.pi / L)
    single = bisect(lambda w: turn(w, 1), 1e-9, math.pi / L)
    at = own.get("w180", w)
    ku = abs(1 + 1j * at * T) ** 2 / Kp
    K = own.get("Ku", ku)
    tu = own.get("Tu", 2 * math.pi / at)
    share = n["factor"] * K
    c = bisect(lambda w: 1 - share * Kp / abs(1 + 1j * w * T) ** 2, 0.0, 1e5 / T)
    lags = 2 * cmath.phase(1 + 1j * c * T)
    margin, large = math.degrees(math.pi - c * L - lags), math.degrees(math.pi - lags)
    return {
        "w180": (w, {"one lag alone": single, "degrees for radians": math.degrees(w)}),
        "Ku": (ku, {"one lag alone": math.sqrt(ku * Kp) / Kp, "Kp left out": ku * Kp}),
        "Tu": (2 * math.pi / at, {"1 / w180": 1 / at}),
        "parallel": (
            [0.6 * K, 0.6 * K / (tu / 2), 0.6 * K * tu / 8],
            {"standard form": [0.6 * K, tu / 2, tu / 8], "K left out of the parts": [0.6 * K, 2 / tu, tu / 8]},
        ),
        "phi_m": (margin, {"the dead time left out": large, "degrees for radians": math.radians(margin)}),
        "left": (
            n["load"] * Kp / (1 + share * Kp),
            {"the loop left open": n["load"] * Kp, "as for the set-point": n["load"] / (1 + share * Kp)},
        ),
        "none": (("none", "at rest the error would move the integral on"), {}),
    }
