"""Structured Text (IEC 61131-3): a function block with the names of CODESYS' PID_FIXCYCLE, REAL or LREAL.

Every literal has its type, REAL#0.5 and -REAL#10.0: a bare 0.5 is a double in one compiler, and REAL#-10.0 is refused
by another. A function block has no methods here, so that every controller takes it: one call does all that one cycle
needs, in this order: new settings, RESET or MANUAL, ELAPSED, the step.
"""

from collections.abc import Mapping
from types import MappingProxyType

from sympy import Integer, Rational, Symbol
from sympy.printing.codeprinter import CodePrinter

from derivations.programs.form import BOOL, COUNT, REAL, BlockProgram, Do, Fill, Operation, Variable
from loopbook.code.block import Block, CodeError, checked_finite
from loopbook.code.language import Language, Options
from loopbook.code.writing import Arithmetic, Writer, kept_names, spoken

CODESYS: Mapping[str, str] = {
    "y": "ACTUAL",
    "y_sp": "SET_POINT",
    "K": "KP",
    "T_i": "TN",
    "T_d": "TV",
    "u_wanted": "Y_MANUAL",
    "u_0": "Y_MANUAL",
    "u_low": "Y_MIN",
    "u_high": "Y_MAX",
    "on": "MANUAL",
    "h": "CYCLE",
    "u": "Y",
    "T_f": "TF",
    "b": "WEIGHT_P",
    "c": "WEIGHT_D",
    "T_t": "TT",
    "e": "ERROR",
}
"""The names of PID_FIXCYCLE for what it has, ours in the same manner for the rest."""
OFFERED = ("reset", "start", "manual", "cycle", "step")
"""The operations that one call goes through."""


class TextArithmetic(Arithmetic, CodePrinter):
    """Frozen arithmetic in Structured Text; ``real`` is REAL or LREAL."""

    signs: Mapping[str, str] = MappingProxyType({"<": "<", "<=": "<=", ">": ">", ">=": ">=", "==": "=", "!=": "<>"})
    both, either, unless = " AND ", " OR ", "NOT "
    true, false = "TRUE", "FALSE"

    def __init__(self, names: Mapping[Symbol, str], real: str):
        super().__init__(names)
        self.real = real

    def _print_Integer(self, node: Integer) -> str:
        return literal(float(node), self.real)

    def _print_Rational(self, node: Rational) -> str:
        return literal(float(node), self.real)


class TextWriter(Writer):
    """Statements of a function block's body; every operation stands in its place."""

    opening, chained, middle, closing = "IF {} THEN", "ELSIF {} THEN", "ELSE", "END_IF;"
    assignment = "{} := {};"
    note = " (* {} *)"

    def filled(self, statement: Fill, depth: int) -> list[str]:
        buffer, value = self.arithmetic.text(statement.buffer), self.arithmetic.text(statement.value)
        size = self.program.variables()[statement.buffer].size
        indent = self.tab * depth
        return [
            f"{indent}FOR filled := 0 TO {size - 1} DO",
            f"{indent}{self.tab}{buffer}[filled] := {value};",
            f"{indent}END_FOR;",
        ]


def literal(value: float | bool, real: str = "REAL") -> str:
    """A typed literal.

    >>> literal(0.9), literal(-10.0), literal(1e-7, "LREAL"), literal(True)
    ('REAL#0.9', '-REAL#10.0', 'LREAL#1.0E-7', 'TRUE')
    """
    if isinstance(value, bool):
        return "TRUE" if value else "FALSE"
    digits, _, power = repr(abs(checked_finite(value))).partition("e")
    whole = digits if "." in digits else f"{digits}.0"
    return f"{'-' if value < 0 else ''}{real}#{whole}{f'E{int(power)}' if power else ''}"


class Names:
    """What a program's symbols are called in a function block. Names differ in more than case."""

    def __init__(self, program: BlockProgram):
        self.program = program
        self.outputs = [v for v in program.states if v.symbol == program.output or v.name == "e"]
        outside = {*self.outputs, *program.flags}
        self.inside = [v for v in (*program.gains, *program.states) if v not in outside]
        self.table = {s.symbol: f"{spoken(s.name)}_used" for s in program.settings}
        self.table |= {s.new: self.of(s) for s in program.settings}
        self.table |= {v.symbol: self.of(v) for v in outside}
        self.table |= {v.symbol: kept_names(program)[v.symbol] for v in self.inside}
        self.table |= {a.symbol: self.of(a) for o in self.offered() for a in o.arguments}
        self.table |= {Symbol("feedforward", real=True): "added"} if self.feeds() else {}

    def offered(self) -> list[Operation]:
        return [self.program.operation(n) for n in OFFERED if self.program.has(n)]

    def feeds(self) -> bool:
        return any(a.name == "feedforward" for a in self.program.operation("step").arguments)

    @staticmethod
    def of(variable: Variable) -> str:
        """The name of an input or an output."""
        return CODESYS.get(variable.name, variable.name.upper())


def function_block(block: Block, options: Options) -> str:
    """The whole text."""
    program = block.program
    real = {"float": "REAL", "double": "LREAL"}[options.real]
    types = {REAL: real, BOOL: "BOOL", COUNT: "DINT"}
    names = Names(program)
    writer = TextWriter(program, TextArithmetic(names.table, real))

    def declared(variable: Variable, name: str, start: str = "", about: str = "") -> str:
        kind = f"ARRAY[0..{variable.size - 1}] OF {types[variable.type]}" if variable.size else types[variable.type]
        value = f" := {start}" if start else ""
        text = about or variable.about
        return f"    {name} : {kind}{value};" + (f" (* {text} *)" if text else "")

    given = {s.symbol: literal(block.number(s), real) for s in program.settings}
    signals = {names.of(a): a for o in reversed(names.offered()) for a in o.arguments}
    first = [signals.pop(name) for name in ("ACTUAL", "SET_POINT")]
    last = list(signals.values())
    inputs = [declared(a, names.of(a)) for a in first]
    inputs += [declared(s, names.of(s), given[s.symbol]) for s in program.settings]
    inputs += [declared(a, names.of(a)) for a in last]
    if names.feeds():
        inputs += [f"    Y_OFFSET : {real}; (* added to the output; the output while RESET is TRUE *)"]
    if program.has("start"):
        inputs += ["    START : BOOL; (* starts from rest: the output is Y_MANUAL, the next one follows from it *)"]
    if program.has("reset"):
        begun = "; the output is Y_OFFSET" if names.feeds() else ""
        inputs += [f"    RESET : BOOL; (* as when switched on{begun} *)"]
    outputs = [declared(v, names.of(v)) for v in names.outputs]
    outputs += [declared(f, names.of(f)) for f in program.flags]
    if program.has("limit"):
        outputs += ["    LIMITS_ACTIVE : BOOL; (* LIMITED_LOW or LIMITED_HIGH *)"]
    inside = [declared(s, names.table[s.symbol], about=f"{names.of(s)} in force") for s in program.settings]
    inside += [declared(v, names.table[v.symbol]) for v in names.inside]
    local = {v.symbol: v for o in program.operations if not (o.pure and o.public) for v in o.locals}
    inside += [declared(v, writer.arithmetic.text(v.symbol)) for v in local.values()]
    inside += ["    ready : BOOL; (* settings have been taken *)", "    fresh : BOOL; (* a reset is due *)"]
    inside += [f"    added : {real};"] if names.feeds() else []
    inside += ["    filled : DINT;"] if any(v.size for v in program.states) else []
    _refuse_one_name_twice([*inputs, *outputs, *inside])
    return "\n".join(
        [
            f"(* {block.name}: {program.law}.",
            f"   {program.about}",
            *(f"   {note}" for note in block.notes),
            "",
            *(f"   {line}" for line in usage(block, names)),
            "",
            "   Equation numbers are those of the report on the PID controller (pid-report, chapter 4). *)",
            f"FUNCTION_BLOCK FB_{block.title}",
            "VAR_INPUT",
            *inputs,
            "END_VAR",
            "VAR_OUTPUT",
            *outputs,
            "END_VAR",
            "VAR",
            *inside,
            "END_VAR",
            "",
            *_body(block, names, writer),
            "END_FUNCTION_BLOCK",
            "",
        ]
    )


def _refuse_one_name_twice(declarations: list[str]) -> None:
    """Case does not tell names apart here."""
    names = [line.split(":")[0].strip().upper() for line in declarations]
    if twice := sorted({n for n in names if names.count(n) > 1}):
        raise CodeError(f"{', '.join(twice)}: two names of the program are one in Structured Text")


def _body(block: Block, names: Names, writer: TextWriter) -> list[str]:
    """One call: new settings where an input moved, then what the cycle asks for."""
    program = block.program
    moved = [f"({names.table[s.new]} <> {names.table[s.symbol]})" for s in program.settings]
    tests = [" OR ".join(moved[i : i + 4]) for i in range(0, len(moved), 4)]
    condition = ["IF NOT ready", *(f"    OR {test}" for test in tests), "THEN"]
    lines = [*condition, *writer.lines(program.operation("change").body, 1)]
    lines += ["    IF valid AND NOT ready THEN", "        ready := TRUE;", "        fresh := TRUE;", "    END_IF;"]
    lines += ["ELSE", "    REFUSED := FALSE;", "END_IF;", "IF ready THEN", "    IF fresh OR RESET THEN"]
    reset = program.operation("reset").body
    limited = Do("limit") in reset
    lines += writer.lines([s for s in reset if not isinstance(s, Do)], 2)
    lines += ["        Y := Y_OFFSET;"] if names.feeds() else []
    lines += writer.lines([Do("limit")], 2) if limited else []
    lines += ["        fresh := FALSE;", "    END_IF;", "    IF NOT RESET THEN"]
    lines += ["        added := FEEDFORWARD + Y_OFFSET;"] if names.feeds() else []
    if program.has("start"):
        lines += ["        IF START THEN", *writer.lines(program.operation("start").body, 3), "        END_IF;"]
    follow = [o for o in names.offered() if o.name not in ("reset", "start")]
    lines += [line for o in follow for line in writer.lines(o.body, 2)]
    lines += ["    END_IF;", "END_IF;"]
    return lines + (["LIMITS_ACTIVE := LIMITED_LOW OR LIMITED_HIGH;"] if limited else [])


def usage(block: Block, names: Names) -> list[str]:
    """Ten lines of how to call it."""
    title = block.title
    h = block.settings().get("h")
    timed = "" if h is None else f", CYCLE := {h:g}"
    lines = [
        "How to use it:",
        f"    VAR  loop : FB_{title};  END_VAR        one instance for each loop, in a periodic task",
        f"    loop(ACTUAL := temperature, SET_POINT := wanted{timed});   the rest are the design's numbers",
        "    valve := loop.Y;",
    ]
    if block.program.has("start"):
        where = f"; {block.rest[0]:.6g} in the record, with ACTUAL at {block.rest[1]:.6g}" if block.rest else ""
        lines += [
            "Switch on from rest: the first call with START := TRUE and Y_MANUAL := where the actuator stands",
            f"    (the first output is Y_MANUAL{where}).",
        ]
    if block.program.has("manual"):
        lines += [
            "MANUAL := TRUE: the output is Y_MANUAL; back in automatic the first output is the last manual one.",
            "Before MANUAL := TRUE copy loop.Y to Y_MANUAL: no bump that way either.",
        ]
    if block.program.has("measurement"):
        return [*lines, f"    ACTUAL := FC_{title}_Measurement(INT_TO_REAL(raw));   see the scaling beside this file"]
    return [*lines, "4..20 mA read as 0..27648:  ACTUAL := low + INT_TO_REAL(raw)*(high - low)/REAL#27648.0"]


def functions(block: Block, options: Options) -> str:
    """The scaling of the converters, a FUNCTION each; empty where the design names no converters."""
    real = {"float": "REAL", "double": "LREAL"}[options.real]
    lines = []
    for operation in (o for o in block.program.operations if o.pure and o.public):
        (argument,) = operation.arguments
        name = f"FC_{block.title}_{operation.name.capitalize()}"
        writer = TextWriter(
            block.program,
            TextArithmetic({argument.symbol: argument.name.upper(), operation.result: name}, real),
        )
        lines += [f"(* {operation.about} *)", f"FUNCTION {name} : {real}", "VAR_INPUT"]
        lines += [f"    {argument.name.upper()} : {real};", "END_VAR", "", *writer.lines(operation.body)]
        lines += ["END_FUNCTION", ""]
    return "\n".join(lines)


def files(block: Block, options: Options, stem: str) -> dict[str, str]:
    """One function block, and the scaling of its converters where it is known."""
    scaled = functions(block, options)
    made = {f"{stem}.st": function_block(block, options)}
    return made | ({f"{stem}_scaling.st": scaled} if scaled else {})


LANGUAGE = Language("st", "Structured Text", (".st",), files)
