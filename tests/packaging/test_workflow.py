"""The workflow: what it runs, with which rights, on which actions."""

import re
from pathlib import Path

import yaml

ROOT = Path(__file__).parents[2]
TEXT = (ROOT / ".github/workflows/ci.yml").read_text(encoding="utf-8")
WORKFLOW = yaml.safe_load(TEXT)


def test_it_runs_what_everybody_runs_and_nothing_else():
    commands = [step["run"] for job in WORKFLOW["jobs"].values() for step in job["steps"] if "run" in step]
    assert commands == ["bash .ci/run"]


def test_a_ledger_that_would_change_fails():
    script = (ROOT / ".ci/run").read_text(encoding="utf-8")
    assert "make FROZEN=1" in script and "git diff --exit-code --stat -- reports" in script
    assert "$(if $(FROZEN),--frozen)" in (ROOT / "Makefile").read_text(encoding="utf-8")


def test_no_right_but_reading_and_no_credentials_left_behind():
    assert WORKFLOW["permissions"] == {}
    assert all(job["permissions"] == {"contents": "read"} for job in WORKFLOW["jobs"].values())
    checkouts = [s for j in WORKFLOW["jobs"].values() for s in j["steps"] if "actions/checkout" in s.get("uses", "")]
    assert checkouts and all(step["with"]["persist-credentials"] is False for step in checkouts)


def test_an_action_is_named_by_its_commit_and_its_tag():
    used = re.findall(r"uses: (\S+)@(\S+) # (\S+)", TEXT)
    assert len(used) == TEXT.count("uses:") == 3
    assert all(
        re.fullmatch(r"[0-9a-f]{40}", commit) and re.fullmatch(r"v\d+\.\d+\.\d+", tag) for _, commit, tag in used
    )
