"""Checks of a case of train dynamics, all gathered: its train, its track, what the driver does, how it is computed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

from tractionpower.dynamics.control_checks import check_controls
from tractionpower.dynamics.coupling_checks import check_coupling
from tractionpower.dynamics.engines import powered
from tractionpower.dynamics.step_checks import check_step
from tractionpower.dynamics.way import half_length
from tractionpower.errors import Problem
from tractionpower.model.dynamics.case import Case, CaseCurve, CaseGradient, CaseTunnel, DynamicsScenario

Stretch = CaseGradient | CaseCurve | CaseTunnel

_ROUNDING_M = 1e-6
_ROUNDING_S = 1e-9
_SMALLEST_RADIUS_M = 60.0
_MOST_VEHICLES = 2000


def check_case(scenario: DynamicsScenario) -> list[Problem]:
    """Return every problem of a case whose files are well formed; an empty list if there is none."""
    train = [*_check_vehicles(scenario)]
    problems = [*train, *_check_track(scenario.case), *_check_commands(scenario.case), *_check_run(scenario.case)]
    couplings = [problem for each in scenario.couplings for problem in check_coupling(each, f"couplings[{each.id}]")]
    problems += couplings
    if any(problem.severity == "error" for problem in train):
        return problems  # what builds on the train cannot be judged
    problems += [*_check_motion(scenario), *check_controls(scenario)]
    if any(problem.severity == "error" for problem in couplings):
        return problems  # nor can the step for couplings that contradict themselves
    return [*problems, *check_step(scenario)]


# --- train -------------------------------------------------------------------------------------------------------


def _check_vehicles(scenario: DynamicsScenario) -> Iterator[Problem]:
    """Yield what the train lacks: vehicles and couplings that are not there, two of one id, vehicles without a coupling."""
    case = scenario.case
    known = {"vehicles": [each.id for each in scenario.vehicles], "couplings": [each.id for each in scenario.couplings]}
    for kind, names in known.items():
        for name in sorted({name for name in names if names.count(name) > 1}):
            yield Problem("duplicate_id", f"{kind}[{name}]", f"the id {name!r} twice", "each id once", "give each its own id")
    total = sum(part.count for part in case.vehicles)
    if total > _MOST_VEHICLES:
        yield Problem("too_many", "case.vehicles", f"{total} vehicles", f"at most {_MOST_VEHICLES}", "shorten the train")
    if case.coupling is not None and case.coupling not in known["couplings"]:
        yield _unknown("case.coupling", "coupling", case.coupling, known["couplings"])
    for k, part in enumerate(case.vehicles):
        path = f"case.vehicles[{k}]"
        if part.id not in known["vehicles"]:
            yield _unknown(f"{path}.id", "vehicle", part.id, known["vehicles"])
        if part.coupling is not None and part.coupling not in known["couplings"]:
            yield _unknown(f"{path}.coupling", "coupling", part.coupling, known["couplings"])
        is_last = k == len(case.vehicles) - 1 and part.count == 1
        if part.coupling is None and case.coupling is None and not is_last:
            found = f"no coupling behind {part.id}"
            yield Problem("missing_coupling", path, found, "one behind each vehicle but the last", "give the case a coupling")


def _unknown(path: str, kind: str, name: str, known: Sequence[str]) -> Problem:
    return Problem(f"unknown_{kind}", path, f"there is no {kind} {name!r}", ", ".join(known), "add it, or mend the name")


def _check_motion(scenario: DynamicsScenario) -> Iterator[Problem]:
    """Yield that nothing moves the train, if nothing does."""
    case = scenario.case
    pulls = any(powered(scenario)) and any(command.drive for command in case.commands)
    if not pulls and case.start.speed_kmh == 0.0 and not any(row.permille for row in case.track.gradients):
        found = "no traction, no speed at the start, no gradient"
        remedy = "add a command with drive, or start.speed_kmh; a train that is driven by hand needs neither"
        yield Problem("nothing_moves", "case.commands", found, "", remedy, "warning")


# --- track -------------------------------------------------------------------------------------------------------


def _check_track(case: Case) -> Iterator[Problem]:
    track = case.track
    for name, rows in (("gradients", track.gradients), ("curves", track.curves), ("tunnels", track.tunnels)):
        yield from _check_stretches(f"case.track.{name}", rows)
    for k, curve in enumerate(track.curves):
        yield from _check_radius(case, f"case.track.curves[{k}].radius_m", curve.radius_m)
    yield from _check_transitions(case)
    yield from _check_roundings(case)


def _check_stretches(path: str, rows: Sequence[Stretch]) -> Iterator[Problem]:
    """Yield stretches that end before they begin, and neighbours that overlap; told at the later row."""
    sound = []
    for k, row in enumerate(rows):
        if row.from_m >= row.to_m:
            found = f"{row.from_m:g} to {row.to_m:g} m"
            yield Problem("reversed", f"{path}[{k}].to_m", found, f"above {row.from_m:g}", "swap the two")
        else:
            sound.append((row.from_m, row.to_m, k))
    sound.sort()
    for (_, end_m, before), (from_m, _, k) in pairwise(sound):
        if from_m < end_m - _ROUNDING_M:
            found = f"begins at {from_m:g} m, {path}[{before}] ends at {end_m:g} m"
            yield Problem("overlap", f"{path}[{k}].from_m", found, f"from {end_m:g} m on", "mend one of the two")


def _check_radius(case: Case, path: str, radius_m: float) -> Iterator[Problem]:
    """Yield that a radius makes the curve resistance singular, or is one that no railway has."""
    law = case.track.curve_resistance
    if law is not None:
        shift_m, told = law.b_m, f"{law.a_n_m_per_kn:g}/(R - {law.b_m:g})"
    else:
        shift_m, told = (55.0, "650/(R - 55)") if radius_m >= 300.0 else (30.0, "500/(R - 30)")
    if radius_m <= shift_m:
        found = f"{radius_m:g} m: the curve resistance {told} N/kN has no value there"
        yield Problem("singular", path, found, f"above {shift_m:g}", "correct the radius, or give a curve_resistance")
    elif radius_m < _SMALLEST_RADIUS_M:
        found = f"{radius_m:g} m, less than tracks have"
        yield Problem("small_radius", path, found, f"about {_SMALLEST_RADIUS_M:g} and more", "check the radius", "warning")


def _check_transitions(case: Case) -> Iterator[Problem]:
    """Yield radii that stand twice in the table of transitions, and transitions longer than their curve."""
    track, seen = case.track, set[float]()
    for k, row in enumerate(track.transitions):
        if row.radius_m in seen:
            found = f"the radius {row.radius_m:g} m twice"
            yield Problem("duplicate_row", f"case.track.transitions[{k}].radius_m", found, "each radius once", "delete one")
        seen.add(row.radius_m)
    along = sorted((curve.from_m, curve.to_m, half_length(track, curve.radius_m), k) for k, curve in enumerate(track.curves))
    for from_m, to_m, half_m, k in along:
        if to_m > from_m and 2.0 * half_m > to_m - from_m:
            found = f"a curve of {to_m - from_m:g} m with transitions of {2.0 * half_m:g} m"
            remedy = "its full curvature may not be reached: check the transitions"
            yield Problem("long_transition", f"case.track.curves[{k}]", found, "", remedy, "warning")
    for (_, end_m, half_m, _), (from_m, _, next_half_m, k) in pairwise(along):
        if end_m < from_m < end_m + half_m + next_half_m:
            found = f"a transition that begins {end_m + half_m + next_half_m - from_m:g} m before that of the last curve ends"
            remedy = "the curvatures add up there: check the transitions"
            yield Problem("long_transition", f"case.track.curves[{k}]", found, "", remedy, "warning")


def _check_roundings(case: Case) -> Iterator[Problem]:
    """Yield gradients so short that the roundings at their ends overlap: the train does not meet their full slope."""
    track = case.track
    rows = sorted((row.from_m, row.to_m, row.permille, k) for k, row in enumerate(track.gradients) if row.to_m > row.from_m)
    for i, (from_m, to_m, permille, k) in enumerate(rows):
        before = rows[i - 1][2] if i and abs(rows[i - 1][1] - from_m) <= _ROUNDING_M else 0.0
        after = rows[i + 1][2] if i + 1 < len(rows) and abs(rows[i + 1][0] - to_m) <= _ROUNDING_M else 0.0
        needed = 0.5 * track.rounding_radius_m * (abs(permille - before) + abs(permille - after)) / 1000.0
        if needed > (to_m - from_m) * (1.0 + 1e-9):
            found = f"{to_m - from_m:g} m long, and the vertical roundings at its ends take {needed:g} m"
            remedy = "its full slope is not reached: lengthen it, or lower rounding_radius_m"
            yield Problem("short_gradient", f"case.track.gradients[{k}]", found, "", remedy, "warning")


# --- commands ----------------------------------------------------------------------------------------------------


def _check_commands(case: Case) -> Iterator[Problem]:
    end_s = case.run.duration_s
    for k, command in enumerate(case.commands):
        path = f"case.commands[{k}]"
        if k and command.time_s < case.commands[k - 1].time_s:
            found = f"{command.time_s:g} s behind {case.commands[k - 1].time_s:g} s"
            yield Problem("unsorted", f"{path}.time_s", found, "times that rise from row to row", "sort the rows by time")
        elif k and command.time_s == case.commands[k - 1].time_s:
            found = f"{command.time_s:g} s twice"
            yield Problem("equal_times", f"{path}.time_s", found, "each time once", "put what happens at a time into one row")
        if command.brake is not None and command.reduction_bar is not None:
            found = f"brake {command.brake} and a reduction by {command.reduction_bar:g} bar"
            yield Problem("contradiction", path, found, "one of the two", "leave one of them out")
        if not command.model_fields_set - {"time_s"} or all(
            getattr(command, name) is None for name in type(command).model_fields if name != "time_s"
        ):
            yield Problem("empty_row", path, "a row that sets nothing", "", "delete it", "warning")
    late = [k for k, command in enumerate(case.commands) if command.time_s > end_s + _ROUNDING_S]
    if late:
        times = ", ".join(f"{case.commands[k].time_s:g}" for k in late[:8]) + (", ..." if len(late) > 8 else "")
        found = f"{len(late)} of {len(case.commands)} rows after the end at {end_s:g} s: {times} s"
        remedy = "they are never reached: lengthen run.duration_s, or delete them"
        yield Problem("after_the_end", f"case.commands[{late[0]}].time_s", found, f"up to {end_s:g} s", remedy, "warning")
    yield from _check_pull_against_brake(case)


def _check_pull_against_brake(case: Case) -> Iterator[Problem]:
    """Yield the first row from which on traction and the electric brake of the same vehicles are asked at once."""
    drive, electric, was_both = 0, 0.0, False
    for k, command in enumerate(case.commands):
        drive = drive if command.drive is None else command.drive
        electric = electric if command.electric is None else command.electric
        is_both = drive > 0 and electric > 0.0
        if is_both and not was_both:
            found = f"drive {drive} and electric brake {electric:g} at once"
            remedy = "locomotives give the one or the other; computed as it is written"
            yield Problem("drive_and_electric", f"case.commands[{k}]", found, "", remedy, "warning")
        was_both = is_both


# --- run ---------------------------------------------------------------------------------------------------------


def recorded_rows(case: Case) -> int:
    """Return how many rows a run that is not ended early records, the first and the last one included."""
    return math.ceil(case.run.duration_s / case.run.record_every_s - 1e-9) + 1


def _check_run(case: Case) -> Iterator[Problem]:
    run = case.run
    if run.step_s > run.duration_s:
        found, allowed = f"{run.step_s:g} s", f"at most {run.duration_s:g} s, run.duration_s"
        yield Problem("step", "case.run.step_s", found, allowed, "shorten the step")
    if run.method != "variable" and run.step_s > run.record_every_s * (1.0 + 1e-9):
        found, allowed = f"{run.step_s:g} s", f"at most {run.record_every_s:g} s, the distance of recorded rows"
        yield Problem("record", "case.run.step_s", found, allowed, "shorten the step, or lengthen record_every_s")
    rows = recorded_rows(case)
    if run.rows_limit is not None and rows > run.rows_limit:
        every = fitting_record(case)
        found = f"{rows} rows of {run.record_every_s:g} s in {run.duration_s:g} s, and the limit is {run.rows_limit}"
        remedy = f"record_every_s: {every:g} fits, and so does rows_limit: {rows}; nothing is cut off"
        yield Problem("state_vector", "case.run.rows_limit", found, f"at most {run.rows_limit} rows", remedy)


def fitting_record(case: Case) -> float:
    """Return the least distance of rows, in whole steps, that obeys the limit of rows [s]."""
    run = case.run
    steps = math.ceil(run.duration_s / run.step_s - 1e-9)
    return -(-steps // max((run.rows_limit or 2) - 1, 1)) * run.step_s
