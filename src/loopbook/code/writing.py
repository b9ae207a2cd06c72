"""What the printers share: operations become text with every parenthesis, statements become indented lines.

A language is a SymPy code printer with `Arithmetic` before it in its bases, and a `Writer` that says how an
assignment, a condition, a loop and a call look. Neither changes the order of anything.
"""

import re
from collections.abc import Mapping, Sequence
from types import MappingProxyType

from sympy import Basic, Symbol
from sympy.printing.str import StrPrinter

from derivations.programs import frozen
from derivations.programs.form import Assign, BlockProgram, Do, Fill, If, Statement, Variable

WIDTH = 120
ROOM = 8
"""For a declaration in front."""
BREAK = re.compile(r" (?:[-+]|&&|\|\||AND|OR|and|or) ")
SPOKEN = re.compile(r"^([A-Za-z])_(\w|\d\d)$")


def spoken(name: str) -> str:
    """A name as listings write it: T_i is Ti, p_24 is p24, y_sp stays.

    >>> [spoken(n) for n in ("T_i", "p_24", "y_sp", "K_new")]
    ['Ti', 'p24', 'y_sp', 'K_new']
    """
    return SPOKEN.sub(r"\1\2", name)


def wrapped(items: Sequence[str], indent: int) -> list[str]:
    """A list separated by commas, in lines."""
    lines = [""]
    for item in items:
        if lines[-1] and len(lines[-1]) + len(item) + 2 > WIDTH - indent:
            lines.append("")
        lines[-1] += f"{' ' if lines[-1] else ''}{item},"
    return [" " * indent + line for line in lines]


def kept_names(program: BlockProgram) -> dict[Symbol, str]:
    """What gains, states and flags are called; a state with the name of an operation gets another."""
    taken = {o.name for o in program.operations}
    variables = (*program.gains, *program.states, *program.flags)
    return {v.symbol: spoken(v.name) + ("_mode" if v.name in taken else "") for v in variables}


class Arithmetic(StrPrinter):
    """Frozen operations as infix text. ``names`` gives the text of symbols that are more than their name."""

    signs: Mapping[str, str] = MappingProxyType({s: s for s in ("<", "<=", ">", ">=", "==", "!=")})
    both, either, unless = " && ", " || ", "!"
    true, false = "true", "false"

    def __init__(self, names: Mapping[Symbol, str]):
        super().__init__({"order": "none"})
        self.names = names

    def text(self, node: Basic) -> str:
        return self._print(node)

    def _sum(self, node: frozen.FrozenOperation, sign: str) -> str:
        left, right = node.operands
        return (
            f"{self._within(left, frozen.Times, frozen.Over)} {sign} {self._within(right, frozen.Times, frozen.Over)}"
        )

    def _product(self, node: frozen.FrozenOperation, sign: str) -> str:
        left, right = node.operands
        return f"{self._within(left)}{sign}{self._within(right)}"

    def _within(self, node: Basic, *bare: type) -> str:
        text = self._print(node)
        return f"({text})" if isinstance(node, frozen.FrozenOperation) and not isinstance(node, bare) else text

    def _print_Plus(self, node: frozen.Plus) -> str:
        return self._sum(node, "+")

    def _print_Minus(self, node: frozen.Minus) -> str:
        return self._sum(node, "-")

    def _print_Times(self, node: frozen.Times) -> str:
        return self._product(node, "*")

    def _print_Over(self, node: frozen.Over) -> str:
        return self._product(node, "/")

    def _print_Negative(self, node: frozen.Negative) -> str:
        return f"-{self._within(node.operands[0])}"

    def _print_Relation(self, node: frozen.Relation) -> str:
        sign, left, right = node.args
        return f"{self._print(left)} {self.signs[sign.name]} {self._print(right)}"

    def _joined(self, node: frozen.Condition, word: str) -> str:
        parts = [self._print(p) if type(p) is type(node) else self._condition(p) for p in node.args]
        return word.join(parts)

    def _condition(self, node: Basic) -> str:
        text = self._print(node)
        return text if isinstance(node, Symbol | frozen.Unless) else f"({text})"

    def _print_Both(self, node: frozen.Both) -> str:
        return self._joined(node, self.both)

    def _print_Either(self, node: frozen.Either) -> str:
        return self._joined(node, self.either)

    def _print_Unless(self, node: frozen.Unless) -> str:
        return f"{self.unless}{self._condition(node.args[0])}"

    def _print_Element(self, node: frozen.Element) -> str:
        buffer, index = node.args
        return f"{self._print(buffer)}[{self._print(index)}]"

    def _print_Whole(self, node: frozen.Whole) -> str:
        return str(int(node.args[0]))

    def _print_BooleanTrue(self, node: Basic) -> str:
        return self.true

    def _print_BooleanFalse(self, node: Basic) -> str:
        return self.false

    def _print_Symbol(self, node: Symbol) -> str:
        return self.names.get(node) or super()._print_Symbol(Symbol(spoken(node.name)))


class Writer:
    """Statements as lines. A language overrides the pieces; ``done`` may inline another operation or call it."""

    tab = "    "
    opening, chained, middle, closing = "if ({}) {{", "}} else if ({}) {{", "}} else {{", "}}"
    assignment = "{} = {};"
    note = "  /* {} */"

    def __init__(self, program: BlockProgram, arithmetic: Arithmetic):
        self.program, self.arithmetic = program, arithmetic

    def lines(self, body: Sequence[Statement], depth: int = 0, own: Sequence[Variable] = ()) -> list[str]:
        """The text of statements, each line indented. own: locals to declare here, where they are first met."""
        inner: dict[int, list[Variable]] = {}
        here: dict[int, list[Variable]] = {}
        for variable in own:
            met = [i for i, statement in enumerate(body) if _mentions(self.program, statement, variable.symbol)]
            if not met:
                continue
            first = body[met[0]]
            alone = len(met) == 1 and isinstance(first, If) and _branch_of(self.program, first, variable)
            (inner if alone else here).setdefault(met[0], []).append(variable)
        lines: list[str] = []
        for i, statement in enumerate(body):
            text = self._statement(statement, depth, inner.get(i, []))
            for variable in here.get(i, []):
                if _sets(self.program, statement) == variable.symbol:
                    at = next(i for i, line in enumerate(text) if line.lstrip().startswith(spoken(variable.name)))
                    text[at] = self.tab * depth + self.declared(variable) + text[at].lstrip()
                else:
                    text.insert(0, f"{self.tab * depth}{self.declared(variable)}{spoken(variable.name)};")
            lines += text
        return lines

    def declared(self, variable: Variable) -> str:
        """What stands before a local that is met for the first time."""
        return ""

    def _statement(self, statement: Statement, depth: int, own: Sequence[Variable]) -> list[str]:
        if isinstance(statement, Assign):
            return self._assigned(statement, depth)
        if isinstance(statement, If):
            return self._branches(statement, depth, own)
        if isinstance(statement, Fill):
            return self.filled(statement, depth)
        return self.done(statement, depth)

    def _assigned(self, statement: Assign, depth: int) -> list[str]:
        indent = self.tab * depth
        target, value = self.arithmetic.text(statement.target), self.arithmetic.text(statement.value)
        line, note = indent + self.assignment.format(target, value), self.noted(statement.equation)
        if len(line) + len(note) + ROOM <= WIDTH:
            return [line + note]
        return [indent + note.strip()] * bool(note) + self.broken(line, indent + self.tab)

    def broken(self, line: str, indent: str) -> list[str]:
        """A long statement in several lines, each broken before an operator."""
        lines = [line]
        while len(lines[-1]) + ROOM > WIDTH:
            places = [m.start() for m in BREAK.finditer(lines[-1]) if len(indent) < m.start() <= WIDTH - ROOM]
            if not places:
                break
            at = places[-1]
            lines[-1:] = [lines[-1][:at], indent + lines[-1][at:].lstrip()]
        return lines

    def noted(self, equation: str) -> str:
        """Where a statement comes from; numbers are those of pid-report's equations."""
        return self.note.format(f"eq. {equation}" if equation[:1].isdigit() else equation) if equation else ""

    def _branches(self, statement: If, depth: int, own: Sequence[Variable]) -> list[str]:
        lines: list[str] = []
        for i, (test, body) in enumerate(arms(statement)):
            head = self.middle if test is None else self.chained if i else self.opening
            inside = [v for v in own if any(_mentions(self.program, s, v.symbol) for s in body)]
            lines.append(self.tab * depth + head.format(self.arithmetic.text(test) if test is not None else ""))
            lines += self.lines(body, depth + 1, inside)
        return lines + ([self.tab * depth + self.closing.format()] if self.closing else [])

    def filled(self, statement: Fill, depth: int) -> list[str]:
        raise NotImplementedError

    def done(self, statement: Do, depth: int) -> list[str]:
        """An operation inside another: here its body, in its place."""
        return self.lines(self.program.operation(statement.operation).body, depth)


def arms(statement: If) -> list[tuple[Basic | None, tuple[Statement, ...]]]:
    """(condition, body) of an if, of each else-if after it, and (None, body) of the last else where there is one."""
    found: list[tuple[Basic | None, tuple[Statement, ...]]] = [(statement.test, statement.then)]
    rest = statement.otherwise
    while len(rest) == 1 and isinstance(rest[0], If):
        found.append((rest[0].test, rest[0].then))
        rest = rest[0].otherwise
    return [*found, (None, rest)] if rest else found


def _sets(program: BlockProgram, statement: Statement) -> Basic | None:
    """What a statement gives a value without reading it."""
    if isinstance(statement, Assign):
        return None if statement.value.has(statement.target) else statement.target
    return program.operation(statement.operation).result if isinstance(statement, Do) else None


def _mentions(program: BlockProgram, statement: Statement, symbol: Symbol) -> bool:
    if isinstance(statement, Assign):
        return statement.target.has(symbol) or statement.value.has(symbol)
    if isinstance(statement, Do):
        return program.operation(statement.operation).result == symbol
    if isinstance(statement, Fill):
        return statement.value.has(symbol)
    parts = (*statement.then, *statement.otherwise)
    return statement.test.has(symbol) or any(_mentions(program, part, symbol) for part in parts)


def _branch_of(program: BlockProgram, statement: If, variable: Variable) -> bool:
    """Does the variable live in the bodies alone, in a way that each can have its own?"""
    found = arms(statement)
    if any(test is not None and test.has(variable.symbol) for test, _ in found):
        return False
    return sum(any(_mentions(program, s, variable.symbol) for s in body) for _, body in found) == 1
