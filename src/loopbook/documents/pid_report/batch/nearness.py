"""How near AMIGO's constants are to those that fit the same formulas to the optima of the batch by least squares.

The rules are empirical: their constants agree with a source and are not derived. But what they imitate can be computed.
Each formula keeps its form; its constants become free and are chosen so that the sum of the squares of log(formula over
optimum) over the processes that the rule is meant for is smallest. Nothing is fed back into the rules.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from inspect import signature

import numpy as np
import sympy
from scipy.optimize import least_squares

from derivations.tuning import amigo
from derivations.tuning.letters import K_180, T_180, K_p, L, T, kappa
from derivations.tuning.rule import Rule
from loopbook.documents.pid_report.batch.study import OPTIMUM, MemberStudy
from loopbook.experiments.data import StepData

TINY = 1e-12  # instead of a setting that trial constants make negative
RULES: dict[str, Callable[..., Rule]] = {
    "PI step": amigo.pi_step,
    "PID step": amigo.pid_step,
    "PI frequency": amigo.pi_frequency,
    "PID frequency": amigo.pid_frequency,
}


@dataclass(frozen=True)
class Nearness:
    """One formula. own, fitted: its constants in print, in the order of `derivations.tuning.amigo`, and by the fit.
    off, off_fitted: root mean square of log(formula over optimum) with either. processes: how many were used.
    """

    rule: str
    setting: str
    own: tuple[sympy.Expr, ...]
    fitted: tuple[float, ...] = ()
    off: float = 0.0
    off_fitted: float = 0.0
    processes: int = 0


def nearness(studies: Sequence[MemberStudy]) -> Iterator[Nearness]:
    """One for each formula of the rules from a step and from one point of the frequency response.

    The processes are the stable ones for which the source calls the formula good (`Rule.good`).
    """
    stable = [s for s in studies if isinstance(s.step, StepData)]
    for name, rule in RULES.items():
        printed = {n: p.default for n, p in signature(rule).parameters.items()}
        for setting, constants in printed.items():
            measure, least = rule().good.get(setting, ("tau", 0))
            kept = [s for s in stable if getattr(s, measure) > least]
            letters = sympy.symbols(f"c:{len(constants)}")
            formula = getattr(rule(**{setting: letters}), setting)
            optimum = np.array([getattr(s.settings[OPTIMUM[name.split()[0]]], setting) for s in kept])
            yield _fit(Nearness(name, setting, constants), formula, letters, kept, optimum)


def _fit(
    own: Nearness, formula: sympy.Expr, letters: Sequence[sympy.Symbol], kept: Sequence[MemberStudy], best: np.ndarray
) -> Nearness:
    data = {K_p: "Kp", T: "T", L: "L", K_180: "K180", T_180: "T180", kappa: "kappa"}
    function = sympy.lambdify([*letters, *data], formula, "numpy")
    columns = [np.array([_datum(s, name) for s in kept]) for name in data.values()]

    def off(constants: np.ndarray) -> np.ndarray:
        return np.log(np.maximum(function(*constants, *columns), TINY) / best)

    start = np.array(own.own, float)
    found = least_squares(off, start, x_scale=start).x
    rms = [float(np.sqrt(np.mean(off(c) ** 2))) for c in (start, found)]
    return replace(own, fitted=tuple(map(float, found)), off=rms[0], off_fitted=rms[1], processes=len(kept))


def _datum(study: MemberStudy, name: str) -> float:
    if name == "kappa":
        return study.kappa
    return float(getattr(study.frequency if "180" in name else study.step, name))
