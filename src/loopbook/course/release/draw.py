"""Who gets which numbers: drawn by HMAC-SHA256 of the course's secret, without replacement.

A public generator of random numbers would be searched for its seed at tens of thousands of seeds a second; without the
secret nobody can say what a neighbour has. Each student's draws depend on the student and the sheet's name alone; those
who were there before keep what the manifest holds.
"""

import hmac
from collections.abc import Callable, Iterable, Mapping
from hashlib import sha256
from math import gcd
from pathlib import Path
from typing import Any

from loopbook.course.errors import CourseError
from loopbook.course.release.variants import Variants

SHORTEST = 16
"""Bytes of a secret."""
TRIES = 20_000
"""Variants that are looked at before a sheet counts as too narrow."""

Numbers = Mapping[str, Any]


def read_secret(path: Path, apart_from: Path | None = None) -> bytes:
    """The course's secret. apart_from: a repository in which it must not lie.

    Raises CourseError for a file that is not there, too short, readable by others or inside the repository.
    """
    try:
        secret = path.read_bytes().strip()
    except OSError as error:
        raise CourseError(
            f"the secret {path} cannot be read: {error.strerror}; make one: loopbook course secret {path}"
        ) from None
    if len(secret) < SHORTEST:
        raise CourseError(f"the secret {path} has {len(secret)} bytes; {SHORTEST} or more are needed")
    if apart_from is not None and path.resolve().is_relative_to(apart_from.resolve()):
        raise CourseError(f"the secret {path} lies in {apart_from}, which is published: keep it outside")
    return secret


def number_of(secret: bytes, *words: str) -> int:
    """A number of 256 bits that only the secret tells.

    >>> number_of(b"k" * 16, "heater", "s01", "0") == number_of(b"k" * 16, "heater", "s01", "0")
    True
    >>> number_of(b"k" * 16, "a", "bc") == number_of(b"k" * 16, "ab", "c")
    False
    """
    text = b"".join(len(w.encode()).to_bytes(4, "big") + w.encode() for w in words)
    return int.from_bytes(hmac.new(secret, text, sha256).digest(), "big")


class Draw:
    """The draws of one sheet.

    good: do these numbers make an exercise ("" or why not)? taken: variants that are somebody's already.
    """

    def __init__(
        self, sheet: str, variants: Variants, secret: bytes, good: Callable[[Numbers], str], taken: Iterable[int] = ()
    ):
        self.sheet, self.variants, self.secret, self.good = sheet, variants, secret, good
        self.taken = set(taken)
        self.verdicts: dict[int, str] = {}

    def of(self, student: str, students: int) -> tuple[int, dict[str, Any]]:
        """(variant, its numbers) for one student. students: of the whole class, for the error.

        Raises CourseError where no variant is left, with their number.
        """
        count = self.variants.count
        start = number_of(self.secret, self.sheet, student, "start") % count
        step = self._step(student, count)
        for tried in range(min(count, TRIES)):
            index = (start + tried * step) % count
            if index not in self.taken and not self._verdict(index):
                self.taken.add(index)
                return index, self.variants.at(index)
        raise CourseError(self._too_few(students))

    def _step(self, student: str, count: int) -> int:
        """A step that meets every variant once."""
        attempt = 0
        while True:
            step = number_of(self.secret, self.sheet, student, "step", str(attempt)) % count
            if _coprime(step, count):
                return step
            attempt += 1

    def _verdict(self, index: int) -> str:
        if index not in self.verdicts:
            self.verdicts[index] = self.good(self.variants.at(index))
        return self.verdicts[index]

    def _too_few(self, students: int) -> str:
        good = sum(not why for why in self.verdicts.values())
        good = (
            good
            if len(self.verdicts) >= self.variants.count
            else len(self.taken | {i for i, w in self.verdicts.items() if not w})
        )
        reasons = [why for why in self.verdicts.values() if why]
        most = max(set(reasons), key=reasons.count) if reasons else ""
        often = f"; {reasons.count(most)} of {self.variants.count} fall to: {most}" if most else ""
        plural = "variant" if good == 1 else "variants"
        return f"{self.sheet}: {good} {plural} for {students} students{often}; widen the values in its parameters cell"


def _coprime(step: int, count: int) -> bool:
    return count == 1 or (step > 0 and gcd(step, count) == 1)
