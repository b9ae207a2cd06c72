"""`loopbook doctor`: what is wrong is said with its cure, and one question that breaks does not hide the others."""

from importlib import metadata

import pytest

from notebook_reports.build import doctor


def test_a_version_that_is_not_the_locked_one_is_named(bench):
    installed = metadata.version("sympy")
    lock = bench.root / "environment.txt"
    lock.write_text(f"sympy=={installed} \\\n    --hash=sha256:0\nno-such-package==1.0\n")
    assert doctor._locked(bench.project) == ("ok", "1 packages as locked")
    lock.write_text("sympy==0.1\n")
    verdict, found = doctor._locked(bench.project)
    assert verdict == "FAIL" and f"sympy {installed}, locked 0.1" in found and "make clean" in found


def test_a_missing_package_is_named(bench, monkeypatch):
    monkeypatch.setattr(doctor, "NEEDED", ("sympy", "no_such_package"))
    assert doctor._packages(bench.project) == ("FAIL", "missing: no_such_package; run make")


def test_a_question_that_breaks_is_a_failure_among_the_answers(bench, monkeypatch):
    def broken(_):
        raise OSError("no kernel today")

    for question in ("_kernel", "_typst"):
        monkeypatch.setattr(doctor, question, broken)
    answers = {question: (verdict, found) for verdict, question, found in doctor.examine(bench.project)}
    assert answers["kernel"] == ("FAIL", "OSError: no kernel today")
    assert answers["Python"][0] == answers["folders"][0] == "ok"


@pytest.mark.parametrize("free", [1e12, 1e8])
def test_the_disk_has_room_or_it_is_said_how_much_is_needed(bench, monkeypatch, free):
    monkeypatch.setattr(doctor.shutil, "disk_usage", lambda _: type("Usage", (), {"free": free}))
    verdict, found = doctor._disk(bench.project)
    assert (verdict == "ok") == (free > 5e8) and ("0.5 GB are needed" in found) == (free < 5e8)
