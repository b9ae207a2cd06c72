"""Letters of the mathematical alphabets (bold, script, double-struck, …) as the Unicode characters of their own."""

# variant: first code points of A, a, Α (capital alpha), α, 0; 0 where the alphabet has none
_BLOCKS = {
    "bold": (0x1D400, 0x1D41A, 0x1D6A8, 0x1D6C2, 0x1D7CE),
    "italic": (0x1D434, 0x1D44E, 0x1D6E2, 0x1D6FC, 0),
    "bold-italic": (0x1D468, 0x1D482, 0x1D71C, 0x1D736, 0x1D7CE),
    "script": (0x1D49C, 0x1D4B6, 0, 0, 0),
    "bold-script": (0x1D4D0, 0x1D4EA, 0, 0, 0),
    "fraktur": (0x1D504, 0x1D51E, 0, 0, 0),
    "bold-fraktur": (0x1D56C, 0x1D586, 0, 0, 0),
    "double": (0x1D538, 0x1D552, 0, 0, 0x1D7D8),
    "sans": (0x1D5A0, 0x1D5BA, 0, 0, 0x1D7E2),
    "bold-sans": (0x1D5D4, 0x1D5EE, 0x1D756, 0x1D770, 0x1D7EC),
    "mono": (0x1D670, 0x1D68A, 0, 0, 0x1D7F6),
}
# Characters that Unicode had before the block was made.
_HOLES = {
    "italic": {"h": "ℎ"},
    "script": dict(zip("BEFHILMRego", "ℬℰℱℋℐℒℳℛℯℊℴ", strict=True)),
    "fraktur": dict(zip("CHIRZ", "ℭℌℑℜℨ", strict=True)),
    "double": dict(zip("CHNPQRZ", "ℂℍℕℙℚℝℤ", strict=True)),
}
_GREEK_EXTRA = "∂ϵϑϰϕϱϖ"  # follow ω in every Greek block, in this order
_BOLD = {"italic": "bold-italic", "normal": "bold", "script": "bold-script", "roundhand": "bold-script"}
_BOLD |= {"fraktur": "bold-fraktur", "sans": "bold-sans"}


def combine(outer: str, inner: str) -> str:
    """The alphabet that results from one font command inside another: only bold adds to another alphabet.

    >>> combine("boldsymbol", ""), combine("script", "boldsymbol"), combine("bold", "sans")
    ('boldsymbol', 'bold-script', 'sans')
    """
    if not outer:
        return inner
    if outer == "boldsymbol":
        return "boldsymbol" if inner in ("", "italic", "boldsymbol") else _BOLD.get(inner, inner)
    if inner == "boldsymbol":
        return "bold" if outer == "normal" else _BOLD.get(outer, outer)
    return inner


def styled(char: str, variant: str) -> str | None:
    """The character of an alphabet, or None where the alphabet has no such letter.

    >>> styled("A", "bold"), styled("R", "double"), styled("α", "bold"), styled("1", "fraktur")
    ('𝐀', 'ℝ', '𝛂', None)
    """
    if variant == "roundhand":
        script = styled(char, "script")
        return script and script + "\ufe01"
    if variant == "boldsymbol":
        variant = "bold" if "Α" <= char <= "Ω" else "bold-italic"
    if variant not in _BLOCKS:
        return None
    if char in _HOLES.get(variant, {}):
        return _HOLES[variant][char]
    upper, lower, greek_upper, greek_lower, digits = _BLOCKS[variant]
    if "A" <= char <= "Z":
        return chr(upper + ord(char) - ord("A"))
    if "a" <= char <= "z":
        return chr(lower + ord(char) - ord("a"))
    if "0" <= char <= "9" and digits:
        return chr(digits + ord(char) - ord("0"))
    if "Α" <= char <= "Ω" and greek_upper:
        return chr(greek_upper + ord(char) - ord("Α"))
    if "α" <= char <= "ω" and greek_lower:
        return chr(greek_lower + ord(char) - ord("α"))
    if char in _GREEK_EXTRA and greek_lower:
        return chr(greek_lower + 25 + _GREEK_EXTRA.index(char))
    return None
