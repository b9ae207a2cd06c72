"""The recommended setting as it is typed into each kind of controller, and what it then does in that controller."""

import math
from dataclasses import dataclass
from typing import Any

from loopbook.controllers.pid_forms import PidStandard
from loopbook.design.words import as_plain_text
from loopbook.loop.continuous import Loop
from loopbook.loop.sensitivity_peaks import sensitivity_peak
from loopbook.loop.transfer import LoopError
from loopbook.vendors.entered import Entered, VendorFormError, block_named, enter, shown, vendor_forms
from notebook_reports.display import Table, number


@dataclass(frozen=True)
class InController:
    """One form of the recommended setting.

    entered: None where it is refused, with the reason. Ms: of the loop with what the block makes of it (its own
    filter), infinite where that is unstable, NaN where it is not judged.
    """

    form: str
    entered: Entered | None
    reason: str = ""
    Ms: float = math.nan

    def data(self) -> dict[str, object]:
        """As plain data."""
        if self.entered is None:
            block = block_named(self.form)
            return {"form": self.form, "title": block.title, "manual": block.manual, "refused": self.reason}
        return {**self.entered.data(), "Ms": self.Ms if math.isfinite(self.Ms) else None}


def output_range(study: Any) -> tuple[float, float] | None:
    """What is 0 and 100 % of the output: of an input in % just that, else the actuator's limits; None where unknown."""
    found = study.identified
    if found is not None and found.record.input_unit == "%":
        return 0.0, 100.0
    return study.limits if all(map(math.isfinite, study.limits)) else None


def measuring_range(study: Any) -> tuple[float, float] | None:
    """The measuring range as given, 0 to 100 for an output in %; None where unknown."""
    if study.y_low is not None:
        return study.y_low, study.y_high
    found = study.identified
    return (0.0, 100.0) if found is not None and found.record.output_unit == "%" else None


def entered_forms(study: Any) -> list[InController]:
    """The recommended setting in every form, refused ones too."""
    pid = study.recommendation.chosen.candidate.pid
    found = []
    for form in vendor_forms():
        try:
            entered = enter(pid, form, measuring_range(study), output_range(study))
        except VendorFormError as error:
            found.append(InController(form, None, str(error).removeprefix(f"{block_named(form).title}: ")))
            continue
        found.append(InController(form, entered, "", _peak(study, entered.realised)))
    return found


def _peak(study: Any, realised: PidStandard) -> float:
    """Ms of the loop with the block's own filter."""
    try:
        loop = Loop(study.model.process, realised)
        return float(sensitivity_peak(loop.transfer).value) if loop.is_stable else math.inf
    except LoopError:
        return math.nan


def controllers_table(study: Any) -> Table:
    """What to type in, controller by controller, with the manual that says so."""
    rows, marks = [], []
    for one in entered_forms(study):
        block = block_named(one.form)
        manual = as_plain_text(block.manual)
        if one.entered is None:
            rows.append([block.title, f"cannot be entered: {as_plain_text(one.reason)}", "–", manual])
            marks.append("note")
            continue
        typed = [f"`{t.name}` = {shown(t)} {as_plain_text(t.unit)}".rstrip() for t in one.entered.typed]
        parts = [", ".join(typed), *map(as_plain_text, one.entered.selections)]
        Ms = number(one.Ms, 3) if math.isfinite(one.Ms) else "unstable" if one.Ms == math.inf else "–"
        rows.append([block.title, "; ".join(parts), Ms, manual])
        marks.append("bad" if one.Ms == math.inf else "")
    heads = ["controller", "what to type in", "$M_s$ there", "read in"]
    chosen = study.recommendation.chosen.candidate.name
    notes = (
        () if measuring_range(study) else ("Span of y: the measuring range's upper less its lower end, in units of y.",)
    )
    return Table(heads, rows, f"{chosen} in the controller's own form", ["left", "left", "right", "left"], notes, marks)


def differences_table(study: Any) -> Table:
    """What each block does otherwise than the recommended setting, a sentence each."""
    rows = [
        [one.entered.block.title, " ".join(as_plain_text(text) for text in one.entered.notes)]
        for one in entered_forms(study)
        if one.entered is not None and one.entered.notes
    ]
    return Table(["controller", "does otherwise"], rows, "What the blocks do otherwise", ["left", "left"])
