"""A regulator for one's own process: every rule that applies, side by side, judged by the same exact numbers.

>>> from loopbook.design import Model
>>> from loopbook.design.candidates import candidates
>>> accepted, refused = candidates(Model(gain=2.0, lags=(10.0,), delay=3.0))
>>> accepted[0].name, refused[0].name
('Ziegler-Nichols step, PI', 'SIMC, PID')
"""

from loopbook.lazy import attach

TABLE = {
    "Study": "loopbook.design.study:Study",
    "Model": "loopbook.design.model:Model",
    "ModelError": "loopbook.design.model:ModelError",
    "read_model": "loopbook.design.model_file:read_model",
    "evaluate": "loopbook.design.evaluation:evaluate",
    "recommend": "loopbook.design.recommendation:recommend",
}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
