"""`make doctor`: is there an environment, and is it this folder's? Then `loopbook doctor` inside it says the rest.

Needs the standard library only and changes nothing, so it runs where everything else is broken.
"""

import os
import subprocess
import sys

from bootstrap import LOCK, OLDEST, version_of


def examine(folder):
    """The answers that need no environment: (verdict, question, finding)."""
    here, version = os.path.realpath("."), ".".join(str(n) for n in sys.version_info[:3])
    old = sys.version_info[:2] < OLDEST
    yield (
        "note" if old else "ok",
        "Python of make",
        f"{version} in {sys.executable}" + (" is older than 3.11" if old else ""),
    )
    ready = os.path.join(folder, "ready")
    if not os.path.exists(ready):
        state = "is not complete" if os.path.isdir(folder) else "does not exist"
        yield "FAIL", "environment", f"{folder} {state}: run make"
        return
    with open(ready, encoding="utf-8") as file:
        made_for = file.read().split("\n")[1:3]
    inside = version_of(os.path.join(folder, "bin", "python"))
    if inside is None:
        yield "FAIL", "environment", f"the Python of {folder} does not run any more: run make"
    elif made_for != [here, os.path.realpath(folder)]:
        yield "FAIL", "environment", f"{folder} belongs to {made_for[0] if made_for else 'another folder'}: run make"
    elif os.path.getmtime(ready) < os.path.getmtime(LOCK):
        yield "FAIL", "environment", f"{LOCK} is newer than {folder}: run make"
    else:
        yield "ok", "environment", "{} with Python {}.{}".format(folder, *inside)


def main(folder):
    worst = 0
    for verdict, question, found in examine(folder):
        print(f"{verdict:5} {question:22} {found}")
        worst = 3 if verdict == "FAIL" else worst
    if worst:
        return worst
    sys.stdout.flush()
    done = subprocess.run(
        [os.path.join(folder, "bin", "python"), "-m", "loopbook.cli", "--root", ".", "doctor"], stderr=subprocess.PIPE
    )
    said = done.stderr.decode("utf-8", "replace").strip().splitlines()
    if done.returncode not in (0, 3):
        last = said[-1] if said else f"exit code {done.returncode}"
        print(f"FAIL  loopbook               does not start ({last}): run make clean, then make")
    elif said:
        print("\n".join(said), file=sys.stderr)
    return 3 if done.returncode else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1] if len(sys.argv) > 1 else ".venv"))
