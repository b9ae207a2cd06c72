"""The page of the tuning rules: their formulas as derived, where they come from, when they are not to be used."""

from pathlib import Path

from sympy import latex

from derivations.tuning.catalogue import catalogue
from loopbook.tuning.registry import RULES


def write(file: Path) -> None:
    """One section for each rule, in the order of `loopbook.tuning.RULES`."""
    published = catalogue()
    lines = ["# Tuning rules", "", f"All {len(RULES)} rules by the name that `lb.tune(process, name)` takes.", ""]
    for name, rule in RULES.items():
        lines += [f"## {name}", "", f"{rule.title}: {rule.action} for processes of which it takes {rule.takes.value}."]
        lines += [
            f"Source: {rule.source}" + (f" ({rule.year})." if rule.year and str(rule.year) not in rule.source else "."),
            "",
        ]
        if name in published:
            rows = (f"{latex(e.lhs)} &= {latex(e.rhs)}" for e in published[name].equations().values())
            lines += ["$$", r"\begin{aligned}", " \\\\ ".join(rows), r"\end{aligned}", "$$", ""]
        else:
            lines += ["Computed, not a formula.", ""]
    file.write_text("\n".join(lines), encoding="utf-8")
