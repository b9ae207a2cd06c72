"""Writes docs/vendor-forms.md: one setting in every controller's form, with the equation and the manual it is from.

python tools/vendor_forms.py
"""

from pathlib import Path

from sympy import latex

from derivations.vendors.block import PERCENT_OF_RANGES, PERCENT_OUT
from derivations.vendors.catalogue import LEFT_OUT, by_name
from loopbook.controllers.pid_forms import PidStandard
from loopbook.vendors.entered import VendorFormError, enter, shown, vendor_forms

PAGE = Path(__file__).parents[1] / "docs" / "vendor-forms.md"
PID = PidStandard(2.0, 300.0, 48.0, b=1.0, N=10)
PI = PidStandard(2.0, 300.0, b=1.0)
RANGES = (0.0, 150.0), (0.0, 100.0)
SIGNALS = {PERCENT_OF_RANGES: "percent of both ranges", PERCENT_OUT: "the measurement's unit in, percent out"}

HEAD = """# What to type into a controller

`loopbook design` gives its recommended setting in the form of each controller below, in the report, in the JSON
(`enter`) and as `lb.enter(pid, form, y_range, u_range)`. Each form is the equation of a manual that was read; that its
entries give the same transfer function is proved in exact numbers. What a form cannot express is refused with its
reason.

    import loopbook as lb

    lb.enter(lb.PidStandard(2, 300, 48, b=1, N=10), "siemens-pid-compact", u_range=(0, 100))

The example in every section is this setting, {pid},
on a measuring range of 0 to 150 °C and an output of 0 to 100 %: 2 % per °C are 3 % per %. A form without derivative
action takes the PI with the same K and Ti.
"""


def page() -> str:
    """The whole page."""
    said = f"K = {PID.K:g} %/°C, Ti = {PID.Ti:g} s, Td = {PID.Td:g} s, Tf = {PID.Tf:g} s, b = {PID.b:g}, c = 0"
    left = ["## Not here", "", "Looked for and not found in a text that could be read:", ""]
    left += [f"- {name}: {reason}." for name, reason in LEFT_OUT.items()]
    return "\n\n".join([HEAD.format(pid=said).rstrip(), *map(section, vendor_forms()), "\n".join(left)]) + "\n"


def section(form: str) -> str:
    """One controller: manual, equation, entries, what it does otherwise."""
    block, (y_range, u_range) = by_name()[form], RANGES
    try:
        entered, refused = enter(PID, form, y_range, u_range), ""
    except VendorFormError as error:
        entered, refused = enter(PI, form, y_range, u_range), str(error).removeprefix(f"{block.title}: ")
    rows = [f"| `{t.name}` | {shown(t)} | {t.unit or '–'} |" for t in entered.typed]
    parts = [
        f"## {block.title}",
        f"`{form}`. {entered.block.manual}. Read there: {block.manual.read}.",
        f"$$C(s) = {latex(block.feedback)}$$",
        f"Signals: {SIGNALS.get(block.signals, 'the units of the plant')}.",
        "\n".join(["| entry | value | unit |", "|---|---|---|", *rows]),
        "Selected: " + "; ".join(entered.selections) + ".",
    ]
    if refused:
        parts.append(f"The PID of the example is refused: {refused}.")
    if entered.notes:
        parts.append("\n".join(f"- {note}" for note in entered.notes))
    return "\n\n".join(parts)


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
