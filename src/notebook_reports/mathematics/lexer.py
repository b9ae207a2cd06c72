"""LaTeX characters into tokens, with the position of each."""

from dataclasses import dataclass

from notebook_reports.mathematics.errors import MathError


@dataclass(frozen=True)
class Token:
    """kind: "command" (text without the backslash), "char" (one character, also { } & ^ _) or "end"."""

    kind: str
    text: str
    position: int
    end: int

    def is_command(self, *names: str) -> bool:
        return self.kind == "command" and self.text in names

    def is_char(self, chars: str) -> bool:
        return self.kind == "char" and self.text in chars

    def __str__(self) -> str:
        return {"command": "\\" + self.text, "end": "the end of the formula"}.get(self.kind, self.text)


class Lexer:
    """Reads ``latex[position:limit]``; skips blanks and comments; text arguments are read raw."""

    def __init__(self, latex: str, position: int = 0, limit: int | None = None):
        self.latex = latex
        self.position = position
        self.limit = len(latex) if limit is None else limit

    def error(self, reason: str, position: int) -> MathError:
        return MathError(reason, self.latex, position)

    def _skip_blanks(self) -> None:
        while self.position < self.limit:
            if self.latex[self.position] == "%":
                end = self.latex.find("\n", self.position, self.limit)
                self.position = self.limit if end < 0 else end + 1
            elif self.latex[self.position] in " \t\n\r":
                self.position += 1
            else:
                return

    def peek(self) -> Token:
        """The next token, not consumed."""
        self._skip_blanks()
        start = self.position
        if start >= self.limit:
            return Token("end", "", start, start)
        if self.latex[start] != "\\":
            return Token("char", self.latex[start], start, start + 1)
        end = start + 1
        if end >= self.limit:
            raise self.error("a backslash with no command after it", start)
        while end < self.limit and self.latex[end].isascii() and self.latex[end].isalpha():
            end += 1
        if end == start + 1:
            name = " " if self.latex[end] in " \t\n\r" else self.latex[end]
            return Token("command", name, start, end + 1)
        return Token("command", self.latex[start + 1 : end], start, end)

    def next(self) -> Token:
        """The next token, consumed."""
        token = self.peek()
        self.position = token.end
        return token

    def take(self, char: str) -> bool:
        """Consume the character if it comes next."""
        if self.peek().is_char(char):
            self.next()
            return True
        return False

    def raw_argument(self, command: str) -> tuple[str, int]:
        """The characters of a braced argument as written, and where they start."""
        token = self.peek()
        if not token.is_char("{"):
            raise self.error(f"{command} needs an argument in braces, found {token}", token.position)
        start = token.end
        depth, i = 1, start
        while i < self.limit:
            char = self.latex[i]
            if char == "\\":
                i += 1
            elif char in "{}":
                depth += 1 if char == "{" else -1
                if depth == 0:
                    self.position = i + 1
                    return self.latex[start:i], start
            i += 1
        raise self.error(f"{{ of {command} is never closed: add }}", token.position)

    def raw_or_single(self, command: str) -> tuple[str, int]:
        """The characters of an argument in braces, or of the one command or character that stands there."""
        token = self.peek()
        if token.is_char("{") or token.kind == "end" or token.is_char("}&"):
            return self.raw_argument(command)
        self.next()
        return self.latex[token.position : token.end], token.position

    def raw_option(self) -> tuple[str, int] | None:
        """The characters of an argument in square brackets, if there is one."""
        token = self.peek()
        if not token.is_char("["):
            return None
        end = self.latex.find("]", token.end, self.limit)
        if end < 0:
            raise self.error("[ is never closed: add ]", token.position)
        self.position = end + 1
        return self.latex[token.end : end], token.end
