"""Balances in litres, minutes and kilojoules, turned into seconds at the end."""

import math


def solve(n, own):
    per_second = n["flow"] / 60
    minutes = n["volume"] / n["flow"]
    radius = n["width"] / 2 / 100  # dm
    delay = math.pi * radius**2 * n["length"] * 10 / per_second
    heat = 4.19 * n["flow"] * (n["wish"] - n["inlet"])  # kJ/min
    power = own.get("P", heat / 60)
    return {
        "balance": (
            "P/(V*c*rho) + q*theta_0/V - q*theta/V",
            {
                "the inflow's heat left out": "P/(V*c*rho) - q*theta/V",
                "the sign of the flow's term": "P/(V*c*rho) + q*theta/V - q*theta_0/V",
            },
        ),
        "T": (minutes * 60, {"minutes for seconds": minutes, "upside down": 1 / minutes}),
        "L": (delay, {"the width for the radius": 4 * delay, "square, not round": delay * 4 / math.pi}),
        "P": (heat / 60, {"per minute": heat, "without the inlet": 4.19 * per_second * n["wish"]}),
        "gain": (
            (n["wish"] - n["inlet"]) / (heat / 60),
            {"temperature by power: the inlet counted": n["wish"] / power, "upside down": 4.19 * per_second},
        ),
        "halved": (("all three double", "the flow stands below the line in each of the three"), {}),
    }
