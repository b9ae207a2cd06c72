"""The studied batch as arrays over its processes, beside what pid-report prints of them."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from loopbook.documents.pid_report.batch import robustness as robust
from loopbook.documents.pid_report.batch.study import RULES, MemberStudy, Ratios, ratios
from notebook_reports.ledger.printed_data import PrintedDocument

BEYOND = 1 + 1e-9
"""A process on a border of the source, such as tau = 1/2 for T = L, counts as beyond it: rounding must not decide."""


class Batch:
    """The studied batch as arrays over its processes: tau, kappa, what derivative action gains, and by rule the
    settings over the optimum (`over`) and the joint M (`joint`). divisor: of the derivative time, for its filter."""

    def __init__(self, studies: Sequence[MemberStudy], printed: PrintedDocument, divisor: float = 10.0):
        self.divisor = divisor
        self.studies, self.said, self.values = tuple(studies), printed.claims.__getitem__, printed.values
        self.tau = np.array([s.tau for s in studies]) * BEYOND
        self.kappa = np.array([s.kappa for s in studies]) * BEYOND
        self.integrating = np.array([s.member.integrates for s in studies])
        self.lag, self.balanced = self.tau < 0.3, (self.tau > 0.4) & (self.tau < 0.6)
        self.middle, self.delay = (self.tau > 0.3) & (self.tau < 0.5), self.tau > 0.6

    @cached_property
    def over(self) -> dict[str, Ratios]:
        return {rule: ratios(self.studies, rule) for rule in RULES}

    @cached_property
    def joint(self) -> dict[str, np.ndarray]:
        return {rule: robust.joint(self.studies, rule) for rule in RULES}

    @cached_property
    def efficiency(self) -> np.ndarray:
        """ki of the PI step rule over the largest possible at its own joint M."""
        return robust.efficiency(self.studies, self.joint["PI step"])

    @cached_property
    def ziegler_nichols(self) -> np.ndarray:
        """The joint M of the Ziegler-Nichols PID step rule on the stable processes."""
        return robust.ziegler_nichols_joint(self.studies)

    @cached_property
    def filtered(self) -> dict[str, np.ndarray]:
        """The PID step rule with a derivative filter: `robustness.joint_with_filter` of the stable processes."""
        return robust.joint_with_filter(self.studies, self.divisor)

    def side(self, id: str, values: np.ndarray, limit: str) -> np.ndarray:
        """The processes that a statement speaks of: those on its side of its limit."""
        claim = self.said(id)
        distance = values - float(claim.number(limit))
        return distance > 0 if claim.agrees("side", 1) else distance < 0

    def as_printed(self, id: str, limit: str, value: str) -> bool:
        """Is the limit of a statement the number that the tables have for it?"""
        return self.said(id).number(limit) == self.values[value].fraction

    def range(self, id: str) -> np.ndarray:
        """The processes whose tau lies between the ends that a statement names."""
        low, high = (float(self.said(id).number(end)) for end in ("low", "high"))
        return (self.tau > low) & (self.tau < high)

    def gain(self, name: str) -> np.ndarray:
        """ki or K of PID MIGO over that of PI MIGO."""
        return np.array(
            [getattr(s.settings["PID MIGO"], name) / getattr(s.settings["PI MIGO"], name) for s in self.studies]
        )
