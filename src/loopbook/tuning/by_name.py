"""Settings for a process by a rule's name, by several, or by every rule that applies, side by side."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from loopbook.plots.plain_table import PlainTable, ShownAsTable
from loopbook.plots.short_repr import ShortRepr
from loopbook.tuning.process_data import ProcessData
from loopbook.tuning.registry import named, rules
from loopbook.tuning.result import RuleDoesNotApply, Tuning
from loopbook.tuning.rule import TuningRule

ACTIONS = ("PI", "PID", "P")
"""What a name that leaves it open means, in this order."""


@dataclass(frozen=True, repr=False)
class Tunings(ShortRepr, ShownAsTable, Mapping[str, Tuning]):
    """Settings by the rule's name. refused: by name, why a rule does not apply. Shows itself as a table."""

    found: Mapping[str, Tuning]
    refused: Mapping[str, str] = field(default_factory=dict)

    def __getitem__(self, name: str) -> Tuning:
        return self.found[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.found)

    def __len__(self) -> int:
        return len(self.found)

    def table(self) -> PlainTable:
        """The settings as a table; below it the rules that do not apply, with the reason."""
        rows = [[name, t.K, t.Ti, t.Td, t.b, "; ".join(t.notes)] for name, t in self.found.items()]
        notes = [f"{name} does not apply: {reason}" for name, reason in self.refused.items()]
        return PlainTable(["rule", "K", "Ti [s]", "Td [s]", "b", "mind"], rows, notes)


def tune(known: Any, rule: str | Sequence[str] = "", action: str = "", *, all: bool = False, **options: Any) -> Any:
    """Settings for a process: a `Tuning` by one rule, `Tunings` by several.

    known: a `Process`, data of experiments (`StepData`, `FrequencyData`, ... or several in a tuple), what an experiment
    or an identification found. What the rule takes follows by the method that `loopbook.tuning.process_data` names, and
    the result's `known_by` says which. rule: a name of `loopbook.tuning.RULES`, or a part of one that leaves open what
    the data decide ("simc", "amigo", "ziegler-nichols ultimate"); several names in a list. action: "P", "PI" or "PID";
    a name that leaves it open means PI where there is one. all: every rule that applies, with the reasons of the
    others. options: those of the rule, such as closed [s] of "lambda" and "simc" or M of "migo".
    Raises UnknownRule with the nearest names, RuleDoesNotApply with what to do, TypeError for an unknown option.

    >>> from loopbook.process.transfer_function import Process
    >>> process = Process([2], [40, 14, 1], delay=3)                 # 2 e^(-3s)/((10 s + 1)(4 s + 1))
    >>> tuning = tune(process, "simc", "PI")
    >>> round(tuning.K, 4), round(tuning.Ti, 4), tuning.known_by
    (0.6, 12.0, 'half rule on 2 lags')
    >>> list(tune(process, ["simc", "lambda"], "PID"))
    ['simc-pid', 'lambda-pid']
    """
    data = ProcessData.of(known)
    if all:
        chosen = [r for r in rules().values() if r.fits(data.integrates) and action.upper() in ("", r.action)]
        meant = [rule] if isinstance(rule, str) else rule
        return _side_by_side(data, [r for r in chosen if not rule or any(r in named(m) for m in meant)], options)
    if not isinstance(rule, str):
        return _side_by_side(data, [_chosen(data, name, action) for name in rule], options)
    if not rule:
        raise RuleDoesNotApply("tune needs a rule's name, such as simc or amigo, or all=True for every rule")
    return _chosen(data, rule, action)(data, **options)


def _chosen(data: ProcessData, name: str, action: str) -> TuningRule:
    """Of the rules that a name means, the first that is meant for the process and finds what it takes."""
    meant = named(name, action)
    wanted = next((a for a in ACTIONS if any(r.action == a for r in meant)), "") if not action else action.upper()
    meant = [r for r in meant if r.action == wanted]
    fitting = [r for r in meant if data.integrates is None or r.integrating in (None, data.integrates)] or meant
    return next((r for r in fitting if _finds(r, data)), fitting[0])


def _finds(rule: TuningRule, data: ProcessData) -> bool:
    try:
        return bool(data.numbers(rule.takes)) if rule.takes != "a process" else data.model is not None
    except RuleDoesNotApply:
        return False


def _side_by_side(data: ProcessData, chosen: list[TuningRule], options: Mapping[str, Any]) -> Tunings:
    """Each rule with those of the options that it has."""
    unknown = [name for name in options if not any(name in rule.options for rule in chosen)]
    if unknown:
        raise TypeError(f"none of {', '.join(rule.name for rule in chosen)} has an option {unknown[0]!r}")
    found, refused = {}, {}
    for rule in chosen:
        try:
            found[rule.name] = rule(data, **{name: value for name, value in options.items() if name in rule.options})
        except RuleDoesNotApply as error:
            refused[rule.name] = error.reason.removeprefix(f"{rule.name}: ")
    return Tunings(found, refused)
