"""Is there an alpha for which all residuals of pid-report's section 5.2.7 vanish?"""

from loopbook.experiments import combination, step
from loopbook.experiments.data import FrequencyData
from loopbook.experiments.plant import ExperimentError
from loopbook.loop.ultimate_point import ultimate
from loopbook.process.transfer_function import Process


def perfect_alpha(process: Process) -> tuple[float | None, str]:
    """T2/T1 of two lags and a dead time that have the step data and the ultimate point of a process, or None; and why.

    The experiments are exact. Where no such model exists the text says what refused it.
    """
    try:
        point = ultimate(process)
        model = combination.solve(step.step_data(process), FrequencyData(point.K180, point.T180))
    except ExperimentError as error:
        return None, str(error)
    return model.T2 / model.T1, ""
