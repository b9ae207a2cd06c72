"""The letters of the tuning rules, and what each stands for.

Documents write the same quantity with different letters; a rule keeps those of its source, so that the formula shown
is the one in print. `QUANTITIES` says which are the same.
"""

import sympy as sp

k, T, T_0 = sp.symbols("k T T_0", positive=True)
"""First-order model with dead time, ``k exp(-s T_0)/(1 + s T)``: gain [y/u], time constant [s], dead time [s]."""
K_u, T_u = sp.symbols("K_u T_u", positive=True)
"""Ultimate gain [u/y] and ultimate period [s]: where a proportional loop oscillates without decay."""
lam = sp.Symbol("lambda", positive=True)
"""Wanted closed-loop time constant [s]; SIMC calls it tau_c."""
T_2 = sp.Symbol("T_2", positive=True)
"""Second time constant [s]."""
K_p, K_v, L = sp.symbols("K_p K_v L", positive=True)
"""AMIGO's letters: static gain [y/u], velocity gain [y/(u s)], dead time [s]; its time constant is T."""
K_180, T_180, kappa = sp.symbols("K_180 T_180 kappa", positive=True)
"""Gain [y/u] and period [s] where the phase is -180 degrees, and the gain ratio K_180/K_p."""
T_1, L_1, T_f = sp.symbols("T_1 L_1 T_f", positive=True)
"""The longer time constant and the dead time of the two-lag model, the time constant of a filter [s]."""
tau = sp.Symbol("tau", nonnegative=True)
"""Relative dead time L/(L + T), 0 to 1."""

a = k * T_0 / T
"""Normalised dead time times gain: how far the first-order response lags, in units of y/u."""

QUANTITIES = {
    **{k: "Kp", K_p: "Kp", K_v: "Kv", T: "T", T_0: "L", L: "L"},
    **{K_u: "Ku", T_u: "T180", K_180: "K180", T_180: "T180", kappa: "kappa"},
    **{T_1: "T1", T_2: "T2", L_1: "L1", tau: "tau", lam: "closed"},
}
"""Each letter's quantity, by the names of `loopbook.experiments.data`; `closed` is an option of the rule."""
