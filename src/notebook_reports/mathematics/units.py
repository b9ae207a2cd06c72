r"""``\SI{9.81}{\metre\per\second\squared}`` and its kin: numbers and units of siunitx, their common uses, as LaTeX.

>>> latex_of_unit(r"\metre\per\second\squared")
'\\mathrm{m}\\,\\mathrm{s}^{-2}'
>>> latex_of_number("1.5e-3")
'1.5\\times 10^{-3}'
"""

import re

PREFIXES = {
    **{"yocto": "y", "zepto": "z", "atto": "a", "femto": "f", "pico": "p", "nano": "n", "micro": "µ", "milli": "m"},
    **{"centi": "c", "deci": "d", "deca": "da", "hecto": "h", "kilo": "k", "mega": "M", "giga": "G", "tera": "T"},
    **{"peta": "P", "exa": "E", "zetta": "Z", "yotta": "Y", "kibi": "Ki", "mebi": "Mi", "gibi": "Gi"},
}
UNITS = {
    **{"metre": "m", "meter": "m", "second": "s", "kilogram": "kg", "gram": "g", "ampere": "A", "kelvin": "K"},
    **{"mole": "mol", "candela": "cd", "hertz": "Hz", "newton": "N", "pascal": "Pa", "joule": "J", "watt": "W"},
    **{"coulomb": "C", "volt": "V", "farad": "F", "ohm": "Ω", "siemens": "S", "weber": "Wb", "tesla": "T"},
    **{"henry": "H", "lumen": "lm", "lux": "lx", "becquerel": "Bq", "gray": "Gy", "sievert": "Sv", "radian": "rad"},
    **{"steradian": "sr", "degree": "°", "degreeCelsius": "°C", "celsius": "°C", "minute": "min", "hour": "h"},
    **{"day": "d", "litre": "l", "liter": "L", "tonne": "t", "electronvolt": "eV", "bar": "bar", "decibel": "dB"},
    **{"bel": "B", "bit": "bit", "byte": "B", "percent": "%", "arcminute": "′", "arcsecond": "″", "angstrom": "Å"},
    **{"dalton": "Da", "atomicmassunit": "u", "hectare": "ha", "katal": "kat", "neper": "Np", "parsec": "pc"},
    **{"km": "km", "mm": "mm", "cm": "cm", "kg": "kg", "ms": "ms", "us": "µs", "ns": "ns", "Hz": "Hz", "kHz": "kHz"},
    **{"MHz": "MHz", "GHz": "GHz", "kPa": "kPa", "MPa": "MPa", "kN": "kN", "kW": "kW", "MW": "MW", "mV": "mV"},
    **{"kV": "kV", "mA": "mA", "eV": "eV", "keV": "keV", "MeV": "MeV", "GeV": "GeV", "kJ": "kJ", "mol": "mol"},
}
_POWERS = {"squared": "2", "cubed": "3"}
_BEFORE = {"square": "2", "cubic": "3"}
_PIECE = re.compile(r"\\([A-Za-z]+)|\{([^{}]*)\}|(\^)\s*(\{[^{}]*\}|-?\d+|.)|([.~*/])|([^\\{}^.~*/\s]+)|\s+")


def latex_of_unit(source: str) -> str:
    """The LaTeX of a unit, from siunitx' names or from letters such as ``m/s^2``."""
    factors: list[list[str]] = []
    prefix, sign, power, separator = "", "", "", r"\,"
    slash = False
    for found in _PIECE.finditer(source):
        name = found[1]
        if name in PREFIXES:
            prefix = PREFIXES[name]
        elif name == "per":
            sign = "-"
        elif name in _BEFORE:
            power = _BEFORE[name]
        elif name in _POWERS and factors:
            factors[-1][1] = factors[-1][1].replace("1", "") + _POWERS[name]
        elif name in ("tothe", "raiseto", "of"):
            continue
        elif found[2] is not None and factors:
            factors[-1][1] = factors[-1][1].replace("1", "") + found[2]
        elif found[3] and factors:
            factors[-1][1] += found[4].strip("{}")
        elif found[5]:
            slash = slash or found[5] == "/"
            sign = "-" if found[5] == "/" else sign
        elif name or found[6]:
            shown = UNITS.get(name or "", name or found[6])
            exponent = (sign + power) if power else ("-1" if sign else "")
            factors.append([prefix + shown, exponent])
            prefix, sign, power = "", "", ""
    return separator.join(_factor(unit, exponent) for unit, exponent in factors)


def _factor(unit: str, exponent: str) -> str:
    letters = unit if re.fullmatch("[A-Za-z]+", unit) else ""
    shown = rf"\mathrm{{{unit}}}" if letters else rf"\text{{{unit.replace('%', chr(92) + '%')}}}"
    return shown + (f"^{{{exponent}}}" if exponent else "")


def latex_of_number(source: str) -> str:
    """The LaTeX of a number: ``1e-3``, ``1.2 +- 0.1``, ``1.2(3)``, ``2 x 3``."""
    text = source.strip().replace(r"\pm", "+-")
    shown = re.sub(r"\s*\+-\s*", r" \\pm ", text)
    shown = re.sub(r"(?<=\d)\s*x\s*(?=\d)", r" \\times ", shown)
    shown = re.sub(r"(?<=\d)[eEdD]([+-]?\d+)", lambda m: rf"\times 10^{{{int(m[1])}}}", shown)
    return re.sub(r"^[eE]([+-]?\d+)$", lambda m: rf"10^{{{int(m[1])}}}", shown)


def latex_of_angle(source: str) -> str:
    """Degrees, minutes, seconds: ``12;30;5``."""
    marks = ("^{\\circ}", "^{\\prime}", "^{\\prime\\prime}")
    parts = source.split(";")
    return r"\,".join(part + mark for part, mark in zip(parts, marks, strict=False) if part.strip())
