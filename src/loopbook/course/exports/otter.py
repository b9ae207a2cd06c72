"""A master notebook for `otter assign`: a question for each answer, its tests hidden.

A weaker check, and it says so: a test runs in the student's own kernel, and passes or fails.
"""

from loopbook.course.exports.checks import check_of, key_of
from loopbook.course.exports.variants import WEAKER, Variant
from loopbook.course.notebooks import Cell, Content, code_cell, notebook, prose_cell


def otter(sheet: str, variant: Variant) -> Content:
    """The notebook."""
    cells: list[Cell] = [_raw("# ASSIGNMENT CONFIG\ninit_cell: true\nexport_cell: false\nfiles: []", "config")]
    cells += [prose_cell(WEAKER.format(sheet=sheet), "weaker"), code_cell("answers = {}", "answers")]
    cells += [{**cell, "metadata": {}} for cell in variant.intro]
    for _, cell, asked in variant.questions():
        cells.append({**cell, "metadata": {}})
        for one in asked:
            if not (lines := check_of(one)):
                continue
            name = one.name
            cells += [
                _raw(f"# BEGIN QUESTION\nname: {name}\npoints: {one.points:g}", f"begin-{name}"),
                prose_cell(f"`answers[{name!r}]`: {one.kind.wants()}", f"asks-{name}"),
                _raw("# BEGIN SOLUTION", f"begin-solution-{name}"),
                code_cell(f"answers[{name!r}] = {key_of(one)} # SOLUTION", f"solution-{name}"),
                _raw("# END SOLUTION", f"end-solution-{name}"),
                _raw("# BEGIN TESTS", f"begin-tests-{name}"),
                code_cell("# HIDDEN\n" + "\n".join(lines), f"tests-{name}"),
                _raw("# END TESTS", f"end-tests-{name}"),
                _raw("# END QUESTION", f"end-{name}"),
            ]
    return notebook(cells)


def _raw(text: str, id: str) -> Cell:
    return {"cell_type": "raw", "id": id, "metadata": {}, "source": text}
