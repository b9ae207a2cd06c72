"""The PID controller with settings that follow a measured variable: zones with edges, hysteresis, no bump between them.

Each zone has its K, Ti and Td. A zone is left when the variable passes its edge by more than the hysteresis; the
states are then moved as for any change of settings (`full_pid.bumpless_change`).
"""

from functools import cache
from itertools import pairwise

from sympy import Integer, Symbol

from derivations.pid.pid_laws import K, Td, Ti
from derivations.programs import full_pid, pid_step
from derivations.programs import shared_operations as shared
from derivations.programs.form import COUNT, Assign, BlockProgram, Do, If, Operation, Statement, Variable
from derivations.programs.frozen import Both, Minus, Plus, Whole, finite, relation
from derivations.programs.pid_variables import FLAGS, GAINS, SETTINGS, u, valid

hysteresis, schedule, zone, zone_next = (Symbol(n) for n in ("hysteresis", "schedule", "zone", "zone_next"))
FOLLOWING = (K, Ti, Td)


def of_zone(setting: Symbol, number: int) -> Symbol:
    """A setting in one zone, counted from 1."""
    return Symbol(f"{setting.name.replace('_', '')}_{number}")


def edge(number: int) -> Symbol:
    """The value between zone number and the next."""
    return Symbol(f"edge_{number}")


def _settings(zones: int) -> tuple[Variable, ...]:
    about = {s.symbol: s.about for s in SETTINGS}
    each = (
        Variable(of_zone(setting, z), about=f"zone {z}: {about[setting]}")
        for z in range(1, zones + 1)
        for setting in FOLLOWING
    )
    edges = (Variable(edge(z), about=f"value between zones {z} and {z + 1}") for z in range(1, zones))
    band = Variable(hysteresis, about="how far past an edge before the zone changes, >= 0")
    return (*each, *edges, band, *(s for s in SETTINGS if s.symbol not in FOLLOWING))


def _ranges(zones: int) -> tuple:
    plain = full_pid.ranges()
    new = {s.symbol: s.new for s in SETTINGS}
    found = []
    for inside in plain:
        following = [s for s in FOLLOWING if inside.has(new[s])]
        if not following:
            found.append(inside)
        for z in range(1, zones + 1) if following else ():
            found.append(inside.xreplace({new[s]: Variable(of_zone(s, z)).new for s in following}))
    edges = [Variable(edge(z)).new for z in range(1, zones)]
    found += [finite(one) for one in edges]
    found += [relation(low, "<", high) for low, high in pairwise(edges)]
    return (*found, Both(finite(Variable(hysteresis).new), relation(Variable(hysteresis).new, ">=", 0)))


def _select(zones: int) -> Operation:
    """K, Ti and Td of the zone, and the gains."""
    body: tuple[Statement, ...] = ()
    for z in range(zones, 0, -1):
        taken = tuple(Assign(s, of_zone(s, z)) for s in FOLLOWING)
        body = taken if z == zones else (If(relation(zone, "==", Whole(Integer(z - 1))), taken, body),)
    return Operation("select", "The settings of the zone, and the gains.", (*body, *full_pid.gains()), public=False)


def _step(zones: int, compensated: bool) -> Operation:
    plain = pid_step.step(compensated)
    keep, shift = full_pid.bumpless_change()
    up = (
        If(
            Both(
                relation(zone_next, "==", Whole(Integer(z - 1))),
                relation(schedule, ">", Plus(edge(z), hysteresis)),
            ),
            (Assign(zone_next, Whole(Integer(z))),),
        )
        for z in range(1, zones)
    )
    down = (
        If(
            Both(
                relation(zone_next, "==", Whole(Integer(z))),
                relation(schedule, "<", Minus(edge(z), hysteresis)),
            ),
            (Assign(zone_next, Whole(Integer(z - 1))),),
        )
        for z in range(zones - 1, 0, -1)
    )
    moved = If(relation(zone_next, "!=", zone), (*keep, Assign(zone, zone_next), Do("select"), shift))
    locals_ = {v.symbol: v for v in (*plain.locals, *full_pid.change_locals(), Variable(zone_next, COUNT))}
    return Operation(
        "step",
        "One sample: chooses the zone, reads the measurement, returns the output.",
        (If(finite(schedule), (Assign(zone_next, zone), *up, *down, moved)), *plain.body),
        arguments=(*plain.arguments, Variable(schedule, about="variable that chooses the zone; NaN: it stays")),
        locals=tuple(locals_.values()),
        result=u,
    )


@cache
def program(zones: int, compensated: bool = False) -> BlockProgram:
    """The controller with this many zones, two at least."""
    plain = full_pid.program(compensated)
    settings = _settings(zones)
    about = {s.symbol: s.about for s in SETTINGS}
    gains = (*(Variable(s, about=f"in force: {about[s]}") for s in FOLLOWING), *GAINS)
    begun = If(valid, (Assign(zone, Whole(Integer(0))), Do("adopt"), Do("reset")))
    init = plain.operation("init")
    changed = {
        "in_range": shared.in_range(*_ranges(zones)),
        "adopt": shared.adopt(settings, Do("select")),
        "init": Operation("init", init.about, (Do("in_range"), begun), result=valid, takes_settings=True),
        "step": _step(zones, compensated),
    }
    kept = [changed.get(o.name, o) for o in plain.operations]
    return BlockProgram(
        f"gain-scheduled PID controller, {zones} zones",
        plain.about,
        settings,
        gains,
        (*plain.states, Variable(zone, COUNT, "zone in force, counted from 0")),
        FLAGS,
        (kept[0], _select(zones), *kept[1:]),
        u,
        defaults=plain.defaults,
    )
