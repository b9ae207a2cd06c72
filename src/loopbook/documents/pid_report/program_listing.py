"""Programs as tables: what is computed when, and where it comes from."""

from typing import Any

from derivations.programs.pid_code import statement
from notebook_reports.display import Table


def listing(program: Any, caption: str = "") -> Table:
    """The assignments of a `derivations.programs.pid_code.Program` in the order they run, with equation numbers.

    caption: what the table is called; by default after the program's figure.
    """
    groups = (
        ("when a setting changes", program.gains),
        ("between y and u", program.before),
        ("after u is set", program.after),
    )
    rows = [[when, f"`{statement(a)}`", a.equation] for when, part in groups for a in part]
    caption = caption or f"The program of figure {program.figure}"
    return Table(["when", "assignment", "eq."], rows, caption, ["left"] * 3)
