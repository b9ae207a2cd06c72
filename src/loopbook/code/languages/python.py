"""Python: one class without imports; floats, fractions and NumPy scalars all run."""

from sympy import Integer, Rational
from sympy.printing.pycode import PythonCodePrinter

from derivations.programs.form import Do, Fill, Operation
from loopbook.code.block import Block
from loopbook.code.language import Language, Options
from loopbook.code.writing import WIDTH, Arithmetic, Writer, kept_names, spoken, wrapped


class PythonArithmetic(Arithmetic, PythonCodePrinter):
    """Frozen arithmetic in Python."""

    both, either, unless = " and ", " or ", "not "
    true, false = "True", "False"

    def _print_Integer(self, node: Integer) -> str:
        return str(int(node))

    def _print_Rational(self, node: Rational) -> str:
        return repr(float(node))


class PythonWriter(Writer):
    """Statements inside a method; new settings are arguments of the same name."""

    opening, chained, middle, closing = "if {}:", "elif {}:", "else:", ""
    assignment = "{} = {}"
    note = "  # {}"

    def __init__(self, block: Block):
        program = block.program
        settings = {s.symbol: f"self.{spoken(s.name)}" for s in program.settings}
        new = {s.new: spoken(s.name) for s in program.settings}
        states = {symbol: f"self.{name}" for symbol, name in kept_names(program).items()}
        super().__init__(program, PythonArithmetic(settings | new | states))
        self.block = block

    def broken(self, line: str, indent: str) -> list[str]:
        """In parentheses, so that Python reads on."""
        target, _, value = line.partition(" = ")
        lines = super().broken(f"{target} = ({value}", indent)
        return [*lines[:-1], lines[-1] + ")"]

    def filled(self, statement: Fill, depth: int) -> list[str]:
        size = self.program.variables()[statement.buffer].size
        name, value = self.arithmetic.text(statement.buffer), self.arithmetic.text(statement.value)
        return [f"{self.tab * depth}{name} = [{value}] * {size}"]

    def done(self, statement: Do, depth: int) -> list[str]:
        operation = self.program.operation(statement.operation)
        given = [f"{spoken(s.name)}" for s in self.program.settings] if operation.takes_settings else []
        name = operation.name if operation.public else f"_{operation.name}"
        call = f"self.{name}({', '.join(given)})"
        if operation.result is not None:
            call = f"{self.arithmetic.text(operation.result)} = {call}"
        line = self.tab * depth + call
        return (
            [line]
            if len(line) <= WIDTH
            else [line[: line.index("(") + 1], *wrapped(given, 4 * depth + 4), f"{self.tab * depth})"]
        )

    def method(self, operation: Operation) -> list[str]:
        """A whole method; private ones begin with an underscore."""
        given = [spoken(s.name) for s in self.program.settings] if operation.takes_settings else []
        given += [spoken(a.name) for a in operation.arguments]
        owner = [] if operation.pure else ["self"]
        decorator = ["    @staticmethod"] if operation.pure else []
        name = operation.name if operation.public else f"_{operation.name}"
        back = [] if operation.result is None else [f"        return {self.arithmetic.text(operation.result)}"]
        head = [f"    def {name}({', '.join([*owner, *given])}):"]
        if len(head[0]) > WIDTH:
            head = [f"    def {name}(", *wrapped([*owner, *given], 8), "    ):"]
        return [*decorator, *head, f'        """{operation.about}"""', *self.lines(operation.body, 2), *back, ""]


def text(block: Block) -> str:
    """The class."""
    program = block.program
    writer = PythonWriter(block)
    names = [spoken(s.name) for s in program.settings]
    defaults = wrapped([f"{n}={v!r}" for n, v in block.settings().items()], 8)
    slots = wrapped([f'"{n}"' for n in (*names, *kept_names(program).values())], 8)
    usage = [
        f"loop = {block.title}()",
        f"loop.start({block.arguments('start')})",
        f"u = loop.step({block.arguments('step')})",
    ]
    if not program.has("start"):
        del usage[1]
    about = [f"    {spoken(s.name)}: {s.about}." for s in program.settings]
    return "\n".join(
        [
            f'"""{block.name}: {program.law}.',
            "",
            f"{program.about}",
            *block.notes,
            "",
            "    " + "    ".join(f"{line}\n" for line in usage).rstrip(),
            "",
            "Equation numbers are those of the report on the PID controller (pid-report, chapter 4).",
            '"""',
            "",
            'inf = float("inf")',
            "",
            "",
            f"class {block.title}:",
            '    """Settings; each has the number of the design as its default.',
            "",
            *about,
            "    Raises ValueError where one is out of its range.",
            '    """',
            "",
            "    __slots__ = (",
            *slots,
            "    )",
            "",
            "    def __init__(",
            "        self,",
            *defaults,
            "    ):",
            "        if not self.init(",
            *wrapped(names, 12),
            "        ):",
            "            raise ValueError(",
            '                "a setting is out of its range: "',
            *(f'                f"{n} = {{{n}!r}} "' for n in names),
            "            )",
            "",
            *(line for operation in program.operations for line in writer.method(operation)),
            "    def flags(self):",
            '        """The flags that are up, by name."""',
            "        names = (",
            *wrapped([f'"{f.name}"' for f in program.flags], 12),
            "        )",
            "        return [name for name in names if getattr(self, name)]",
            "",
        ]
    )


def files(block: Block, options: Options, stem: str) -> dict[str, str]:
    """One module."""
    return {f"{stem}.py": text(block)}


LANGUAGE = Language("py", "Python", (".py",), files)
