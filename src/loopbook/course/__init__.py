"""Coursework: exercise sheets with numbers of each student's own, and a judge that says what a wrong answer is.

A sheet is a notebook whose `parameters` cell names what varies; two functions are the rest of what an author learns:

    from loopbook.course import answer, require

    require(0.1 < L / (L + T) < 0.7, "neither lag nor dead time alone decides")
    K = answer("K", pi.K, unit="%/°C", digits=3, points=2, wrong={"gain left out": pi.K * Kp})

`loopbook course` releases sheets to a class and grades what comes back; docs/teaching.md is a course in an afternoon.
"""

from loopbook.lazy import attach

TABLE = {"answer": "loopbook.course.asking:answer", "require": "loopbook.course.asking:require"}
__getattr__, __dir__, __all__ = attach(__name__, TABLE)
