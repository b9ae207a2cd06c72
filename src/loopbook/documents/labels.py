"""Equations under the number a document gives them: derived on demand, each number once."""

import difflib
from collections.abc import Callable, Iterator
from functools import cache

from sympy import Eq


class Labels:
    """The labelled equations of one document.

    >>> labels = Labels("example")
    >>> @labels("1.1")
    ... def first():
    ...     return Eq(1, 1, evaluate=False)
    >>> labels["1.1"]
    Eq(1, 1)
    >>> labels("1.1")
    Traceback (most recent call last):
    ...
    ValueError: example: equation 1.1 is already registered
    """

    def __init__(self, document: str):
        self.document = document
        self._entries: dict[str, Callable[[], Eq]] = {}

    def __call__(self, label: str) -> Callable[[Callable[[], Eq]], Callable[[], Eq]]:
        """Register the function below under ``label``; ValueError where the label stands already."""
        if label in self._entries:
            raise ValueError(f"{self.document}: equation {label} is already registered")

        def register(derive: Callable[[], Eq]) -> Callable[[], Eq]:
            self._entries[label] = cache(derive)
            return self._entries[label]

        return register

    def __getitem__(self, label: str) -> Eq:
        """The derived equation; KeyError with the nearest labels where there is none."""
        if label not in self._entries:
            near = difflib.get_close_matches(label, self._entries, n=3, cutoff=0.4)
            hint = f"; did you mean {' or '.join(near)}?" if near else ""
            raise KeyError(f"{self.document} has no derived equation {label!r}{hint}")
        return self._entries[label]()

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def __contains__(self, label: object) -> bool:
        return label in self._entries
