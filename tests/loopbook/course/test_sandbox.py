"""The parts of the walls that can be looked at without building them, and the loop that judges a function."""

import json
import sys

import pytest

from loopbook.course.loops import with_integral_rule
from loopbook.course.sandbox import inside, walls, zygote
from loopbook.course.sandbox.limits import NotebookLimits


def test_only_plain_values_leave():
    told, functions = inside._answers(
        {
            "a": 1.5,
            "b": [1, "x", None, True],
            "c": float("nan"),
            "d": {1: 2},
            "e": len,
            5: 1.0,
            "f": 1 << 70,
            "g": object(),
        },
        [],
    )
    answers = told["answers"]
    assert {n: a["value"] for n, a in answers.items() if "value" in a} == {"a": 1.5, "b": [1, "x", None, True]}
    assert "nan is no number" in answers["c"]["refused"] and "kind dict" in answers["d"]["refused"]
    assert "too large" in answers["f"]["refused"] and "kind object" in answers["g"]["refused"]
    assert list(functions) == ["e"] and answers["e"] == {"function": "e"} and 5 not in answers
    assert inside._answers([], [])[0]["why"] == "a list" and inside._answers(None, [])[0]["why"] == "missing"
    assert inside._reply({"e": len}, {"call": "e", "arguments": [[1, 2]]}) == {"value": 2}
    assert "TypeError" in inside._reply({"e": len}, {"call": "e", "arguments": [1]})["refused"]
    json.dumps(told, allow_nan=False)


def test_a_folder_that_only_its_owner_may_enter_is_known(tmp_path):
    inner = tmp_path / "home" / "python"
    inner.mkdir(parents=True)
    (tmp_path / "home").chmod(0o700)
    closed = walls._closed(str(inner))
    assert closed and (closed[0] == str(tmp_path / "home") or tmp_path.is_relative_to(closed[0]))
    assert walls._closed("/usr") == []


def test_python_is_looked_for_under_every_name_it_has(tmp_path, monkeypatch):
    (tmp_path / "really").mkdir()
    (tmp_path / "link").symlink_to("really")
    monkeypatch.setattr(sys, "path", ["", str(tmp_path / "link"), str(tmp_path / "nowhere.zip"), "/"])
    found = zygote.python_folders()
    assert {str(tmp_path / "link"), str(tmp_path / "really"), sys.prefix, sys.base_prefix} <= set(found)
    assert not {"/", "", str(tmp_path / "nowhere.zip")} & set(found)
    assert walls.enterable("/") and not walls.enterable(str(tmp_path / "nowhere"))
    assert NotebookLimits(seconds=3).data()["seconds"] == 3


@pytest.mark.parametrize(("tracking", "overshoots"), [(True, False), (False, True)])
def test_tracking_is_told_from_winding_up(tracking, overshoots):
    def rule(I, v, u, e):
        return I + 2.3 * 0.5 / 12 * e + (0.5 / 6 * (u - v) if tracking else 0)

    told = {"K": 2.3, "h": 0.5, "gain": 1.2, "T": 12, "reference": 1.08 * 7.5, "limits": (0, 7.5), "samples": 144}
    assert bool(with_integral_rule(rule, **told).max() / (1.08 * 7.5) > 1.02) is overshoots
