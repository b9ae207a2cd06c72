"""No two things share a file, and the command that repeats a failure repeats all of it."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from notebook_reports.build.apply import items
from notebook_reports.build.build import options_of
from notebook_reports.build.job import Wanted
from notebook_reports.build.where import _suffix
from notebook_reports.project.failures import Failure, summary
from notebook_reports.project.project import UsageError

pytestmark = pytest.mark.builds

VALUE = st.one_of(
    st.none(), st.booleans(), st.integers(), st.floats(allow_nan=False), st.text(max_size=12), st.lists(st.integers())
)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        ({"s": "å"}, {"s": "ä"}),
        ({"s": ""}, {"s": "_"}),
        ({"s": "None"}, {"s": None}),
        ({"s": "a b"}, {"s": "a_b"}),
        ({"s": "1-t=2"}, {"s": "1", "t": "2"}),
        ({"s": "x" * 100}, {"s": "x" * 101}),
        ({"s": [1, 2]}, {"s": [1.0, 2]}),
    ],
)
def test_other_parameters_have_another_file(one, other):
    assert _suffix(one) != _suffix(other)
    assert all(len(_suffix(p).encode()) < 200 for p in (one, other))


@given(one=st.dictionaries(st.sampled_from("abc"), VALUE), other=st.dictionaries(st.sampled_from("abc"), VALUE))
def test_the_names_of_two_sets_of_parameters_are_equal_only_where_they_are(one, other):
    said = [{k: (type(v).__name__, repr(v)) for k, v in p.items()} for p in (one, other)]
    plain = [{k: str(v) for k, v in p.items()} for p in (one, other)]
    if said[0] != said[1] and plain[0] != plain[1]:
        assert _suffix(one) != _suffix(other)


def test_plain_values_are_read_in_the_name():
    assert _suffix({"q": 0.6, "h": -1, "kind": "PI"}) == "-q=0.6-h=-1-kind=PI"


def test_two_records_of_one_name_beside_each_other_get_reports_of_their_own(tmp_path):
    for name in ("r.csv", "r.toml"):
        (tmp_path / name).touch()
    made = items([tmp_path / "r.csv", tmp_path / "r.toml"], None, "design", ["pdf"])
    assert len({path for item in made for path in item.outputs.values()}) == 2


def test_two_notebooks_of_one_name_in_one_folder_are_refused(bench, tmp_path_factory):
    bench.write("a/b", "# T")
    paths = []
    for folder in ("one", "two"):
        path = tmp_path_factory.mktemp(folder) / "mine.ipynb"
        path.write_bytes((bench.root / "notebooks/a/b.ipynb").read_bytes())
        paths.append(str(path))
    with pytest.raises(UsageError, match=r"would both write .*mine\.html"):
        bench.build(*paths, output=bench.root / "out")


def test_every_failure_is_repeated_and_so_are_the_options():
    wanted = Wanted(("pdf",), timeout=30.5)
    again = options_of(wanted)
    failures = [Failure(f"a/n{i}", "broke", repeat=again(f"loopbook build a/n{i}")) for i in range(13)]
    failures.append(Failure("a/x", "broke", repeat=again("loopbook build a/x -p s 'two words'")))
    last = summary(failures)[-1]
    names = " ".join(f"a/n{i}" for i in range(13))
    options = "--timeout 30.5 --format pdf"
    assert last == f"Repeat: loopbook build {names} {options}; loopbook build a/x -p s 'two words' {options}"
    assert options_of(Wanted())("loopbook build a/b") == "loopbook build a/b"


def test_a_failure_of_a_build_is_repeated_with_its_options(bench):
    bench.write("a/b", "# T", "1 / 0")
    assert bench.build(timeout=7.0, formats=("ipynb",)).code == 1
    assert bench.said.rstrip().endswith("Repeat: loopbook build a/b --timeout 7 --format ipynb")


def test_a_build_elsewhere_leaves_the_projects_reports_alone(bench):
    bench.write("a/b", "# T", "1 + 1")
    assert bench.build(formats=("ipynb", "html")).code == 0
    before = {p: p.read_bytes() for p in (bench.root / "reports").rglob("*.*")}
    assert bench.build("a/b", force=True, output=bench.root / "out", formats=("ipynb",)).code == 0
    bench.write("a/b", "# T", "1 / 0")
    assert bench.build("a/b", output=bench.root / "out", formats=("ipynb",)).code == 1
    assert {p: p.read_bytes() for p in (bench.root / "reports").rglob("*.*")} == before and len(before) == 2
    bench.write("a/b", "# T", "1 + 1")
    bench.build(formats=("ipynb", "html"))
    assert bench.said == "1 notebook up to date\n"
