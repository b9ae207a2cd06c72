"""--watch: what counts as a change."""

from pathlib import Path

from notebook_reports.build import watch


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


def test_what_the_process_holds_is_loaded_anew_and_a_derivation_is_not(bench):
    import notebook_reports.display

    assert watch._loaded(Path(watch.__file__)) and watch._loaded(Path(notebook_reports.display.__file__))
    assert watch._loaded(bench.project.notebooks_folder / "book.toml")
    assert not watch._loaded(bench.module("three.py", "X = 1\n"))
    assert not watch._loaded(bench.write("a/one", "# One"))


def test_the_outline_of_the_book_counts(bench):
    before = watch.snapshot(bench.project, ())
    outline = bench.project.notebooks_folder / "book.toml"
    outline.parent.mkdir(parents=True, exist_ok=True)
    outline.write_text('title = "Book"\n')
    assert watch.wait_for_change(bench.project, (), before) == [outline]
