"""Is a driving plan slower than its timetable? Planned times held against those of the plan, alone, at nominal voltage."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from tractionpower.errors import Problem
from tractionpower.model.base import format_time
from tractionpower.model.driving import Driving, Eco, Reserve, Rules
from tractionpower.model.scenario import Scenario
from tractionpower.movement.declared import Declared
from tractionpower.movement.driving.driven import driving_of
from tractionpower.movement.pace_checks import LEAST_S, Passed, Section, ends_of, named, sections, shortest_times, what_counts
from tractionpower.movement.telling import doubt, listed


def check_plans(scenario: Scenario, items: Sequence[Declared]) -> list[Problem]:
    """Return warnings of plans that take longer than the timetable gives, and of running times shorter than possible.

    A plan that drives to time is as fast as it has to be. `items` have no errors.
    """
    chosen = [(item, how) for item in items if isinstance(how := driving_of(item.run, scenario), Rules | Reserve | Eco)]
    alike: dict[Any, list[tuple[Declared, Driving]]] = {}
    for item, how in chosen:
        alike.setdefault((what_counts(item.run), how), []).append((item, how))
    if not alike:
        return []
    runs = [members[0][0].run.model_copy(update={"driving": members[0][1]}) for members in alike.values()]
    flat_out = shortest_times(scenario, runs)
    by_rules = [k for k, run in enumerate(runs) if isinstance(run.driving, Rules)]
    ruled = dict(
        zip(by_rules, shortest_times(scenario, [runs[k] for k in by_rules], by_plan=True) if by_rules else (), strict=True)
    )
    tolerance = max(scenario.feasibility.tolerance_s, LEAST_S)
    problems: list[Problem] = []
    slow: list[tuple[Declared, Section]] = []
    for k, (members, shortest) in enumerate(zip(alike.values(), flat_out, strict=True)):
        how = members[0][1]
        if shortest is None:
            continue
        planned = ruled[k] if k in ruled else _stretched(shortest, how)
        for item, _ in members:
            if isinstance(how, Eco):
                problems += _too_short(item, shortest, how)
            if planned is not None:
                slow += [(item, part) for part in _slower(item, shortest, planned, tolerance)]
    return problems + ([_tell(slow)] if slow else [])


def _stretched(shortest: tuple[list[float], list[float]], how: Driving) -> Passed:
    """Return when a plan that spreads a reserve, or a time for the whole run, comes to the calls: in proportion, nearly."""
    arrived, at_m = shortest
    whole = arrived[-1] if arrived else 0.0
    if not whole > 0.0:
        return None
    factor = 1.0
    if isinstance(how, Reserve):
        factor += how.percent / 100.0 if how.percent is not None else (how.seconds or 0.0) / whole
    elif isinstance(how, Eco):
        factor = max(factor, how.running_time / whole)
    return [factor * time_s for time_s in arrived], at_m


def _too_short(item: Declared, shortest: tuple[list[float], list[float]], how: Eco) -> Iterator[Problem]:
    whole = shortest[0][-1] if shortest[0] else 0.0
    if how.running_time < whole - LEAST_S:
        found = (
            f"{format_time(round(how.running_time, 1))}, and {named(item)} takes {format_time(round(whole, 1))} to its last call,"
            f" flat out at nominal voltage: {whole - how.running_time:.1f} s are missing"
        )
        path = f"{item.path}.driving.running_time" if item.run.driving is not None else "timetable.driving.running_time"
        yield doubt("faster_than_train", path, found, remedy="give it more time; it is driven flat out")


def _slower(
    item: Declared, shortest: tuple[list[float], list[float]], planned: tuple[list[float], list[float]], tolerance_s: float
) -> list[Section]:
    """Return the section on which the plan lacks most, where the train itself lacks nothing; none if there is no such one."""
    pairs = zip(sections(item.run, *planned), sections(item.run, *shortest), strict=True)
    short = [part for part, alone in pairs if part.missing_s > tolerance_s >= alone.missing_s]
    return sorted(short, key=lambda part: -part.missing_s)[:1]


def _tell(slow: Sequence[tuple[Declared, Section]]) -> Problem:
    """Return one warning for all: the worst in full, the others with their seconds."""
    ranked = sorted(slow, key=lambda row: (-round(row[1].missing_s, 1), row[0].path))
    worst, part = ranked[0]
    found = (
        f"from {' to '.join(ends_of(worst, part))} the plan of {named(worst)} needs {part.missing_s:.1f} s more than the"
        " timetable gives: it is late there, and driven flat out while it is"
    )
    if len(ranked) > 1:
        found += f"; likewise {listed(f'{named(item)} ({other.missing_s:.1f} s)' for item, other in ranked[1:])}"
    path = f"{worst.path}.driving" if worst.run.driving is not None else "timetable.driving"
    return doubt("plan_too_slow", path, found, remedy="let the plan be faster, or drive `to_time`")
