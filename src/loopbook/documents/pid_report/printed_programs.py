"""The document's own programs, as they stand in figures 4.7 and 4.9 to 4.13, to be run and compared."""

import ast
from typing import Any

from derivations.programs import bumpless
from derivations.programs import pid_code as code
from loopbook.controllers import generated
from loopbook.controllers.settings import PidSettings
from loopbook.numerics.real_numbers import Number

FIGURES = ("4.7", "4.9", "4.10", "4.11", "4.12", "4.13", "shortest")


class ProgramController:
    """One program of pid-report, built from its derived assignments.

    figure: one of `FIGURES`. settings: `PidSettings` with c = 0 and Ti given (rate and anti_windup are not used: each
    program has its own). states: start values by name, the rest 0; names as in the listing, e.g. "y_fold", "x", "I".
    gains: gains that replace the derived ones by name, to run a misprint.
    Raises ValueError for an unknown figure or state.
    """

    def __init__(self, figure: str, settings: PidSettings, gains: dict[str, Any] | None = None, **states: Any):
        if figure not in FIGURES:
            raise ValueError(f"figure {figure!r} has no program; one of {', '.join(FIGURES)}")
        self.figure = figure
        self._pass = generated.program_pass(figure)
        self.states: dict[str, Any] = dict.fromkeys(self.state_names(figure), 0)
        for name in states:
            if name not in self.states:
                raise ValueError(f"figure {figure} has no state {name!r}; it has {', '.join(self.states)}")
        self.states |= states
        self._replaced = gains or {}
        self.change(settings)
        self.u = self.v = None

    @staticmethod
    def state_names(figure: str) -> tuple[str, ...]:
        program = {**code.programs(), "4.7": code.conditional(), "shortest": code.shortest()}[figure]
        return tuple(s.name for s in program.states())

    def change(self, settings: PidSettings) -> None:
        """Put in other settings; the states stay, as in the programs without eq. 4.10."""
        s = settings
        numbers = {"K": s.K, "T_i": s.Ti, "T_d": s.Td, "T_f": s.Tf, "b": s.b, "h": s.h, "T_t": s.Tt}
        self.settings = settings
        self._known = numbers | generated.program_gains(self.figure)(**numbers) | self._replaced
        self._known |= {"u_low": s.u_low, "u_high": s.u_high}

    def step(self, y: Number, y_sp: Number) -> Number:
        """One pass: the output for this sample."""
        result = self._pass(self._known | self.states | {"y_sp": y_sp, "y": y})
        self.u, self.v = result["u"], result["v"]
        self.states = {name: result[name] for name in self.states}
        return self.u


def runs_first_pass(figure: str, settings: PidSettings, started: bool) -> bool:
    """Does the first pass of a program run? started: with zeros in its memories, or as printed, with nothing in them.

    >>> [runs_first_pass("4.9", PidSettings(K=1, Ti=2, Td=1, Tf=1, h=1), started) for started in (False, True)]
    [False, True]
    """
    program = ProgramController(figure, settings)
    if not started:
        program.states = dict.fromkeys(program.states)
    try:
        program.step(1, 2)
    except TypeError:  # arithmetic with what was never set
        return False
    return True


def changes_once(reads_first: bool, settles: bool) -> bool:
    """After a change of K: does the line for bumpless changes run in every pass, and change I in the first one only?

    As eq. 4.10, before a measurement that stands still is read, or after it (reads_first); at the end of a pass the old
    settings become the new ones (settles), or stay as they were.

    >>> changes_once(False, False), changes_once(True, True)
    (False, True)
    """
    line, old = bumpless.keep_p_plus_i().rhs, bumpless.OLD
    new = dict.fromkeys(bumpless.NEW.values(), 1) | {bumpless.NEW[bumpless.SETTINGS["K"]]: 2}
    known = new | dict.fromkeys(old.values(), 1) | {code.ysp: 3, bumpless.I_old: 0}
    measured, sums = {code.y: 1}, []
    for _ in range(3):
        known |= measured if reads_first else {}
        sums.append(line.subs(known))
        known |= measured | {bumpless.I_old: sums[-1]}
        known |= {symbol: new[bumpless.NEW[setting]] for setting, symbol in old.items()} if settles else {}
    return not any(I.free_symbols for I in sums) and len(set(sums)) == 1


def parses(line: str) -> bool:
    """Can a printed line be read as a statement at all?

    >>> parses("ki = a/Kp"), parses("ki = a/K p")
    (True, False)
    """
    try:
        ast.parse(line)
    except SyntaxError:
        return False
    return True
