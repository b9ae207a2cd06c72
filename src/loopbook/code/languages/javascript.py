"""JavaScript: one function body; the ES module and the classic script are a line around it each."""

from collections.abc import Mapping
from types import MappingProxyType

from sympy import Integer, Rational
from sympy.printing.jscode import JavascriptCodePrinter

from derivations.programs.form import Do, Fill, Operation, Variable
from loopbook.code.block import Block
from loopbook.code.language import Language, Options
from loopbook.code.writing import Arithmetic, Writer, spoken, wrapped


class ScriptArithmetic(Arithmetic, JavascriptCodePrinter):
    """Frozen arithmetic in JavaScript; every number is a double."""

    signs: Mapping[str, str] = MappingProxyType({"<": "<", "<=": "<=", ">": ">", ">=": ">=", "==": "===", "!=": "!=="})

    def _print_Integer(self, node: Integer) -> str:
        return str(int(node))

    def _print_Rational(self, node: Rational) -> str:
        return repr(float(node))


class ScriptWriter(Writer):
    """Statements inside a function; states are properties of ``self``, settings of ``self.s``, new ones of ``s``."""

    note = " // {}"

    def __init__(self, block: Block):
        program = block.program
        settings = {s.symbol: f"self.s.{spoken(s.name)}" for s in program.settings}
        new = {s.new: f"s.{spoken(s.name)}" for s in program.settings}
        states = {v.symbol: f"self.{spoken(v.name)}" for v in (*program.gains, *program.states, *program.flags)}
        super().__init__(program, ScriptArithmetic(settings | new | states))

    def filled(self, statement: Fill, depth: int) -> list[str]:
        size = self.program.variables()[statement.buffer].size
        name, value = self.arithmetic.text(statement.buffer), self.arithmetic.text(statement.value)
        return [f"{self.tab * depth}{name} = new Array({size}).fill({value});"]

    def done(self, statement: Do, depth: int) -> list[str]:
        operation = self.program.operation(statement.operation)
        call = f"{operation.name}({'s' if operation.takes_settings else ''});"
        if operation.result is not None:
            call = f"{self.arithmetic.text(operation.result)} = {call}"
        return [self.tab * depth + call]

    def declared(self, variable: Variable) -> str:
        return "let "

    def function(self, operation: Operation) -> list[str]:
        """A whole inner function."""
        given = [*(["s"] if operation.takes_settings else []), *(spoken(a.name) for a in operation.arguments)]
        own = self.program.own_locals(operation)
        back = [] if operation.result is None else [f"{self.tab}return {self.arithmetic.text(operation.result)};"]
        head = f"function {operation.name}({', '.join(given)}) {{"
        return [f"// {operation.about}", head, *self.lines(operation.body, 1, own), *back, "}", ""]


def function_name(block: Block) -> str:
    """heaterPid of heater_pid."""
    return block.title[:1].lower() + block.title[1:]


def body(block: Block) -> str:
    """What stands between the braces of ``function heaterPid(settings) { ... }``."""
    program = block.program
    writer = ScriptWriter(block)
    numbers = wrapped([f"{name}: {_literal(value)}" for name, value in block.settings().items()], 8)
    public = [o.name for o in program.operations if o.public and o.name != "init"]
    flags = wrapped([f'"{f.name}"' for f in program.flags], 12)
    lines = [
        '"use strict";',
        "const designed = {",
        *(line[4:] for line in numbers),
        "};",
        "const self = { s: {} };",
        "",
        *(line for operation in program.operations for line in writer.function(operation)),
        "// The flags of the last step that are up, by name.",
        "function flags() {",
        "    const names = [",
        *(line[4:] for line in flags),
        "    ];",
        "    return names.filter((name) => self[name]);",
        "}",
        "",
        "// Settings that are not named keep the value in force.",
        "function changed(some) { return change({ ...self.s, ...some }); }",
        "",
        "if (!init({ ...designed, ...settings })) {",
        "    throw new RangeError(`a setting is out of its range: ${JSON.stringify({ ...designed, ...settings })}`);",
        "}",
        f"return {{ {', '.join(public)}, changed, flags, state: self }};",
    ]
    return "".join(f"    {line}\n" if line else "\n" for line in lines)


def _literal(value: float | bool) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    return {"inf": "Infinity", "-inf": "-Infinity"}.get(repr(value), repr(value))


def _head(block: Block, call: str) -> str:
    program = block.program
    arguments = ", ".join(spoken(a.name) for a in program.operation("step").arguments)
    name = function_name(block)
    lines = [
        f"{block.name}: {program.law}.",
        program.about,
        *block.notes,
        "",
        call,
        f"const loop = {name}();",
        f"    the settings are the design's; others: {name}({{ K: 2 }})",
    ]
    if program.has("start"):
        lines += [
            f"loop.start({block.arguments('start')});",
            "    from rest: the first step returns u",
        ]
    lines += [
        f"u = loop.step({arguments});",
        "    every h seconds",
        "loop.flags();",
        "    what the operator should know",
        "",
        *(f"{spoken(s.name)}: {s.about}" for s in program.settings),
        "",
        "Equation numbers are those of the report on the PID controller (pid-report, chapter 4).",
    ]
    return "".join(f"// {line}".rstrip() + "\n" for line in lines)


def files(block: Block, options: Options, stem: str) -> dict[str, str]:
    """A classic script and a module with one body."""
    name = function_name(block)
    text = f"function {name}(settings) {{\n{body(block)}}}\n"
    return {
        f"{stem}.js": _head(block, f'<script src="{stem}.js"></script>') + text,
        f"{stem}.mjs": _head(block, f'import {{ {name} }} from "./{stem}.mjs";') + "export " + text,
    }


LANGUAGE = Language("js", "JavaScript", (".js", ".mjs"), files)
