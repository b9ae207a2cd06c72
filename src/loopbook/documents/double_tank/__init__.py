"""double-tank: the Swedish laboratory report on two tanks with a transport delay.

>>> from loopbook.documents import double_tank
>>> double_tank.tank_load.exact_numbers(0.010, 0.004, 0.014, 0.002, 4180, 1000)[0]
Fraction(5, 1)
"""

from loopbook.lazy import attach

MODULES = ("diagrams", "long_fractions", "pole_proofs", "pole_tables", "tank_load", "tuner_figures", "tuner_frequency")
TABLE = {name: f"loopbook.documents.double_tank.{name}" for name in MODULES}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
