"""The disturbance of the two tanks."""

from loopbook.process.transfer_function import Process


def tank_disturbance(process: Process) -> float:
    """The load step [u] that acts like a unit step at the inlet: 1 / static gain, as both pass the same path."""
    return 1 / process.static_gain
