"""What a tuning rule must know of the process before it can be asked."""

from enum import StrEnum


class Takes(StrEnum):
    """From the least experiment to the whole transfer function."""

    STEP = "step data"
    INTEGRATING_STEP = "step data of an integrating process"
    ONE_LAG = "one lag by the half rule"
    TWO_LAGS_OF_MODEL = "two lags by the half rule"
    FREQUENCY_AND_GAIN = "frequency data and the static gain"
    TWO_LAGS = "two lags from step and frequency data"
    PULSE = "pulse data of an integrating process"
    FREQUENCY = "frequency data"
    PROCESS = "a process"
