"""AMIGO in the form with the dead time and the lag, as published by Åström and Hägglund."""


def solve(n, own):
    T, L, Kp = n["T"], n["L"], n["Kp"]
    k = 0.15 / Kp + (0.35 - L * T / (L + T) ** 2) * T / (Kp * L)
    ti = 0.35 * L + 13 * L * T * T / (T * T + 12 * L * T + 7 * L * L)
    turned = 0.35 * T + 13 * T * L * L / (L * L + 12 * L * T + 7 * T * T)
    pid = [0.2 / Kp + 0.45 * T / (Kp * L), (0.4 * L + 0.8 * T) / (L + 0.1 * T) * L, 0.5 * L * T / (0.3 * L + T)]
    tau = L / (T + L)
    return {
        "tau": (tau, {"L / T": L / T, "T / (L + T)": 1 - tau}),
        "K": (k, {"Kp left out": k * Kp, "0.15 left out": k - 0.15 / Kp}),
        "Ti": (ti, {"0.35 L left out": ti - 0.35 * L, "T and L exchanged": turned}),
        "pid": (pid, {"Kp left out": [pid[0] * Kp, *pid[1:]], "Ti without its last L": [pid[0], pid[1] / L, pid[2]]}),
        "Kslow": (0.35 / n["Kv"] / n["wait"], {"L left out": 0.35 / n["Kv"]}),
        "Tslow": (13.4 * n["wait"], {"0.35 L in place of 13.4 L": 0.35 * n["wait"]}),
        "same": (("yes", "with T to infinity and Kp = Kv T they tend to nearly these"), {}),
        "b": (1 if own.get("tau", tau) > 0.5 else 0, {}),
        "changes": (
            (
                "the answer to the set-point",
                "the set-point enters the P part alone by its weight, the measurement as before",
            ),
            {},
        ),
    }
