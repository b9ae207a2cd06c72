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


FILES = sorted((ROOT / ".github/workflows").glob("*.yml"))
ALL = [yaml.safe_load(f.read_text(encoding="utf-8")) for f in FILES]
STEPS = [step for flow in ALL for job in flow["jobs"].values() for step in job["steps"]]


def test_rights_are_given_by_job_and_the_jobs_that_run_a_change_have_none():
    assert all(flow["permissions"] == {} for flow in ALL)
    rights = {name: job["permissions"] for flow in ALL for name, job in flow["jobs"].items()}
    assert {name for name, given in rights.items() if given != {"contents": "read"}} == {
        "publish",
        "comment",
        "release",
    }
    for flow in ALL:
        if "pull_request" in flow[True]:  # YAML reads the word on as true
            assert all(job["permissions"] == {"contents": "read"} for job in flow["jobs"].values())
            assert "secrets." not in str(flow) and "github.token" not in str(flow)


def test_no_credentials_are_left_behind_and_no_text_of_a_change_is_pasted_into_a_command():
    checkouts = [step for step in STEPS if "actions/checkout" in step.get("uses", "")]
    assert checkouts and all(step["with"]["persist-credentials"] is False for step in checkouts)
    assert all("${{" not in step.get("run", "") for step in STEPS)


def test_the_comment_runs_nothing_of_the_change():
    (comment,) = [flow for name, flow in zip(FILES, ALL, strict=True) if name.stem == "comment"]
    commands = "\n".join(step.get("run", "") for job in comment["jobs"].values() for step in job["steps"])
    assert set(re.findall(r"[\w/]+\.(?:py|sh)", commands)) == {"tools/review_comment.py"} and "make" not in commands


def test_what_a_workflow_runs_exists_here():
    targets = set(re.findall(r"^([a-z-]+):", (ROOT / "Makefile").read_text(encoding="utf-8"), re.M))
    for step in STEPS:
        for target in re.findall(r"\bmake ([a-z][a-z-]*)", step.get("run", "")):
            assert target in targets, target
        for script in re.findall(r"tools/\w+\.py", step.get("run", "")):
            assert (ROOT / script).is_file(), script


def test_an_action_is_named_by_the_commit_of_its_tag():
    for file in FILES:
        for action, version, remark in re.findall(
            r"uses: ([^@\s]+)@(\S+)(?: # (.+))?", file.read_text(encoding="utf-8")
        ):
            assert re.fullmatch(r"[0-9a-f]{40}", version) and re.fullmatch(r"v\d+\.\d+\.\d+", remark), action
    assert sum(f.read_text(encoding="utf-8").count("uses:") for f in FILES) == sum("uses" in s for s in STEPS)


def test_a_review_builds_both_states_and_compares_their_pages():
    (review,) = [flow for name, flow in zip(FILES, ALL, strict=True) if name.stem == "review"]
    commands = [step["run"] for step in review["jobs"]["difference"]["steps"] if "run" in step]
    assert commands[0] == 'git worktree add ../base "$BASE" && make -C ../base'
    assert commands[1] == 'make difference REF="$BASE" OLD=../base/reports ACCEPT=1'
    recipe = (ROOT / "Makefile").read_text(encoding="utf-8").partition("\ndifference:")[2].partition("\n\n")[0]
    assert '--reports "$(OLD)" --pictures build/difference/pages' in recipe
