"""How robust the loops of the batch are, and how much of the possible integral gain the rules use."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from loopbook.controllers.pid_forms import LEFT_OUT
from loopbook.documents.pid_report.batch.study import MemberStudy, share_within
from loopbook.experiments.data import StepData
from loopbook.loop.joint_robustness import joint_M
from loopbook.tuning import migo
from loopbook.tuning.filtered_data import with_filter
from loopbook.tuning.registry import RULES as rules


def spread(values: np.ndarray) -> str:
    """Median, range and the part within 15 % of 1, as text for evidence.

    >>> spread(np.array([0.9, 1.0, 1.3]))
    'median 1, from 0.9 to 1.3, 67 % within 15 %'
    """
    low, middle, high = np.min(values), np.median(values), np.max(values)
    near = round(100 * share_within(values, 0.15))
    return f"median {middle:.3g}, from {low:.3g} to {high:.3g}, {near} % within 15 %"


def joint(studies: Sequence[MemberStudy], rule: str) -> np.ndarray:
    """The joint M of every loop with the settings of one rule or of an optimum; inf where it is unstable."""
    return np.array([joint_M(s.member.process, s.settings[rule].pid) for s in studies if rule in s.settings])


def joint_with_filter(studies: Sequence[MemberStudy], divisor: float = 10.0) -> dict[str, np.ndarray]:
    """The PID step rule on the stable processes: joint M and ki without filter, with it, and with adjusted data.

    The filter's time constant is Tf = Td/divisor of the unadjusted settings. Keys: "M", "M filter", "M adjusted", "ki"
    (adjusted over unadjusted).
    """
    found: dict[str, list[float]] = {"M": [], "M filter": [], "M adjusted": [], "ki": []}
    for s in studies:
        if isinstance(s.step, StepData):
            process, plain = s.member.process, rules["amigo-step-pid"](s.step)
            Tf = plain.Td / divisor
            adjusted = rules["amigo-step-pid"](with_filter(s.step, Tf))
            found["M"].append(joint_M(process, plain.pid))
            found["M filter"].append(joint_M(process, replace(plain.pid, N=LEFT_OUT, Tf=Tf)))
            found["M adjusted"].append(joint_M(process, replace(adjusted.pid, N=LEFT_OUT, Tf=Tf)))
            found["ki"].append(adjusted.ki / plain.ki)
    return {name: np.array(values) for name, values in found.items()}


def joint_with_optimal_Td(studies: Sequence[MemberStudy]) -> np.ndarray:
    """The joint M with K and Ti of the PID step rule and Td of PID MIGO."""
    pairs = [(s.member.process, s.settings["PID step"].pid, s.settings["PID MIGO"].Td) for s in studies]
    return np.array([joint_M(process, replace(pid, Td=Td, N=LEFT_OUT, Tf=0.0)) for process, pid, Td in pairs])


def ziegler_nichols_joint(studies: Sequence[MemberStudy]) -> np.ndarray:
    """The joint M of the Ziegler-Nichols PID step rule on the stable processes."""
    stable = [(s.member.process, s.step) for s in studies if isinstance(s.step, StepData)]
    return np.array([joint_M(process, rules["zn-step-pid"](step).pid) for process, step in stable])


def efficiency(studies: Sequence[MemberStudy], reached: np.ndarray) -> np.ndarray:
    """ki of the PI step rule over the largest ki that a PI regulator can have at the rule's own joint M, `reached`."""
    best = [migo.pi(s.member.process, float(M)).ki for s, M in zip(studies, reached, strict=True)]
    return np.array([s.settings["PI step"].ki for s in studies]) / np.array(best)
