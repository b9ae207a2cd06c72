"""Figures that take more than a few lines; a notebook says what to draw, not how.

>>> from loopbook.plots.curves import curves
>>> fig = curves({"output $y$": {"rise": ([0, 1], [0, 1])}}, "A title")
>>> fig.axes[0].get_xlabel()
'time $t$ [s]'
"""
