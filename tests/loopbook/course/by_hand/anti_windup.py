"""The integral marched in time; its rest under tracking by iterating the recursion."""

import math


def solve(n, own):
    rate, jump = n["K"] * n["e"] / n["Ti"], n["K"] * n["e"]
    dt, t = 1e-3, 0.0
    while jump + rate * t < n["umax"]:
        t += dt
    reached = own.get("reached", t)
    integral, freed = rate * 4 * reached, 0.0
    while integral - jump - rate * freed > n["umax"]:
        freed += dt
    root = own.get("Tt", (n["Ti"] * n["Td"]) ** 0.5)
    rest = 0.0
    for _ in range(5000):
        wish = jump + rest
        rest += n["h"] * (rate + (min(wish, n["umax"]) - wish) / root)
    source = (
        "def next_integral(I, v, u, e):\n"
        f"    return I + {n['K']} * {n['h']} / {n['Ti']} * e + {n['h']} / {root!r} * (u - v)\n"
    )
    return {
        "reached": (t, {"the P part left out": t + n["Ti"], "K left out of I": n["Ti"] * (n["umax"] - jump) / n["e"]}),
        "freed": (freed, {"the P part's jump left out": freed + n["Ti"]}),
        "Tt": (math.sqrt(n["Ti"] * n["Td"]), {"the mean": (n["Ti"] + n["Td"]) / 2}),
        "rest": (rest, {"at the limit less the P part": n["umax"] - jump, "at the limit": n["umax"]}),
        "next_integral": (source, {}),
    }
