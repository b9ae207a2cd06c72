"""--watch: what counts as a change."""

from loopbook.pipeline import watch


def test_it_returns_with_what_changed_came_and_went(bench):
    one, two = bench.write("a/one", "# One"), bench.write("a/two", "# Two")
    before = watch.snapshot(bench.project, ())
    one.write_text(one.read_text().replace("One", "First"))
    two.unlink()
    three = bench.module("three.py", "X = 1\n")
    bench.write(".ipynb_checkpoints/one", "# One")
    bench.module("__pycache__/three.pyc", "")
    changed = watch.wait_for_change(bench.project, (), before)
    assert set(changed) >= {one, two, three}
    assert not any("__pycache__" in p.parts or ".ipynb_checkpoints" in p.parts for p in changed)
