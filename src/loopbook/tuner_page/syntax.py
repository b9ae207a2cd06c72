"""What the tokens of a script are: where brackets close, and which names are variables, which properties."""

import re
from collections.abc import Iterator

WORDS = frozenset(
    re.findall(
        r"\w+",
        """async await break case catch class const constructor continue default delete do else export extends
        false finally for from function get if import in instanceof let new null of return set static super
        switch this throw true try typeof undefined var void while yield arguments Infinity NaN""",
    )
)
TOKEN = re.compile(
    r"""(?P<space>(?:\s|//[^\n]*|/\*.*?\*/)+)
    |(?P<string>"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*')
    |(?P<number>0x[\da-fA-F]+|(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?)
    |(?P<name>[A-Za-z_$][\w$]*)
    |(?P<mark>=>|\.\.\.|\?\.(?!\d)|\?\?=|\?\?|\*\*=|\*\*|===|!==|==|!=|<=|>=|&&=|\|\|=|&&|\|\||\+\+|--|[-+*/%]=|>>>|>>|<<
        |[{}()\[\];,<>+\-*/%&|^!~?:=.])""",
    re.X | re.S,
)
LITERAL = re.compile(r"/(?:[^/\\\n\[]|\\.|\[(?:[^\]\\\n]|\\.)*\])+/[a-z]*")
BEFORE_LITERAL = frozenset(["(", ",", "=", ":", "[", "!", "&", "|", "?", "{", "}", ";", "=>", "&&", "||", "return"])
GLOBALS = frozenset(["Array", "Error", "Float64Array", "JSON", "Map", "Math", "Number", "Object", "Set", "String"])


def tokens(text: str) -> Iterator[tuple[str, str]]:
    """(kind, text) of each token; a template is cut at its insertions, which are tokens of their own."""
    at, before = 0, ";"
    open_braces: list[int] = []  # of each template's insertion: the braces open inside it
    while at < len(text):
        if text[at] == "`" or (text[at] == "}" and open_braces and open_braces[-1] == 0):
            if text[at] == "}":
                open_braces.pop()
            end = at + 1
            while text[end] != "`" and text[end : end + 2] != "${":
                end += 2 if text[end] == "\\" else 1
            end += 1 if text[end] == "`" else 2
            if text[end - 1] == "{":
                open_braces.append(0)
            kind, found = "template", text[at:end]
        elif text[at] == "/" and before in BEFORE_LITERAL and (literal := LITERAL.match(text, at)):
            kind, found = "literal", literal[0]
        else:
            match = TOKEN.match(text, at)
            if match is None:
                raise ValueError(f"no token of JavaScript: {text[at : at + 40]!r}")
            kind, found = str(match.lastgroup), match[0]
            if open_braces and found in "{}":
                open_braces[-1] += 1 if found == "{" else -1
        at += len(found)
        if kind != "space":
            before = found
            yield kind, found


VARIABLE, PROPERTY, SHORT = range(3)
NO_METHOD = frozenset(["if", "for", "while", "switch", "catch", "function"])


def roles_of(found: list[tuple[str, str]], closes: dict[int, int]) -> dict[int, int]:
    """What each name is: a variable, a property, or a variable that stands for a property of its name."""
    objects = _literals(found, closes)
    asked: list[int] = [0]  # for each open bracket: question marks without their colon
    inside: list[bool] = [False]  # is the bracket that of an object or pattern
    roles: dict[int, int] = {}
    for i, (kind, text) in enumerate(found):
        before = found[i - 1][1] if i else ";"
        after = found[i + 1][1] if i + 1 < len(found) else ";"
        if kind == "mark" and text in "([{":
            asked.append(0)
            inside.append(i in objects)
        elif kind == "mark" and text in ")]}":
            asked.pop()
            inside.pop()
        elif text == "?" and kind == "mark":
            asked[-1] += 1
        elif text == ":" and kind == "mark" and asked[-1]:
            asked[-1] -= 1
        elif kind == "name" and text not in WORDS:
            defines = (
                after == "(" and found[min(closes[i + 1] + 1, len(found) - 1)][1] == "{" and before not in NO_METHOD
            )
            key = inside[-1] and before in ("{", ",")
            if before in (".", "?.") or defines or (key and after == ":"):
                roles[i] = PROPERTY
            else:
                roles[i] = SHORT if key and after in (",", "}", "=") else VARIABLE
    return roles


def declared_in(found: list[tuple[str, str]], closes: dict[int, int]) -> set[str]:
    """The names of functions, classes and parameters, and those in patterns after const and let."""
    names = _in_declarations(found, closes)
    for i, (kind, text) in enumerate(found):
        after = found[i + 1][1] if i + 1 < len(found) else ";"
        if kind == "name" and (after == "=>" or (i and found[i - 1][1] in ("function", "class"))):
            names.add(text)
        elif text == "(" and kind == "mark":
            behind, ahead = found[closes[i] + 1 : closes[i] + 2], found[i - 1][1] if i else ";"
            if behind and (
                behind[0][1] == "=>" or (behind[0][1] == "{" and ahead not in NO_METHOD - {"catch", "function"})
            ):
                names |= {t for k, t in found[i : closes[i]] if k == "name"}
    return names - GLOBALS


def closing(found: list[tuple[str, str]]) -> dict[int, int]:
    """Where each bracket closes."""
    waiting: list[int] = []
    closes: dict[int, int] = {}
    depth_of_template: list[int] = []
    for i, (kind, text) in enumerate(found):
        if kind == "template":
            if text.startswith("}"):
                depth_of_template.pop()
            if text.endswith("${"):
                depth_of_template.append(i)
        elif kind == "mark" and text in "([{":
            waiting.append(i)
        elif kind == "mark" and text in ")]}":
            closes[waiting.pop()] = i
    return closes


def _literals(found: list[tuple[str, str]], closes: dict[int, int]) -> set[int]:
    """The braces that open an object or a pattern, not a block."""
    objects = {"=", "(", ",", ":", "[", "return", "const", "let", "...", "?", "??", "||", "&&"}
    return {i for i in closes if found[i][1] == "{" and (found[i - 1][1] if i else ";") in objects}


def _in_declarations(found: list[tuple[str, str]], closes: dict[int, int]) -> set[str]:
    """The names in patterns after const and let, of every declarator."""
    names: set[str] = set()
    for i, (kind, text) in enumerate(found):
        if kind != "name" or text not in ("const", "let"):
            continue
        j, expecting = i + 1, True
        while j < len(found):
            t = found[j][1]
            if t in (";", "of", "in", ")"):
                break
            if t in "([{" and j in closes:
                if expecting:
                    names |= {text for kind, text in found[j : closes[j]] if kind == "name"}
                j = closes[j]
            elif expecting and found[j][0] == "name":
                names.add(t)
            elif t == "=":
                expecting = False
            elif t == ",":
                expecting = True
            j += 1
    return names
