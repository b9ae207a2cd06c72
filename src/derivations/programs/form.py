"""The one form of a program: typed variables, and operations that are lists of statements in execution order.

A program has settings (numbers that a person gives), states (what it remembers), flags (states that tell a person
something) and operations: ``init``, ``step`` and others. An operation has arguments, at most one result, and a body.
Printers turn the whole into C, Structured Text, JavaScript or Python; none of them knows what it is that it prints.
"""

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field

from sympy import Basic, Symbol

REAL, BOOL, COUNT = "real", "bool", "count"
NEW = "_new"
"""A setting about to be taken has the setting's name with this ending."""


@dataclass(frozen=True)
class Variable:
    """One name of a program. about: what it is, with its unit. size: places of a buffer, 0 for a single value."""

    symbol: Symbol
    type: str = REAL
    about: str = ""
    size: int = 0

    @property
    def name(self) -> str:
        return self.symbol.name

    @property
    def new(self) -> Symbol:
        """The value about to replace this setting."""
        return Symbol(self.name + NEW)


@dataclass(frozen=True)
class Assign:
    """target = value. equation: its number in the report, or where it is derived."""

    target: Basic
    value: Basic
    equation: str = ""


@dataclass(frozen=True)
class If:
    """One of two lists of statements."""

    test: Basic
    then: tuple["Statement", ...]
    otherwise: tuple["Statement", ...] = ()


@dataclass(frozen=True)
class Fill:
    """Every place of a buffer gets the same value."""

    buffer: Symbol
    value: Basic


@dataclass(frozen=True)
class Do:
    """Another operation's body, with the same names."""

    operation: str


Statement = Assign | If | Fill | Do


@dataclass(frozen=True)
class Operation:
    """One thing that a program can be asked for.

    takes_settings: its arguments are new settings. arguments: values of the caller. locals: names that live in the
    body alone. result: what the caller gets. public: for the caller, not for other operations alone. pure: of its
    arguments alone.
    """

    name: str
    about: str
    body: tuple[Statement, ...]
    arguments: tuple[Variable, ...] = ()
    locals: tuple[Variable, ...] = ()
    result: Symbol | None = None
    takes_settings: bool = False
    public: bool = True
    pure: bool = False


@dataclass(frozen=True)
class BlockProgram:
    """A controller. law: its name for a reader. gains: what is computed when a setting changes. output: the state that
    is the control signal. defaults: settings that need not be given, by name.
    """

    law: str
    about: str
    settings: tuple[Variable, ...]
    gains: tuple[Variable, ...]
    states: tuple[Variable, ...]
    flags: tuple[Variable, ...]
    operations: tuple[Operation, ...]
    output: Symbol
    defaults: Mapping[str, Basic] = field(default_factory=dict)

    def operation(self, name: str) -> Operation:
        return next(o for o in self.operations if o.name == name)

    def has(self, name: str) -> bool:
        return any(o.name == name for o in self.operations)

    def variables(self) -> dict[Symbol, Variable]:
        """Everything with a name that outlives a call."""
        return {v.symbol: v for v in (*self.settings, *self.gains, *self.states, *self.flags)}

    def own_locals(self, operation: Operation) -> tuple[Variable, ...]:
        """Locals of an operation, with a result that is neither a state nor among them."""
        known = {*self.variables(), *(v.symbol for v in operation.locals)}
        given = operation.result is None or operation.result in known
        return operation.locals if given else (*operation.locals, Variable(operation.result, BOOL))


def walk(body: Iterable[Statement]) -> Iterator[Statement]:
    """Every statement, those inside an If too, in the order of the text."""
    for statement in body:
        yield statement
        if isinstance(statement, If):
            yield from walk(statement.then)
            yield from walk(statement.otherwise)
