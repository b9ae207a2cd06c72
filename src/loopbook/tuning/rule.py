"""A tuning rule that runs: the family's one form, whether formulas compute it or an algorithm.

    rule(data, **options) -> Tuning

data: a `Process`, what experiments tell of it, an identified model; `process_data` says how the one leads to the other.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

from derivations.tuning.takes import Takes
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.result import RuleDoesNotApply, Tuning

REQUIRED = "required"


@dataclass(frozen=True)
class TuningRule:
    """One rule with what is known of it; call it with data.

    name: in `loopbook.tuning.RULES`. title: in tables. takes: what it must know of the process. action: P, PI or PID.
    integrating: for integrating processes (True), stable ones (False), both (None). aim: what its settings are meant
    for. year, source: when (None: no date is known) and who. options: by name, what they are; those in `required` must
    be given. variant_of: the rule of which this is another source's variant. text: its formulas or its idea. instead:
    the names of the rules for processes that integrate, or do not, with this action.

    >>> from loopbook.tuning.registry import rules
    >>> rules()["amigo-step-pid"].action, rules()["amigo-step-pid"].year
    ('PID', 2006)
    """

    name: str
    title: str
    takes: Takes
    action: str
    integrating: bool | None
    aim: str
    year: int | None
    source: str
    settings: Callable[..., Tuning] = field(repr=False, compare=False)
    options: Mapping[str, str] = field(default_factory=dict)
    required: tuple[str, ...] = ()
    variant_of: str = ""
    text: str = field(default="", repr=False)
    instead: Callable[[bool | None, str], Sequence[str]] = field(default=lambda *_: (), repr=False, compare=False)

    def __call__(self, *known: Any, **options: Any) -> Tuning:
        """The settings for a process. known: as for `ProcessData.of`. options: those of the rule.

        A process whose gain is negative is tuned with the sign of u turned, and K is turned back.
        Raises RuleDoesNotApply where the rule does not cover the process, TypeError for an unknown option.
        """
        for name in sorted(set(options) - set(self.options)):
            takes = ", ".join(self.options) or "none"
            raise TypeError(f"{self.name} has no option {name!r}; its options: {takes}")
        missing = [name for name in self.required if options.get(name) is None]
        if missing:
            raise RuleDoesNotApply(
                f"{self.name} needs {' and '.join(f'{name}: {self.options[name]}' for name in missing)}"
            )
        data = ProcessData.of(*known)
        given = {name: value for name, value in options.items() if value is not None}
        try:
            found = self.settings(data, **given)
        except RuleDoesNotApply as error:
            raise self._refused(error, data) from None
        if data.sign > 0:
            return found
        note = "the process answers with the other sign: K is negative"
        return replace(found, pid=replace(found.pid, K=-found.pid.K), notes=(*found.notes, note))

    def _refused(self, error: RuleDoesNotApply, data: ProcessData) -> RuleDoesNotApply:
        """The refusal with the rule's name, and with the rules that take what is known instead."""
        advice = error.advice
        wrong = data.integrates is not None and self.integrating not in (None, data.integrates)
        if not advice and wrong:
            advice = f"use {', '.join(self.instead(data.integrates, self.action))}"
        named = error.reason.lower().startswith(self.name.split("-")[0])
        return RuleDoesNotApply(error.reason if named else f"{self.name}: {error.reason}", advice)

    def fits(self, integrates: bool | None) -> bool:
        """Is it meant for such a process (True: integrating), no variant of another, and complete without options?"""
        same = integrates is None or self.integrating in (None, integrates)
        return same and not self.variant_of and not self.required

    def __str__(self) -> str:
        year = f" ({self.year})" if self.year else ""
        head = f"{self.title}: {self.action} from {self.takes}; {self.aim or 'no aim stated'}"
        return "\n".join([head, *(f"    {line}" for line in self.text.splitlines()), f"source: {self.source}{year}"])
