"""The locks, the targets, the example in the README."""

import re
import subprocess
import tomllib
from fnmatch import fnmatch
from pathlib import Path

import lock
import mutants
import pytest

ROOT = Path(__file__).parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))


def packages(name: str) -> set[str]:
    """The names in a lock."""
    return {re.match(r"[\w.-]+", entry).group() for entry in lock.entries(ROOT / name)}


def normal(requirement: str) -> str:
    return re.match(r"[\w.-]+", requirement).group().lower().replace("_", "-")


@pytest.mark.parametrize("name", lock.WANTED)
def test_every_package_is_pinned_with_hashes(name):
    entries = lock.entries(ROOT / name)
    assert len(entries) > (100 if name == lock.ENVIRONMENT else 0)
    for entry in entries:
        assert re.match(r"[A-Za-z0-9._-]+(\[[^]]*\])?==\S+", entry), entry.splitlines()[0]
        assert "--hash=sha256:" in entry, entry.splitlines()[0]


def test_every_direct_dependency_is_locked():
    extras, groups = PROJECT["project"]["optional-dependencies"], PROJECT["dependency-groups"]
    everywhere = {normal(n) for n in (*PROJECT["project"]["dependencies"], *extras["reports"], *extras["dev"])}
    assert everywhere <= packages("environment.txt")
    assert {normal(n) for n in groups["installer"]} == packages("tools/uv.txt")
    for name in ("interop", "browser", "prove"):
        assert {normal(n) for n in groups[name]} <= packages(f"locks/{name}.txt"), name
    for name in ("cluster", "records"):
        there = packages(f"locks/{name}.txt") | packages("environment.txt") | {"loopbook"}
        assert {normal(n) for n in extras[name]} <= there, name


def test_the_core_needs_four_packages_and_each_extra_is_locked_somewhere():
    assert sorted(PROJECT["project"]["dependencies"]) == ["matplotlib", "numpy", "scipy", "sympy"]
    words = " ".join(w for wanted in lock.WANTED.values() for w in wanted).split()
    extras = {e for e, needs in PROJECT["project"]["optional-dependencies"].items() if needs != ["loopbook[reports]"]}
    assert extras <= set(words)
    assert set(PROJECT["dependency-groups"]) <= set(words)


@pytest.mark.parametrize("name", [n for n in lock.WANTED if n.startswith("locks/")])
def test_a_lock_of_its_own_has_the_versions_of_the_environment_and_repeats_nothing(name):
    whole = lock.entries(ROOT / "environment.txt")
    versions = dict(re.match(r"([\w.-]+)==([^\s;]+)", entry).groups() for entry in whole)
    for entry in lock.entries(ROOT / name):
        package, version = re.match(r"([\w.-]+)==([^\s;]+)", entry).groups()
        assert versions.get(package, version) == version, package
        assert entry not in whole, package


def test_no_package_index_is_named():
    assert (ROOT / ".binder/requirements.txt").read_text(encoding="utf-8").strip() == "-r ../environment.txt"
    for name in (*lock.WANTED, "pyproject.toml", "Makefile", ".ci/run"):
        text = (ROOT / name).read_text(encoding="utf-8")
        assert not re.search(r"index-url|find-links|://", text), name
    for path in (ROOT / "tools").glob("*.py"):
        assert "://" not in path.read_text(encoding="utf-8"), path


def test_help_lists_every_target_with_a_line():
    shown = subprocess.run(["make", "help"], cwd=ROOT, capture_output=True, text=True, check=True).stdout
    listed = set(re.findall(r"^  make (\w+)", shown, re.M))
    assert {"all", "test", "doctor", "clean", "notebooks", "lock", "bench", "verify", "check"} <= listed


def test_the_readme_example_runs(capsys):
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```python\n(.*?)```", readme, re.S)
    exec(compile(example, "README.md", "exec"), {})
    Ms, iae = map(float, capsys.readouterr().out.split())
    assert 1.3 < Ms < 1.6 and iae > 0


def test_the_licences_are_said_alike_everywhere():
    assert PROJECT["project"]["license"] == "MIT AND CC-BY-4.0"
    for name in PROJECT["project"]["license-files"]:
        assert name in (ROOT / "tools/Dockerfile").read_text(encoding="utf-8")
    for name in ("README.md", "LICENSE-CONTENT", "docs/sources.md", "tools/docs_site/conf.py", "CITATION.cff"):
        text = (ROOT / name).read_text(encoding="utf-8")
        assert "MIT" in text and "CC BY 4.0" in text and "exercise sheets" in text, name


def test_no_folder_of_tests_is_left_out(request):
    """pytest passes over some names of folders without a word, such as `build`."""
    left_out = request.config.getini("norecursedirs")
    folders = {p.parent.relative_to(ROOT) for p in (ROOT / "tests").rglob("test_*.py")}
    assert [f for f in folders for name in f.parts if any(fnmatch(name, pattern) for pattern in left_out)] == []


@pytest.mark.long
def test_the_mutants_find_what_to_alter():
    values, constants = list(mutants.value_mutants(ROOT)), list(mutants.derivation_mutants(ROOT))
    assert {m.what.split(",")[0] for m in values} == {"double-tank", "pid-article", "pid-report"}
    assert len(values) > 500 and len(constants) > 500
