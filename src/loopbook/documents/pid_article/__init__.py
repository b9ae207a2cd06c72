"""pid-article: the Polish web article on the PID regulator.

>>> from loopbook.documents import pid_article
>>> sorted(pid_article.diagrams.LOOP.parts)[:2]
['actuator', 'comparison']
"""

from loopbook.lazy import attach

MODULES = ("c_program", "diagrams", "gain_scheduling", "manual_tuning", "saturated_gain")
TABLE = {name: f"loopbook.documents.pid_article.{name}" for name in MODULES}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
