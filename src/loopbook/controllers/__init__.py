"""Controllers that run sample by sample: the discrete PID, on-off control.

All arithmetic is + - * / and comparison, so that floats and fractions both run.
"""

from loopbook.controllers.on_off import OnOff
from loopbook.controllers.pid import BadMeasurement, BadMeasurementWarning, Pid
from loopbook.controllers.settings import ANTI_WINDUP, PidSettings, SettingError

__all__ = [
    "ANTI_WINDUP",
    "BadMeasurement",
    "BadMeasurementWarning",
    "OnOff",
    "Pid",
    "PidSettings",
    "SettingError",
]
