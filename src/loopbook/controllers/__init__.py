"""Controllers that run sample by sample: the discrete PID, on-off control.

All arithmetic is + - * / and comparison, so that floats and fractions both run.
"""

from loopbook.lazy import attach

TABLE = {
    **{name: f"loopbook.controllers.pid:{name}" for name in ("BadMeasurement", "BadMeasurementWarning", "Pid")},
    **{name: f"loopbook.controllers.settings:{name}" for name in ("ANTI_WINDUP", "PidSettings", "SettingError")},
    "OnOff": "loopbook.controllers.on_off:OnOff",
}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
