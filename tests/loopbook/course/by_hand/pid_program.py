"""The program, run as it should be."""


def program(n, ys):
    i = d = y_old = 0.0
    us = []
    for y in ys:
        e = 1 - y
        i = i + n["K"] * n["h"] / n["Ti"] * e
        d = n["Td"] / (n["Td"] + n["N"] * n["h"]) * d - n["K"] * n["Td"] * n["N"] / (n["Td"] + n["N"] * n["h"]) * (
            y - y_old
        )
        us.append((e, i, d, n["K"] * e + i + d))
        y_old = y
    return us


FORMULAS = {2: "I + e*h*K/T_i", 3: "a*D + b*y_old - b*y", 4: "I + D + e*K", 5: "y"}


def solve(n, own):
    us = program(n, [0.0, 0.4, 0.65])
    d, u = us[2][2:]
    q0, q1 = n["K"] + n["K"] * n["h"] / n["Ti"], -n["K"]
    return {
        "u1": (us[0][3], {"P alone": n["K"], "K left out of I": n["K"] + n["h"] / n["Ti"]}),
        "u3": (u, {"D with the sign turned": u - 2 * d, "D left out": u - d}),
        "line": (n["slip"], {}),
        "corrected": (FORMULAS[n["slip"]], {}),
        "q": (
            [q0, q1],
            {"forward Euler": [n["K"], n["K"] * n["h"] / n["Ti"] - n["K"]], "sign of the second": [q0, n["K"]]},
        ),
    }
