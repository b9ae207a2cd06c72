"""An interpreter of the part of Structured Text (IEC 61131-3) that is emitted, many instances of a block at a time.

Every variable is an array with one element for each instance. REAL is single precision and every operation between two
REALs is rounded to it; LREAL is double. A bare literal such as 0.9 is a double, as in the compiler that takes it for
one: an operation with it is done in double, and the assignment rounds. REAL#-10.0 is refused, as another compiler does.
Names do not depend on case. Nothing is shared with what wrote the text.
"""

import re
from collections import Counter
from collections.abc import Callable

import numpy as np

TYPES = {"REAL": np.float32, "LREAL": np.float64, "BOOL": np.bool_, "DINT": np.int32}
TOKEN = re.compile(
    r"\s*(?:(?P<skip>\(\*.*?\*\))"
    r"|(?P<number>(?:(?:REAL|LREAL|DINT)\#)?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?!\w))"
    r"|(?P<name>[A-Za-z_]\w*)"
    r"|(?P<sign>:=|<=|>=|<>|\.\.|[-+*/()<>=:;,\[\]]))",
    re.DOTALL,
)
WORDS = {"IF", "THEN", "ELSIF", "ELSE", "END_IF", "FOR", "TO", "DO", "END_FOR", "AND", "OR", "NOT", "TRUE", "FALSE"}
COMPARED = {
    "<": np.less,
    "<=": np.less_equal,
    ">": np.greater,
    ">=": np.greater_equal,
    "=": np.equal,
    "<>": np.not_equal,
}

Value = Callable[[], np.ndarray]
Action = Callable[[np.ndarray], None]


class TextError(ValueError):
    """The text is not what this interpreter runs; the message shows where."""


def tokens(text: str) -> list[str]:
    found, place = [], 0
    text = text.rstrip()
    while place < len(text):
        match = TOKEN.match(text, place)
        if not match:
            raise TextError(f"cannot read {text[place : place + 40]!r}")
        if not match["skip"]:
            found.append((match["name"] or match["number"] or match["sign"]).upper())
        place = match.end()
    return found


class Interpreter:
    """One function block in many instances. ``taken`` counts, for each branch in the text's order, who went there."""

    def __init__(self, text: str, instances: int):
        self.words, self.place, self.count = tokens(text), 0, instances
        self.everyone = np.ones(instances, bool)
        self.values: dict[str, np.ndarray] = {}
        self.inputs: set[str] = set()
        self.taken: Counter[tuple[int, int]] = Counter()
        self.branches = 0
        self._take("FUNCTION_BLOCK")
        self.name = self._next()
        while self._peek() in ("VAR_INPUT", "VAR_OUTPUT", "VAR"):
            self._declare(self._next())
        with np.errstate(all="ignore"):
            self.body = self._statements({"END_FUNCTION_BLOCK"})
        self._take("END_FUNCTION_BLOCK")
        self.starts = dict(self.values)
        if self.place != len(self.words):
            raise TextError(f"{self._peek()} after the end of the block")

    def put(self, name: str, value: np.ndarray) -> None:
        """Give an input."""
        old = self.values[name.upper()]
        self.values[name.upper()] = np.broadcast_to(np.asarray(value).astype(old.dtype), old.shape)

    def switch_on(self, which: np.ndarray) -> None:
        """These instances are as they were before the first call."""
        if which.any():
            for name, start in self.starts.items():
                self.values[name] = np.where(which, start, self.values[name])

    def get(self, name: str) -> np.ndarray:
        return self.values[name.upper()]

    def call(self) -> None:
        """One call of every instance."""
        for action in self.body:
            action(self.everyone)

    # -- reading

    def _peek(self) -> str:
        return self.words[self.place] if self.place < len(self.words) else "the end"

    def _next(self) -> str:
        word = self._peek()
        self.place += 1
        return word

    def _take(self, *expected: str) -> None:
        for word in expected:
            if self._peek() != word:
                raise TextError(f"{word} expected, found {' '.join(self.words[self.place : self.place + 8])}")
            self.place += 1

    def _declare(self, kind: str) -> None:
        while self._peek() != "END_VAR":
            name = self._next()
            if name in self.values or name in WORDS or not re.fullmatch(r"[A-Z_]\w*", name):
                raise TextError(f"{name}: declared twice, or no name")
            self._take(":")
            size = self._size()
            type_of = TYPES.get(self._next())
            if type_of is None:
                raise TextError(f"{name}: an unknown type")
            start = np.zeros(1, type_of)
            if self._peek() == ":=":
                self._take(":=")
                start = self._value()()
                if (start.dtype == np.bool_) != (type_of is np.bool_):
                    raise TextError(f"{name}: a value of another type")
            self._take(";")
            self.values[name] = np.full((size, self.count) if size else (self.count,), start.astype(type_of))
            if kind == "VAR_INPUT":
                self.inputs.add(name)
        self._take("END_VAR")

    def _size(self) -> int:
        if self._peek() != "ARRAY":
            return 0
        self._take("ARRAY", "[", "0", "..")
        size = int(self._next()) + 1
        self._take("]", "OF")
        return size

    def _statements(self, ends: set[str]) -> list[Action]:
        actions = []
        while self._peek() not in ends:
            actions.append(self._statement())
        return actions

    def _statement(self) -> Action:
        if self._peek() == "IF":
            return self._if()
        if self._peek() == "FOR":
            return self._for()
        name = self._next()
        if name not in self.values or name in self.inputs:
            raise TextError(f"{name} cannot be assigned")
        index = self._index()
        self._take(":=")
        value = self._value()
        self._take(";")
        if (self.values[name].dtype == np.bool_) != (value().dtype == np.bool_):
            raise TextError(f"{name}: a value of another type is assigned")
        return self._element(name, index, value) if index else self._assignment(name, value)

    def _index(self) -> Value | None:
        if self._peek() != "[":
            return None
        self._take("[")
        index = self._value()
        self._take("]")
        return index

    def _assignment(self, name: str, value: Value) -> Action:
        values, kind, shape = self.values, self.values[name].dtype, (self.count,)

        def assign(mask: np.ndarray) -> None:
            new = value().astype(kind)
            if mask is self.everyone:
                values[name] = new if new.shape == shape else np.broadcast_to(new, shape)
            else:
                values[name] = np.where(mask, new, values[name])

        return assign

    def _element(self, name: str, index: Value, value: Value) -> Action:
        def assign(mask: np.ndarray) -> None:
            lanes = np.flatnonzero(mask)
            array = self.values[name].copy()
            where = np.broadcast_to(index(), (self.count,))[lanes]
            array[where, lanes] = np.broadcast_to(value(), (self.count,))[lanes].astype(array.dtype)
            self.values[name] = array

        return assign

    def _if(self) -> Action:
        number = self.branches
        self.branches += 1
        arms: list[tuple[Value, list[Action]]] = []
        while self._peek() in ("IF", "ELSIF") and (not arms or self._peek() == "ELSIF"):
            self._next()
            test = self._value()
            if test().dtype != np.bool_:
                raise TextError("IF takes a BOOL")
            self._take("THEN")
            arms.append((test, self._statements({"ELSIF", "ELSE", "END_IF"})))
        rest: list[Action] = []
        if self._peek() == "ELSE":
            self._take("ELSE")
            rest = self._statements({"END_IF"})
        self._take("END_IF", ";")
        for arm in range(len(arms) + 1):
            self.taken[number, arm] += 0

        def choose(mask: np.ndarray) -> None:
            left = mask
            for arm, (test, actions) in enumerate(arms):
                here = left & test()
                left = left & ~here
                act(arm, here, actions)
            act(len(arms), left, rest)

        def act(arm: int, here: np.ndarray, actions: list[Action]) -> None:
            some = int(np.count_nonzero(here))
            self.taken[number, arm] += some
            if some:
                whole = self.everyone if some == self.count else here
                for action in actions:
                    action(whole)

        return choose

    def _for(self) -> Action:
        self._take("FOR")
        name = self._next()
        self._take(":=")
        first = int(self._next())
        self._take("TO")
        last = int(self._next())
        self._take("DO")
        body = self._statements({"END_FOR"})
        self._take("END_FOR", ";")

        def loop(mask: np.ndarray) -> None:
            for k in range(first, last + 1):
                self.values[name] = np.full(self.count, k, np.int32)
                for action in body:
                    action(mask)

        return loop

    # -- expressions, weakest first

    def _value(self) -> Value:
        return self._chain(self._both, {"OR": np.logical_or}, True)

    def _both(self) -> Value:
        return self._chain(self._compared, {"AND": np.logical_and}, True)

    def _compared(self) -> Value:
        return self._chain(self._sum, COMPARED, False)

    def _sum(self) -> Value:
        return self._chain(self._product, {"+": np.add, "-": np.subtract}, False)

    def _product(self) -> Value:
        return self._chain(self._factor, {"*": np.multiply, "/": np.divide}, False)

    def _chain(self, part: Callable[[], Value], signs: dict[str, Callable], logical: bool) -> Value:
        left = part()
        while self._peek() in signs:
            operation = signs[self._next()]
            left = self._joined(operation, left, part(), logical)
        return left

    @staticmethod
    def _joined(operation: Callable, left: Value, right: Value, logical: bool) -> Value:
        if {left().dtype == np.bool_, right().dtype == np.bool_} != {logical}:
            raise TextError(f"{operation.__name__} of operands of the wrong type")
        return lambda: operation(left(), right())

    def _factor(self) -> Value:
        word = self._next()
        if word == "(":
            value = self._value()
            self._take(")")
            return value
        if word in ("-", "NOT"):
            value = self._factor()
            if (value().dtype == np.bool_) != (word == "NOT"):
                raise TextError(f"{word} of an operand of the wrong type")
            return (lambda: ~value()) if word == "NOT" else (lambda: -value())
        if word in ("TRUE", "FALSE"):
            constant = np.full(1, word == "TRUE")
            return lambda: constant
        if word[0].isdigit() or "#" in word:
            return self._literal(word)
        if word not in self.values:
            raise TextError(f"{word} is not declared")
        values, index = self.values, self._index()
        if index:
            lanes = np.arange(self.count)
            return lambda: values[word][np.broadcast_to(index(), (self.count,)), lanes]
        return lambda: values[word]

    @staticmethod
    def _literal(word: str) -> Value:
        kind, _, digits = word.rpartition("#")
        whole = digits.isdigit()
        type_of = TYPES[kind] if kind else np.int32 if whole else np.float64
        if type_of is np.int32 and not whole:
            raise TextError(f"{word} is no whole number")
        constant = np.full(1, type_of(int(digits) if type_of is np.int32 else digits))
        return lambda: constant
