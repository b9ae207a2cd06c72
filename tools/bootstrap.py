"""Make the environment that everything runs in: a venv, the locked packages, the project itself.

    python3 tools/bootstrap.py .venv            makes it anew, from environment.txt
    python3 tools/bootstrap.py .venv interop    adds locks/interop.txt to it

uv installs, itself a locked wheel (tools/uv.txt); where it does not run, pip does: the same packages, the same hashes.
This needs the standard library only and any Python 3, so that a Python that is too old gets a line it can read. Exit
code 3 says that the environment could not be made; the last thing written is the file ``ready``, with the folders
it was made for, so that neither a broken-off installation nor a copied one is taken for a whole one.
"""

import os
import re
import shutil
import subprocess
import sys

from pip_settings import uv_environment

OLDEST = (3, 11)
NEWEST_TRIED = 14
LOCK, INSTALLER = "environment.txt", os.path.join("tools", "uv.txt")


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


UNSAFE = ("do not match the hash", "hash mismatch")
FULL = ("no space left", "disk quota exceeded")
NETWORK = (
    *("connection", "timed out", "temporary failure", "name resolution", "network is unreachable", "max retries"),
    *("failed to fetch", "error sending request", "dns error", "failed to lookup address", "failed to connect"),
)
ABSENT = ("no matching distribution", "could not find a version")  # what pip says when it cannot even ask


def reason(log, lock=LOCK, folder="."):
    """The line of an installer's log that a person needs, and what to do about it. folder: what it was to fill."""
    with open(log, encoding="utf-8", errors="replace") as file:
        lines = [line.strip() for line in file if line.strip()]
    text = "\n".join(lines).lower()
    errors = [line for line in lines if line.lower().startswith("error")] or lines[-1:] or ["no output"]
    if any(word in text for word in UNSAFE):
        named = re.search(r"[Hh]ash mismatch for `([^`]+)`|^([\w.-]+==[^\s:;]+)(?: from .*)?:$", "\n".join(lines), re.M)
        which = f" ({named[1] or named[2]})" if named else ""
        return f"a downloaded package{which} does not match the hash in {lock}; run make again, or make lock"
    if any(word in text for word in FULL) or shutil.disk_usage(folder).free < 5e6:
        return "the disk is full; the environment takes about 1 GB"
    if any(word in text for word in NETWORK + ABSENT):
        return f"the packages of {lock} could not be downloaded: is there a network? ({errors[-1]})"
    return errors[-1]


def succeeds(command, log, env=None):
    """Run a command quietly, its words at the end of the log. False where it fails or cannot even start."""
    with open(log, "ab") as file:
        try:
            done = subprocess.run(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL, env=env)
        except OSError as error:
            file.write(f"{command[0]}: {error}\n".encode())
            return False
    return done.returncode == 0


def run(step, command, log, lock=LOCK, folder="."):
    """Run one step; a failure is one line and the name of the log."""
    if not succeeds(command, log):
        stop(f"{step} failed: {reason(log, lock, folder).rstrip('.')}. The whole log: {log}")


class Installer:
    """uv, and from the first failure that pip may survive on, pip."""

    def __init__(self, folder, log):
        self.python = os.path.join(folder, "bin", "python")
        self.uv = os.path.join(folder, "bin", "uv")
        self.log = log
        self.pip = [self.python, "-m", "pip", "install", "--disable-pip-version-check", "--no-input", "--no-compile"]
        self.env = uv_environment(self.python)
        if not os.path.exists(self.uv):
            locked = ["--only-binary", ":all:", "--require-hashes", "-r", INSTALLER]
            if not succeeds(self.pip + locked, log):
                self.give_up_uv(INSTALLER)
        elif not succeeds([self.uv, "--version"], log):
            self.give_up_uv(INSTALLER)

    def give_up_uv(self, lock):
        """Go on with pip, unless the reason is one that pip would meet as well, or a package that was changed."""
        with open(self.log, encoding="utf-8", errors="replace") as file:
            said = file.read().lower()
        if any(word in said for word in UNSAFE + FULL) or (lock == INSTALLER and any(word in said for word in NETWORK)):
            stop(f"installing {lock} failed: {reason(self.log, lock)}. The whole log: {self.log}")
        self.uv = ""
        print("loopbook: uv cannot install here; pip does, which takes about a minute")
        sys.stdout.flush()
        with open(self.log, "ab") as file:
            file.write(b"\nloopbook: from here on pip\n")

    def install(self, lock, *arguments):
        """Install what a lock names (or, without network, the project itself)."""
        if self.uv:
            if succeeds([self.uv, "pip", "install", "--python", self.python, *arguments], self.log, self.env):
                return
            self.give_up_uv(lock)
        run("installing " + lock, self.pip + list(arguments), self.log, lock)


def make(folder):
    """The whole environment, anew."""
    python = interpreter()
    log = folder + "-install.log"
    open(log, "w").close()
    if subprocess.run([python, "-c", "import venv, ensurepip"], stderr=subprocess.DEVNULL).returncode:
        stop(
            "this Python cannot make virtual environments; install its venv package "
            "(Debian and Ubuntu: apt install python3-venv) and run make again"
        )
    print(f"loopbook: making the environment in {folder} (some ten seconds)")
    sys.stdout.flush()
    run("making " + folder, [python, "-m", "venv", "--clear", folder], log, folder=folder)
    installer = Installer(folder, log)
    installer.install(LOCK, "--require-hashes", "-r", LOCK)
    installer.install("loopbook", "--no-deps", "--no-build-isolation", "--no-index", "--editable", ".")
    os.replace(log, os.path.join(folder, "install.log"))
    with open(os.path.join(folder, "ready"), "w", encoding="utf-8") as file:
        file.write("{}.{}\n".format(*version_of(installer.python)))
        file.write(os.path.realpath(".") + "\n" + os.path.realpath(folder) + "\n")


def add(folder, name):
    """What one target needs beside environment.txt; what has no wheel is built with the locked setuptools."""
    lock = os.path.join("locks", name + ".txt")
    log = os.path.join(folder, f"install-{name}.log")
    open(log, "w").close()
    print(f"loopbook: installing {lock}")
    sys.stdout.flush()
    Installer(folder, log).install(lock, "--require-hashes", "--no-build-isolation", "-r", LOCK, "-r", lock)
    open(os.path.join(folder, "ready-" + name), "w").close()


if __name__ == "__main__":
    if any(word.startswith("-") for word in sys.argv[1:]):
        print(__doc__)
        sys.exit(0 if "--help" in sys.argv else 2)
    where = sys.argv[1] if len(sys.argv) > 1 else ".venv"
    try:
        if len(sys.argv) > 2:
            add(where, sys.argv[2])
        else:
            make(where)
    except KeyboardInterrupt:
        stop("interrupted; run make again")
