"""Experiments that tell what a tuning rule must know of a process, on simulated processes and on recorded data.

>>> from loopbook.experiments import Plant, relay
>>> from loopbook.process.transfer_function import Process
>>> found = relay.estimate(relay.apply_relay(Plant(Process([2], [40, 14, 1], 3))))
>>> round(found.data.Ku, 2), round(found.data.T180, 1)
(2.58, 19.8)
"""

from loopbook.lazy import attach

MODULES = (
    *("combination", "double_pulse", "integrating_step", "relay", "self_oscillation", "short_pulse", "sine", "step"),
    "two_points",
)
TABLE = {
    **{name: f"loopbook.experiments.{name}" for name in MODULES},
    **{name: f"loopbook.experiments.plant:{name}" for name in ("Estimate", "ExperimentError", "Plant")},
    **{
        name: f"loopbook.experiments.data:{name}"
        for name in ("FrequencyData", "IntegratingPulseData", "IntegratingStepData", "StepData", "TwoLagData")
    },
}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
