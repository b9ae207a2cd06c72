"""The batch of test processes behind AMIGO.

>>> from loopbook.documents.pid_report import batch
>>> len(batch.processes.batch())
133
"""

from loopbook.lazy import attach

MODULES = ("collected", "figures", "nearness", "processes", "robustness", "statements", "study")
TABLE = {name: f"loopbook.documents.pid_report.batch.{name}" for name in MODULES}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
