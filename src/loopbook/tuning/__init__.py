"""Tuning rules: one family, from data to settings.

>>> from loopbook.tuning import RULES, tune
>>> from loopbook.experiments.data import StepData
>>> round(tune(StepData(Kp=2, T=10, L=3), "amigo", "PID").K, 3)
0.85
>>> print(RULES["zn-step-pid"].text)
K = 1.2*T/(T_0*k)
T_i = 2*T_0
T_d = 0.5*T_0
"""

from loopbook.lazy import attach

TABLE = {
    "RULES": "loopbook.tuning.registry:RULES",
    "tune": "loopbook.tuning.by_name:tune",
    **{name: f"loopbook.tuning.result:{name}" for name in ("RuleDoesNotApply", "Tuning")},
    "UnknownRule": "loopbook.tuning.registry:UnknownRule",
    "ProcessData": "loopbook.tuning.process_data:ProcessData",
    **{name: f"loopbook.tuning.{name}" for name in ("by_angles", "filtered_data", "half_rule", "migo")},
}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
