"""What section 5.3 of pid-report says of its rules, tested on the batch: by claim, (parts, evidence) for the ledger.

The report uses words; here they have numbers. *Well* is within 15 % of the optimum, *fairly near* within 25 %, *nearly
all* is nine of ten processes, *most* is more than half. Lag-dominated is tau < 0.3, balanced 0.4 < tau < 0.6."""

from collections.abc import Mapping, Sequence
from typing import SupportsFloat

import numpy as np

from loopbook.documents.pid_report.batch import robustness as robust
from loopbook.documents.pid_report.batch.collected import Batch
from loopbook.documents.pid_report.batch.study import share_within
from notebook_reports.ledger.printed_data import Claim
from notebook_reports.ledger.verdicts import Truth

WELL, NEAR, NEARLY_ALL, FRAGILE = 0.15, 0.25, 0.9, 2.0
Statements = dict[str, tuple[Mapping[str, Truth] | Truth, str]]


def percent(share: SupportsFloat) -> str:
    return f"{100 * float(share):.0f} %"


def derivative(b: Batch) -> Statements:
    """Section 5.3.1: what derivative action is good for, and what it costs."""
    ki, K = b.gain("ki"), b.gain("K")
    fast = 11 * K  # K(1 + N) with a filter of N = 10, over K
    slow, even, late = ki[b.lag], ki[b.balanced], ki[b.delay]
    helps = b.said("derivative-helps-lags")
    much = np.median(ki[b.tau < 0.2])
    parts = {
        "the direction": all(helps.agrees("effect", x - 1) for x in ki),
        r"less than twice for $\tau > 0.6$": helps.agrees("rest", late.max() - 2),
        r"less than twice for balanced processes": helps.agrees("rest", even.max() - 2),
        r"more than five times for most with $\tau < 0.2$": helps.agrees("lag", much - 5),
    }
    ranges = f"{late.min():.2f} to {late.max():.2f} for tau > 0.6, up to {even.max():.2f} for balanced processes"
    return {
        "derivative-helps-lags": (parts, f"ki grows by {ranges}, {slow.min():.2f} to {slow.max():.3g} for tau < 0.3."),
        "derivative-raises-gains": (
            all(b.said("derivative-raises-gains").agrees("gains", x - 1) for x in (*K, *ki)),
            f"on all {len(ki)} processes: K at least {K.min():.3f} times, ki at least {ki.min():.3f} times",
        ),
        "pid-noise": (
            all(b.said("pid-noise").agrees("noise", x - 1) for x in fast),
            f"gain for fast noise K(1 + N), filter N = 10, over K of PI: {fast.min():.1f} to {fast.max():.3g} times",
        ),
    }


def derivative_filter(b: Batch) -> Statements:
    """Section 5.3.2: the PID step rule with a filter of Td/10, with and without adjusted data."""
    found = b.filtered
    mended = np.mean(found["M adjusted"] <= found["M filter"])
    less = 1 / found["M filter"] - 1 / found["M"]
    worse = np.mean([b.said("filter-costs-robustness").agrees("robustness", x) for x in less])
    parts = {
        "that of all": worse == 1,
        "that of most": worse > 0.5,
        "the adjusted data raise it again for most": mended > 0.5,
    }
    evidence = f"with the filter 1/M changes so on {percent(worse)} of the processes; adjusted data mend it on "
    return {
        "filter-costs-robustness": (parts, f"{evidence}{percent(mended)}."),
        "filter-costs-ki": (
            all(b.said("filter-costs-ki").agrees("damping", x - 1) for x in found["ki"]),
            f"adjusted ki over unadjusted: {found['ki'].min():.3f} to {found['ki'].max():.3f}",
        ),
    }


def pi_step(b: Batch) -> Statements:
    """Section 5.3.3: the PI step rule."""
    r, M = b.over["PI step"], b.joint["PI step"]
    parts = {
        "all $K$ well": share_within(r.K, WELL) == 1,
        "all $T_i$ well": share_within(r.Ti, WELL) == 1,
        "nearly all fairly near": min(share_within(r.K, NEAR), share_within(r.Ti, NEAR)) >= NEARLY_ALL,
    }
    evidence = f"K: {robust.spread(r.K)}; Ti: {robust.spread(r.Ti)}; joint M from {M.min():.2f} to {M.max():.2f}."
    return {"pi-step-agrees": (parts, evidence)}


def _follows(values: np.ndarray, as_printed: bool) -> tuple[dict[str, bool], str]:
    within = {"nearly all fairly near": NEAR, "nearly all well": WELL}
    parts = {name: share_within(values, width) >= NEARLY_ALL for name, width in within.items()}
    return parts | {"the limit in print": as_printed}, f"{len(values)} processes: {robust.spread(values)}."


def _on_one_side(outside: Sequence[bool], values: np.ndarray, elsewhere: bool) -> tuple[dict[str, bool], str]:
    share = float(np.mean(outside))
    parts = {"most": share > 0.5, "nearly all": share >= NEARLY_ALL, "where it is not good": elsewhere}
    return parts, f"{percent(share)} of {len(values)} processes: {robust.spread(values)}."


def pid_step(b: Batch) -> Statements:
    """Section 5.3.4: where K, Ti and Td of the PID step rule are good, too low or too high."""
    r = b.over["PID step"]
    K, Ti, Td = (b.said(f"pid-{name}-good") for name in ("K", "Ti", "Td"))
    good = {name: b.side(claim.id, b.tau, "tau") for name, claim in (("K", K), ("Ti", Ti), ("Td", Td))}
    rest = {name: _elsewhere(b, id, limit) for name, id, limit in (("K", "pid-K-low", K), ("Ti", "pid-Ti-high", Ti))}
    off = {
        "K": [b.said("pid-K-low").agrees("K", x - 1) for x in r.K[rest["K"]]],
        "Ti": [b.said("pid-Ti-high").agrees("Ti", x - 1) for x in r.Ti[rest["Ti"]]],
    }
    Td_there, half = r.Td[b.side("pid-Td-either", b.tau, "tau")], r.Td[b.range("pid-Td-half")]
    apart = {n: not (rest[n] & good[n]).any() for n in rest}
    limits = {n: b.as_printed(f"pid-{n}-good", "tau", f"pid-good-{n}") for n in good}
    ranges = b.range("pid-Td-half"), b.range("pid-Td-robustness"), b.side("pid-Td-either", b.tau, "tau")
    one_range, beside = (ranges[0] == ranges[1]).all(), not (ranges[0] & ranges[2]).any()
    ways = [b.said("pid-Td-either").text(way) for way in ("one", "other")]
    either = f"{percent(np.mean(Td_there < 1))} smaller, {percent(np.mean(Td_there > 1))} larger; "
    extreme = half.min() if b.said("pid-Td-half").agrees("Td", -1) else 1 / half.max()
    return {
        "pid-K-good": _follows(r.K[good["K"]], limits["K"]),
        "pid-K-low": _on_one_side(off["K"], r.K[rest["K"]], apart["K"]),
        "pid-Ti-good": _follows(r.Ti[good["Ti"]], limits["Ti"]),
        "pid-Ti-high": _on_one_side(off["Ti"], r.Ti[rest["Ti"]], apart["Ti"]),
        "pid-Td-good": _follows(r.Td[good["Td"]], limits["Td"]),
        "pid-Td-half": (
            {"half": extreme < 0.5, "the range of both statements": one_range},
            f"{len(half)} processes: {robust.spread(half)}",
        ),
        "pid-Td-either": (
            {way: any(b.said("pid-Td-either").agrees(way, x - 1) for x in Td_there) for way in ("one", "other")}
            | {"two ways": ways[0] != ways[1], "beside the range": beside},
            either + robust.spread(Td_there),
        ),
    }


def _elsewhere(b: Batch, id: str, good: Claim) -> np.ndarray:
    """The processes that "for smaller tau" means after a statement that named a limit."""
    distance = b.tau - float(good.number("tau"))
    return distance > 0 if b.said(id).agrees("side", 1) else distance < 0


def pid_step_robustness(b: Batch) -> Statements:
    """Section 5.3.4: the short derivative time, and whether the rule is conservative."""
    r, ki = b.over["PID step"], b.gain("ki")
    middle, said = b.range("pid-Td-robustness"), b.said("pid-conservative-below")
    inside = [s for s, yes in zip(b.studies, middle, strict=True) if yes]
    rule, best = b.joint["PID step"][middle], robust.joint_with_optimal_Td(inside)
    worse = np.mean(
        [b.said("pid-Td-robustness").agrees("robustness", 1 / m - 1 / n) for m, n in zip(rule, best, strict=True)]
    )
    there = b.side(said.id, b.tau, "tau")
    lower = np.array([said.agrees("K", x - 1) and said.agrees("K", y - 1) for x, y in zip(r.K, r.ki, strict=True)])
    longer = np.array([said.agrees("Ti", x - 1) for x in r.Ti])
    kinds = {r"$\tau < 0.3$": there & b.lag, r"$\tau > 0.3$": there & ~b.lag}
    most = {name: [np.mean(x[k]) if k.any() else 0.0 for x in (lower, longer)] for name, k in kinds.items()}
    parts = {name: min(shares) > 0.8 for name, shares in most.items()}
    parts["the limit in print"] = b.as_printed(said.id, "tau", "pid-conservative")
    good = b.said("pid-good-where-not-needed")
    late, slow = r.ki[b.tau > 0.5], r.ki[b.lag]
    gains = np.median(ki[b.tau > 0.5]), np.median(ki[b.lag])
    medians = f"median {np.median(rule):.2f} against {np.median(best):.2f}"
    shares = "; ".join(f"{name}: K and ki so on {percent(x)}, Ti on {percent(y)}" for name, (x, y) in most.items())
    return {
        "pid-Td-robustness": (
            {"on most": worse > 0.8, "the range of both statements": (middle == b.range("pid-Td-half")).all()},
            f"1/M differs so between the rule's Td and MIGO's on {percent(worse)} of {len(inside)}, M: {medians}",
        ),
        "pid-conservative-below": (parts, f"{there.sum()} processes, {shares}."),
        "pid-good-where-not-needed": (
            {
                "good there": share_within(late, WELL) >= NEARLY_ALL,
                "the grade for lags": good.agrees("grade", share_within(slow, WELL) - share_within(late, WELL)),
                "what derivative action adds there": good.agrees("rest", gains[0] - 2),
                "what it adds for lags": good.agrees("lag", gains[1] - 4 * gains[0]),
            },
            f"ki for tau > 0.5: {robust.spread(late)}, derivative action adds a factor {gains[0]:.2f}; for tau < 0.3: "
            f"{robust.spread(slow)}, a factor {gains[1]:.1f} (medians)",
        ),
    }


def frequency(b: Batch, rule: str) -> Statements:
    """Sections 5.3.5 and 5.3.6: rule is "PI frequency" or "PID frequency"."""
    r, M, slug = b.over[rule], b.joint[rule], rule.lower().replace(" ", "-")
    fit, limit = b.side(f"{slug}-near", b.kappa, "kappa"), (f"{slug}-near", "kappa", f"{slug}-kappa")
    names = ("K", "Ti", "Td") if rule.startswith("PID") else ("K", "Ti")
    near = {name: share_within(getattr(r, name)[fit], NEAR) for name in names}
    parts = {f"{name} fairly near for nearly all": share >= NEARLY_ALL for name, share in near.items()}
    worst, fragile = M[fit].max(), np.mean(M[b.lag] > FRAGILE)
    shares = ", ".join(f"{name} {percent(share)}" for name, share in near.items())
    K, tanks = [s.settings[rule].K for s in b.studies if s.member.integrates], M[b.integrating]
    possible = {
        "cannot be evaluated": not np.isfinite(K).all(),
        "should not be used (joint M above 2)": tanks.min() > FRAGILE,
    }
    return {
        f"{slug}-near": (
            parts | {"joint M below 2": worst < FRAGILE, "the limit in print": b.as_printed(*limit)},
            f"within 25 % of MIGO, {fit.sum()} processes of that kappa: {shares}; joint M up to {worst:.2f}.",
        ),
        f"{slug}-unfit": (
            fragile > 0.5,
            f"joint M above 2 on {percent(fragile)} of the processes with tau < 0.3; {np.isinf(M).sum()} are unstable",
        ),
        f"{slug}-integrating": (
            possible,
            f"kappa = 0 gives settings; joint M is {tanks.min():.2f} at best, {np.isinf(tanks).sum()} of {len(tanks)} "
            "loops are unstable.",
        ),
    }


def combined(b: Batch) -> Statements:
    """Section 5.3.7.1: the combined rule beside the two others."""
    c, r, f = (b.over[rule] for rule in ("PID combined", "PID step", "PID frequency"))
    late = b.tau > 0.4  # balanced and more
    names = ("K", "Ti", "Td", "ki")
    like = {p: min(share_within(getattr(c, p)[late] / getattr(o, p)[late], NEAR) for o in (r, f)) for p in names}
    closer = abs(np.log(r.ki[b.lag])) - abs(np.log(c.ki[b.lag]))
    nearer = np.mean([b.said("combined-better").agrees("nearness", x) for x in closer])
    models = sum(abs(s.missed) < 1e-6 and not s.member.integrates for s in b.studies)
    return {
        "combined-similar": (
            {f"{name} of nearly all": share >= NEARLY_ALL for name, share in like.items()},
            f"within 25 % of both other rules, {late.sum()} processes with tau > 0.4: "
            + ", ".join(f"{name} {percent(share)}" for name, share in like.items())
            + ".",
        ),
        "combined-better": (
            nearer > 0.7 and share_within(c.ki[b.lag], NEAR) > 2 * share_within(r.ki[b.lag], NEAR),
            f"tau < 0.3: so is the distance of ki from the optimum on {percent(nearer)}; "
            f"{robust.spread(c.ki[b.lag])}, step rule: "
            f"{robust.spread(r.ki[b.lag])} ({models} of {(~b.integrating).sum()} have an exact two-lag model)",
        ),
    }


def whole(b: Batch) -> Statements:
    """Sections 5.3 and 6: does AMIGO maximise ki, and how does Ziegler-Nichols compare?"""
    share, zn = b.efficiency, b.ziegler_nichols
    worst = {rule: b.joint[rule].max() for rule in ("PI step", "PID step", "PID combined")}
    pi, pid = b.over["PI step"].ki, b.over["PID step"].ki
    parts = {
        "PI: within 15 % of the largest $k_i$ at the robustness it reaches": share.min() >= 1 - WELL,
        "nearly all within 15 % of the $k_i$ of MIGO": min(share_within(x, WELL) for x in (pi, pid)) >= NEARLY_ALL,
    }
    used = f"{percent(share.min())} to {percent(share.max())}"
    return {
        "amigo-maximises-ki": (
            parts,
            f"PI: {used} of the possible ki at its own M; ki over that of MIGO, PI: {robust.spread(pi)}, "
            f"PID: {robust.spread(pid)}.",
        ),
        "zn-shortcomings": (
            zn.min() > FRAGILE,
            f"joint M of its PID step rule: {zn.min():.2f} to {zn.max():.2f} on {len(zn)} stable processes; AMIGO "
            f"stays below {max(worst.values()):.2f}",
        ),
        "simple-experiments": (
            max(worst.values()) < FRAGILE < zn.min(),
            f"all loops stable; largest joint M: {', '.join(f'{name} {M:.2f}' for name, M in worst.items())}",
        ),
    }
