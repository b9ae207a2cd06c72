"""A script made small: white space and comments left out, variables shortened, declarations put together.

A name at the top of the script gets one shorter name for the whole of it. A name inside one of its functions or classes
gets a shorter one there, the same wherever it stands in that function or class: no scopes have to be told apart.
A property keeps its name (after a dot, as a key, as a method), and where a variable stands for one in short form, as in
``{ a, b }``, the property is written out. What the script does not declare is the browser's. The tests run the small
script.
"""

from collections import Counter
from collections.abc import Iterator
from itertools import count, product

from loopbook.tuner_page.syntax import PROPERTY, SHORT, WORDS, closing, declared_in, roles_of, tokens

SHORTER = {"Infinity": "1/0", "true": "!0", "false": "!1"}
LONG_GLOBALS = ("Float64Array", "globalThis", "document")
STATIC = frozenset(("Math", "Number", "Object"))  # what they have needs no `this`
TOPS = frozenset(["const", "let", "function", "class", ";"])
RESERVED = 23
ITSELF, OFTEN = "itself", 4  # how often a method says `this` before a name for it is shorter
LETTERS = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"


def _short_names(taken: set[str]) -> Iterator[str]:
    for length in count(1):
        for letters in product(LETTERS, repeat=length):
            name = "".join(letters)
            if name not in taken and name not in WORDS:
                yield name


def _pieces(found: list[tuple[str, str]], closes: dict[int, int]) -> list[int]:
    """For each token the number of the statement at the top of the script, or of the method, in which it stands."""
    piece, at, numbers, in_class = 0, 0, [], -1
    while at < len(found):
        opens_class = found[at][1] == "{" and in_class < 0 and _is_class(found, at)
        if opens_class:
            in_class = closes[at]
        end = closes.get(at, at) if found[at][0] == "mark" and not opens_class else at
        numbers += [piece] * (end + 1 - at)
        following = found[end + 1][1] if end + 1 < len(found) else ";"
        if end == in_class:
            in_class, piece = -1, piece + 1
        elif (found[end][1] == "}" and (in_class > 0 or following in TOPS)) or (found[end][1] == ";" and in_class < 0):
            piece += 1
        at = end + 1
    return numbers


def _is_class(found: list[tuple[str, str]], at: int) -> bool:
    """Does this brace open the body of a class?"""
    before = [text for _, text in found[max(at - 4, 0) : at]]
    return before[-2:-1] == ["class"] or (before[-2:-1] == ["extends"] and before[-4:-3] == ["class"])


def _at_top(found: list[tuple[str, str]], closes: dict[int, int]) -> set[str]:
    """The names declared at the top of the script."""
    names: set[str] = set()
    at = 0
    while at < len(found):
        if found[at][1] in ("const", "let", "function", "class"):
            names.add(found[at + 1][1])
        at = (closes[at] if found[at][0] == "mark" and at in closes else at) + 1
    return names


def _renamed(found: list[tuple[str, str]], keep: frozenset[str], properties: frozenset[str]) -> list[str]:
    """The tokens with their new names. properties: those that get one, too."""
    closes = closing(found)
    roles, pieces, top = roles_of(found, closes), _pieces(found, closes), _at_top(found, closes)
    declared = declared_in(found, closes) - WORDS - keep
    variables = [i for i, role in roles.items() if role != PROPERTY and found[i][1] in declared]
    taken = {found[i][1] for i, role in roles.items() if role != PROPERTY and found[i][1] not in declared}
    uses = Counter(found[i][1] for i in variables)
    everywhere = sorted((n for n in top if n in uses), key=lambda n: (-uses[n], n))
    singles = set(LETTERS[:RESERVED])  # for what is inside; the top has the rest
    names_of_top = dict(zip(everywhere, _short_names(taken | singles), strict=False))
    inside: dict[int, Counter[str]] = {}
    for i in variables:
        if found[i][1] not in top:
            inside.setdefault(pieces[i], Counter())[found[i][1]] += 1
    names = {}
    for piece, counted in inside.items():
        ordered = sorted(counted, key=lambda n: (-counted[n], n))
        names[piece] = dict(zip(ordered, _short_names(taken | set(names_of_top.values())), strict=False))
    words = [_literal(kind, text) for kind, text in found]
    others = dict(zip(sorted(properties), _short_names({text for kind, text in found if kind == "name"}), strict=False))
    for i, role in roles.items():
        if role == PROPERTY:
            words[i] = others.get(words[i], words[i])
    for i in variables:
        name = found[i][1]
        short = names_of_top[name] if name in top else names[pieces[i]][name]
        words[i] = f"{others.get(name, name)}:{short}" if roles[i] == SHORT else short
    return words


def _together(words: list[str], kinds: list[str]) -> list[str]:
    """``const`` as ``let``; declarations that follow each other as one; ``(a) => `` as ``a => ``."""
    words = ["let" if kind == "name" and word == "const" else word for word, kind in zip(words, kinds, strict=True)]
    result: list[str] = []
    open_brackets: list[str] = []
    declares: list[bool] = [False]  # at each depth: is the statement a declaration
    for i, (word, kind) in enumerate(zip(words, kinds, strict=True)):
        before = words[i - 1] if i else ";"
        if kind == "name" and word == "let":
            if before == ";" and declares[-1] and result[-1] == ";" and (not open_brackets or open_brackets[-1] == "{"):
                result[-1] = ","
                continue
            declares[-1] = not open_brackets or open_brackets[-1] == "{"
        elif before in (";", "{", "}") and not (kind == "mark" and word in ",.;)?:"):
            declares[-1] = False
        if kind == "mark" and word in "([{":
            open_brackets.append(word)
            declares.append(False)
        elif kind == "mark" and word in ")]}":
            open_brackets.pop()
            declares.pop()
        lone = word == "=>" and result[-1] == ")" and result[-3:-2] == ["("] and kinds[i - 2] == "name"
        if lone and (len(result) < 4 or result[-4] not in ("function", "async")):
            result[-3:] = [result[-2]]
        result.append(word)
    return result


def _literal(kind: str, text: str) -> str:
    """A number or word in its shortest form."""
    if kind == "number" and text.startswith("0."):
        return text[1:]
    return SHORTER.get(text, text) if kind == "name" else text


def _itself(found: list[tuple[str, str]]) -> list[tuple[str, str]]:
    """``this`` by a name of its own in a method that says it often."""
    closes = closing(found)
    inserted: set[int] = set()
    renamed: set[int] = set()
    for at in (i for i in closes if _is_class(found, i)):
        i = at + 1
        while i < closes[at]:
            if found[i][1] != "{":
                i = closes.get(i, i) + 1
                continue
            body = range(i + 1, closes[i])
            uses = [j for j in body if found[j] == ("name", "this")]
            if len(uses) >= OFTEN and not {"super", "function", "class"} & {found[j][1] for j in body}:
                inserted.add(i)
                renamed.update(uses)
            i = closes[i] + 1
    result: list[tuple[str, str]] = []
    for i, token in enumerate(found):
        result.append(("name", ITSELF) if i in renamed else token)
        if i in inserted:
            result += [("name", "const"), ("name", ITSELF), ("mark", "="), ("name", "this"), ("mark", ";")]
    return result


def _members(words: list[str]) -> list[str]:
    """``Math.abs`` and its like, and long globals, by one letter or two, declared at the beginning."""
    at = [i for i in range(len(words) - 2) if words[i] in STATIC and words[i + 1] == "."]
    uses = Counter(f"{words[i]}.{words[i + 2]}" for i in at)
    letters = _short_names(set(words))
    names = {member: next(letters) for member, n in uses.most_common() if n > 4}
    if not names:
        return words
    for i in at:
        member = f"{words[i]}.{words[i + 2]}"
        if member in names:
            words[i : i + 3] = [names[member], "", ""]
    globals_used = Counter(w for i, w in enumerate(words) if w in LONG_GLOBALS and words[i - 1] not in (".", "?."))
    for member, n in globals_used.items():
        if n > 4:
            names[member] = next(letters)
            words = [names[w] if w == member and words[i - 1] not in (".", "?.") else w for i, w in enumerate(words)]
    declared = ",".join(f"{name}={member}" for member, name in names.items())
    return [f"let {declared}", ";", *(word for word in words if word)]


def small(text: str, keep: frozenset[str] = frozenset(), properties: frozenset[str] = frozenset()) -> str:
    """The same script, small. keep: names that others use. properties: the script's own, which may be renamed: none may
    be one of the browser's, nor stand in a text.

    >>> small("const found = { depth: 1 };  // remark\\nlet other = found.depth + found.depth;")
    'let x={depth:1},y=x.depth+x.depth;'
    >>> small("function far(depth) { const found = { depth }; return found; }")
    'function x(a){let b={depth:a};return b}'
    """
    found = _itself(list(tokens(text)))
    words = _members(_together(_renamed(found, keep, properties), [kind for kind, _ in found]))
    parts: list[str] = []
    before = ""
    for word in words:
        glued = before[-1:].isalnum() or before[-1:] in ("_", "$")
        if (glued and (word[0].isalnum() or word[0] in "_$")) or (before[-1:] in ("+", "-") and word[0] == before[-1]):
            parts.append(" ")
        if word == "}" and before == ";":
            parts.pop()
        parts.append(word)
        before = word
    return "".join(parts)
