"""Make the environment that everything runs in: a venv, the locked packages, the project itself.

Run as ``python3 tools/bootstrap.py .venv``. It needs the standard library only and any Python 3, so that a Python that
is too old gets a line it can read. Exit code 3 says that the environment could not be made; the last thing it writes
is the file ``ready``, so a broken-off installation is never taken for a whole one.
"""

import os
import shutil
import subprocess
import sys

OLDEST = (3, 11)
NEWEST_TRIED = 13


def stop(message):
    sys.stderr.write("loopbook: " + message + "\n")
    sys.exit(3)


def version_of(python):
    """The (major, minor) of an interpreter, or None where it does not run."""
    code = "import sys; print(sys.version_info[0], sys.version_info[1])"
    try:
        shown = subprocess.run([python, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    except OSError:
        return None
    return tuple(int(n) for n in shown.stdout.split()) if shown.returncode == 0 else None


def interpreter():
    """This Python if it is new enough, else the newest one on PATH that is."""
    if sys.version_info[:2] >= OLDEST:
        return sys.executable
    for minor in range(NEWEST_TRIED, OLDEST[1] - 1, -1):
        found = shutil.which("python3." + str(minor))
        if found and (version_of(found) or (0,)) >= OLDEST:
            return found
    here = ".".join(str(n) for n in sys.version_info[:3])
    stop(
        f"needs Python 3.11 or newer; {sys.executable} is {here} and no newer one is on PATH. "
        "Name one with: make PYTHON=/path/to/python3"
    )


def reason(log):
    """The line of an installer's log that a person needs, and what to do about it."""
    with open(log, encoding="utf-8", errors="replace") as file:
        lines = [line.strip() for line in file if line.strip()]
    text = "\n".join(lines).lower()
    errors = [line for line in lines if line.lower().startswith("error")] or lines[-1:] or ["no output"]
    if "hash" in text and "do not match" in text:
        return "a downloaded package does not match the hash in environment.txt; run make again, or make lock"
    network = (
        *("connection", "timed out", "temporary failure", "name resolution", "network is unreachable", "max retries"),
        *("no matching distribution", "could not find a version"),  # what pip says when it cannot even ask
    )
    if any(word in text for word in network):
        return f"the packages of environment.txt could not be downloaded: is there a network? ({errors[-1]})"
    if "no space left" in text:
        return "the disk is full; the environment takes about 1 GB"
    return errors[-1]


def run(step, command, log):
    """Run one step quietly; a failure is one line and the name of the log."""
    with open(log, "ab") as file:
        done = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
    if done.returncode:
        stop(f"{step} failed: {reason(log)}. The whole log: {log}")


def make(folder):
    python = interpreter()
    log = folder + "-install.log"
    open(log, "w").close()
    if subprocess.run([python, "-c", "import venv, ensurepip"], stderr=subprocess.DEVNULL).returncode:
        stop(
            "this Python cannot make virtual environments; install its venv package "
            "(Debian and Ubuntu: apt install python3-venv) and run make again"
        )
    print(f"loopbook: making the environment in {folder} (about a minute)")
    sys.stdout.flush()
    run("making " + folder, [python, "-m", "venv", "--clear", folder], log)
    inside = os.path.join(folder, "bin", "python")
    pip = [inside, "-m", "pip", "install", "--disable-pip-version-check", "--no-input"]
    run("installing environment.txt", [*pip, "--require-hashes", "-r", "environment.txt"], log)
    run("installing loopbook", [*pip, "--no-deps", "--no-build-isolation", "--no-index", "--editable", "."], log)
    os.replace(log, os.path.join(folder, "install.log"))
    with open(os.path.join(folder, "ready"), "w", encoding="utf-8") as file:
        file.write("{}.{}\n".format(*version_of(inside)))


if __name__ == "__main__":
    try:
        make(sys.argv[1] if len(sys.argv) > 1 else ".venv")
    except KeyboardInterrupt:
        stop("interrupted; run make again")
