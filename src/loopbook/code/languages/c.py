"""C99: a header and a source, one struct owned by the caller, no allocation, no globals, no recursion."""

from sympy import Integer, Rational
from sympy.printing.c import C99CodePrinter

from derivations.programs.form import BOOL, COUNT, REAL, Do, Fill, Operation, Variable
from loopbook.code.block import Block, checked_finite
from loopbook.code.c_extras import sketch, test_main
from loopbook.code.language import Language, Options
from loopbook.code.writing import Arithmetic, Writer, spoken

TYPES = {REAL: "lb_real", BOOL: "bool", COUNT: "int32_t"}


class CArithmetic(Arithmetic, C99CodePrinter):
    """Frozen arithmetic in C; every literal is cast, so that one typedef decides the precision."""

    def _print_Integer(self, node: Integer) -> str:
        return f"(lb_real){int(node)}"

    def _print_Rational(self, node: Rational) -> str:
        return literal(float(node))


class CWriter(Writer):
    """Statements of one operation; others are static functions that it calls."""

    def __init__(self, block: Block):
        program = block.program
        settings = {s.symbol: f"self->s.{spoken(s.name)}" for s in program.settings}
        new = {s.new: f"s->{spoken(s.name)}" for s in program.settings}
        states = {v.symbol: f"self->{spoken(v.name)}" for v in (*program.gains, *program.states, *program.flags)}
        super().__init__(program, CArithmetic(settings | new | states))
        self.block = block

    def done(self, statement: Do, depth: int) -> list[str]:
        operation = self.program.operation(statement.operation)
        call = f"{self.block.name}_{operation.name}({self._handed(operation)});"
        if operation.result is not None:
            call = f"{self.arithmetic.text(operation.result)} = {call}"
        return [self.tab * depth + call]

    def _handed(self, operation: Operation) -> str:
        owner = [] if operation.pure else ["self"]
        return ", ".join([*owner, *(["s"] if operation.takes_settings else [])])

    def filled(self, statement: Fill, depth: int) -> list[str]:
        buffer, value = self.arithmetic.text(statement.buffer), self.arithmetic.text(statement.value)
        size = self.program.variables()[statement.buffer].size
        indent = self.tab * depth
        head = f"for (int32_t k = 0; k < {size}; ++k) {{"
        return [indent + head, f"{indent}{self.tab}{buffer}[k] = {value};", indent + "}"]

    def signature(self, operation: Operation) -> str:
        """Return type, name and parameters."""
        name = self.block.name
        owner = [] if operation.pure else [f"{name} *self"]
        given = [f"const {name}_settings *s"] if operation.takes_settings else []
        values = [f"{TYPES[a.type]} {spoken(a.name)}" for a in operation.arguments]
        returned = "void" if operation.result is None else TYPES[self._type_of(operation)]
        return f"{returned} {name}_{operation.name}({', '.join([*owner, *given, *values])})"

    def _type_of(self, operation: Operation) -> str:
        known = {v.symbol: v.type for v in (*self.program.variables().values(), *operation.locals)}
        return known.get(operation.result, BOOL)

    def declared(self, variable: Variable) -> str:
        return f"{TYPES[variable.type]} "

    def function(self, operation: Operation) -> list[str]:
        """A whole function."""
        head = ("" if operation.public else "static ") + self.signature(operation) + " {"
        own = self.program.own_locals(operation)
        back = [] if operation.result is None else [f"{self.tab}return {self.arithmetic.text(operation.result)};"]
        return [f"/* {operation.about} */", head, *self.lines(operation.body, 1, own), *back, "}", ""]


def literal(value: float | bool, real: str = "lb_real") -> str:
    """A number as C reads it, in the precision of lb_real.

    >>> literal(0.9), literal(-10), literal(True)
    ('(lb_real)0.9', '-(lb_real)10.0', 'true')
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    text = repr(abs(checked_finite(float(value))))
    return f"{'-' if value < 0 else ''}({real}){text}"


def _members(variables: tuple[Variable, ...]) -> list[str]:
    lines = []
    for v in variables:
        place = f"{spoken(v.name)}[{v.size}]" if v.size else spoken(v.name)
        text = f"    {TYPES[v.type]} {place};"
        lines.append(f"{text:<28}/* {v.about} */" if v.about else text)
    return lines


def _flag(block: Block, flag: Variable) -> str:
    return f"{block.name}_{flag.name}".upper()


def header(block: Block, options: Options, stem: str) -> str:
    """The interface: types, flags, functions, and how to call them."""
    program, name = block.program, block.name
    guard = f"{''.join(c if c.isalnum() else '_' for c in stem).upper()}_H"
    flags = [
        line
        for i, f in enumerate(program.flags)
        for line in (f"/* {f.about} */", f"#define {_flag(block, f)} (UINT32_C(1) << {i})")
    ]
    public = [o for o in program.operations if o.public]
    writer = CWriter(block)
    functions = [line for o in public for line in (f"/* {o.about} */", f"{writer.signature(o)};")]
    return "\n".join(
        [
            f"/* {name}: {program.law}.",
            f" * {program.about}",
            *(f" * {note}" for note in block.notes),
            " *",
            *(f" * {line}" for line in usage(block, stem)),
            " *",
            " * Equation numbers are those of the report on the PID controller (pid-report, chapter 4).",
            " * Compile with -std=c99 -ffp-contract=off and without -ffast-math: fused or rearranged operations round",
            " * differently, and a test for NaN is removed. 32-bit x86 needs -msse2 -mfpmath=sse as well.",
            " */",
            f"#ifndef {guard}",
            f"#define {guard}",
            "",
            "#include <stdbool.h>",
            "#include <stdint.h>",
            "",
            "#ifndef LB_REAL_DEFINED",
            "#define LB_REAL_DEFINED",
            f"typedef {options.real} lb_real; /* float or double: this line decides */",
            "#endif",
            "",
            "#ifdef __cplusplus",
            'extern "C" {',
            "#endif",
            "",
            "typedef struct {",
            *_members(program.settings),
            f"}} {name}_settings;",
            "",
            "typedef struct {",
            f"    {name}_settings s;".ljust(28) + "/* the settings in force */",
            *_members((*program.gains, *program.states, *program.flags)),
            f"}} {name};",
            "",
            *flags,
            "",
            "/* The numbers of the design. */",
            f"{name}_settings {name}_designed(void);",
            *functions,
            "/* What the operator should know of the last step: an OR of the flags above. */",
            f"uint32_t {name}_flags(const {name} *self);",
            "",
            "#ifdef __cplusplus",
            "}",
            "#endif",
            "",
            f"#endif /* {guard} */",
            "",
        ]
    )


def source(block: Block, stem: str) -> str:
    """The functions."""
    program, name = block.program, block.name
    writer = CWriter(block)
    numbers = [f"    s.{key} = {literal(value)};" for key, value in block.settings().items()]
    raised = [f"    if (self->{f.name}) {{ flags |= {_flag(block, f)}; }}" for f in program.flags]
    return "\n".join(
        [
            f"/* {name}: see {stem}.h for how to call it. */",
            f'#include "{stem}.h"',
            "",
            "#ifdef __FAST_MATH__",
            '#error "-ffast-math rearranges operations and removes the test for NaN: compile without it"',
            "#endif",
            "#ifdef __clang__",
            "#pragma STDC FP_CONTRACT OFF",
            "#endif",
            "",
            f"{name}_settings {name}_designed(void) {{",
            f"    {name}_settings s;",
            *numbers,
            "    return s;",
            "}",
            "",
            *(line for operation in program.operations for line in writer.function(operation)),
            f"uint32_t {name}_flags(const {name} *self) {{",
            "    uint32_t flags = 0;",
            *raised,
            "    return flags;",
            "}",
            "",
        ]
    )


def usage(block: Block, stem: str) -> list[str]:
    """Ten lines of how to call it."""
    name, program = block.name, block.program
    u0, y0 = block.rest or (0.0, 0.0)
    where = "where the actuator stands"
    if block.rest is not None:
        where += f"; the design found the process at rest at u = {u0:.6g}, y = {y0:.6g}"
    step = program.operation("step")
    arguments = ", ".join(spoken(a.name) for a in step.arguments)
    lines = [
        "How to use it:",
        f"    static {name} loop;",
        f"    {name}_settings s = {name}_designed();",
        f"    if (!{name}_init(&loop, &s)) stop();",
        "        false: a setting is out of its range, nothing was touched; the numbers may be your own",
    ]
    if program.has("start"):
        lines += [
            f"    {name}_start(&loop, {block.arguments('start')});",
            f"        the first step returns u, {where}",
        ]
    lines += [
        f"    u = {name}_step(&loop, {arguments});",
        "        every h seconds, from a timer or a periodic task",
        f"    if ({name}_flags(&loop)) tell();",
        "        what each flag means stands beside it below",
    ]
    if program.has("manual"):
        lines += [
            f"    {name}_manual(&loop, true, u);",
            f"        the operator's output; {name}_manual(&loop, false, 0) goes back to automatic without a bump",
        ]
    if program.has("change"):
        lines += [f"    {name}_change(&loop, &s);", "        other settings while it runs, without a bump"]
    if program.has("measurement"):
        return [*lines, f"    y = {name}_measurement(raw);", "        the converter's number as a measurement"]
    return [*lines, "4..20 mA read as 0..27648:  y = y_low + raw*(y_high - y_low)/27648"]


def files(block: Block, options: Options, stem: str) -> dict[str, str]:
    """Header, source, and on request a main that tries it and an Arduino sketch."""
    made = {f"{stem}.c": source(block, stem), f"{stem}.h": header(block, options, stem)}
    if options.test_main:
        made[f"{stem}_test.c"] = test_main(block, stem)
    if options.arduino:
        made[f"{stem}.ino"] = sketch(block, stem)
    return made


LANGUAGE = Language("c", "C99", (".c", ".h"), files)
