"""Exports in the hands of the real nbgrader and otter: released, answered right and wrong, graded.

    python tests/loopbook/course/interop/prove_interop.py      (make interop)

Right answers get all points, wrong ones none, and the student's version holds no key.
"""

import csv
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).parents[4]
SHEET = ROOT / "notebooks" / "exercises" / "forms.ipynb"
BIN = Path(sys.executable).parent
NBGRADER_CONFIG = """c = get_config()
c.CourseDirectory.course_id = 'course'
c.ClearSolutions.code_stub = {'python': 'answers = {}'}
"""


def run(*words: str, cwd: Path) -> str:
    """The command's output; its failure ends the proof."""
    env = {**os.environ, "PATH": f"{BIN}{os.pathsep}{os.environ['PATH']}", "JUPYTER_NO_CONFIG": "1"}
    done = subprocess.run([str(w) for w in words], cwd=cwd, env=env, capture_output=True, text=True, timeout=600)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}: {done.stdout[-2000:]}\n{done.stderr[-3000:]}")
    return done.stdout


def export(form: str, folder: Path) -> Path:
    run(BIN / "loopbook", "course", "export", SHEET, "--format", form, "-o", folder, "--variants", "1", cwd=folder)
    return folder / "forms" / "forms.ipynb"


def source(cell: dict) -> str:
    return "".join(cell["source"])


def keys(path: Path) -> dict:
    """The answers of the exported master, by running its solution."""
    space: dict = {"answers": {}}
    for cell in json.loads(path.read_text())["cells"]:
        text = source(cell)
        if cell["cell_type"] == "code" and ("# SOLUTION" in text or "BEGIN SOLUTION" in text):
            exec(text, space)
    return space["answers"]


def wrong(value):
    return (
        value * 1.5 + 1
        if isinstance(value, float)
        else [v * 1.5 + 1 for v in value]
        if isinstance(value, list)
        else "?"
    )


def nbgrader(folder: Path) -> None:
    """generate_assignment, two submissions, autograde, export."""
    (folder / "nbgrader_config.py").write_text(NBGRADER_CONFIG)
    made = export("nbgrader", folder / "source")
    right = keys(made)
    run(BIN / "nbgrader", "generate_assignment", "forms", "--create", cwd=folder)
    released = folder / "release" / "forms" / "forms.ipynb"
    text = released.read_text()
    assert not any(f"{v!r}" in text for v in right.values() if isinstance(v, float)), (
        "a key is in the released notebook"
    )
    for student, answers in (("right", right), ("wrong", {n: wrong(v) for n, v in right.items()})):
        notebook = json.loads(text)
        cell = next(c for c in notebook["cells"] if c["metadata"].get("nbgrader", {}).get("solution"))
        cell["source"] = f"answers = {answers!r}"
        path = folder / "submitted" / student / "forms" / "forms.ipynb"
        path.parent.mkdir(parents=True)
        path.write_text(json.dumps(notebook))
    run(BIN / "nbgrader", "autograde", "forms", "--create", cwd=folder)
    run(BIN / "nbgrader", "export", "--to", "grades.csv", cwd=folder)
    rows = {r["student_id"]: r for r in csv.DictReader((folder / "grades.csv").open())}
    best = float(rows["right"]["max_score"])
    assert best > 5 and float(rows["right"]["score"]) == best and float(rows["wrong"]["score"]) == 0, rows
    print(f"nbgrader: {best:g} points of {best:g} for right answers, 0 for wrong ones")


def otter(folder: Path) -> None:
    """otter assign with its own run of the solutions, then two submissions graded by the autograder."""
    made = export("otter", folder)
    right = keys(made)
    run(BIN / "otter", "assign", made, folder / "dist", cwd=folder)
    student = next((folder / "dist" / "student").glob("*.ipynb"))
    text = student.read_text()
    assert not any(f"{v!r}" in text for v in right.values() if isinstance(v, float)), (
        "a key is in the student's notebook"
    )
    archive = next((folder / "dist" / "autograder").glob("*.zip"))
    scores = {}
    for name, answers in (("right", right), ("wrong", {n: wrong(v) for n, v in right.items()})):
        notebook = json.loads(text)
        for cell in notebook["cells"]:
            for key, value in answers.items():
                if cell["cell_type"] == "code" and source(cell).startswith(f"answers[{key!r}]"):
                    cell["source"] = f"answers[{key!r}] = {value!r}"
        path = folder / name / "forms.ipynb"
        path.parent.mkdir()
        path.write_text(json.dumps(notebook))
        run(BIN / "otter", "run", "-a", archive, "-o", folder / name, path, cwd=folder)
        tests = json.loads((folder / name / "results.json").read_text())["tests"]
        scores[name] = sum(t.get("score", 0) or 0 for t in tests), sum(t.get("max_score", 0) or 0 for t in tests)
    assert scores["right"][0] == scores["right"][1] > 5 and scores["wrong"][0] == 0, scores
    print(f"otter: {scores['right'][0]:g} points of {scores['right'][1]:g} for right answers, 0 for wrong ones")


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        for prove in (nbgrader, otter):
            place = Path(folder) / prove.__name__
            (place / "source").mkdir(parents=True)
            prove(place)


if __name__ == "__main__":
    main()
