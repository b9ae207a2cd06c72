"""Thermostat by marching through the two exponentials in small steps; offsets by iterating the loop until it rests."""

import math


def solve(n, own):
    a = math.exp(-1e-5)  # one step is T/100000
    goal, low, high = n["gain"] * n["power"], n["wish"] - n["band"], n["wish"] + n["band"]

    def marched(start, end, target):
        steps, y = 0, start
        while (y < end) if end > start else (y > end):
            y, steps = target + a * (y - target), steps + 1
        return steps * 1e-5 * n["T"]

    up, down = marched(low, high, goal), marched(high, low, 0.0)
    error = n["wish"]
    for _ in range(4000):
        error += 0.02 * (n["wish"] - n["K"] * n["gain"] * error - error)
    return {
        "period": (up + down, {"heating alone": up, "cooling alone": down, "half the band": (up + down) / 2}),
        "share": (up / (up + down) * 100, {"the share of the cooling": down / (up + down) * 100}),
        "offset": (
            error,
            {
                "the temperature that is reached": n["wish"] - error,
                "1 in 1 + K Kp left out": n["wish"] / n["K"] / n["gain"],
            },
        ),
        "K10": ((1 / 0.1 - 1) / n["gain"], {"K Kp = 10": 10 / n["gain"]}),
        "held": (n["wish"] / n["gain"], {"K times the set-point": n["K"] * n["wish"]}),
        "gone": (("no", "without an error a P regulator gives no power"), {}),
    }
