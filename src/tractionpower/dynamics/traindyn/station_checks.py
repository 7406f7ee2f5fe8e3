"""Checks of a line with stations: order and lengths of what lies along it, and room to brake."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from tractionpower.dynamics.traindyn.compile import arc_resistance
from tractionpower.dynamics.traindyn.layout import HOME_M, SHORT_M
from tractionpower.errors import Problem, UsageError
from tractionpower.model.dynamics.case import CaseCurve, CaseGradient, CaseTunnel
from tractionpower.model.dynamics.stations import CaseStation, StationsCase, TrainKind

KMH = 3.6


def check_stations(case: StationsCase) -> list[Problem]:
    """Return everything that is wrong with a case of stations."""
    problems = [*_twice("case.trains", [kind.id for kind in case.trains])]
    problems += _twice("case.stations", [station.id for station in case.stations])
    for station in case.stations:
        problems += _twice(f"{_path(station)}.tracks", station.tracks)
    for name, rows in (("gradients", case.gradients), ("curves", case.curves), ("tunnels", case.tunnels)):
        problems += _check_rows(f"case.{name}", rows, case.length_m)
    problems += _check_arcs(case)
    problems += _check_run(case)
    places = [*_check_places(case)]
    return problems + (places or [problem for kind in case.trains for problem in _check_room(case, kind)])


def _path(station: CaseStation) -> str:
    return f"case.stations[{station.id}]"


def _twice(path: str, identifiers: Sequence[str]) -> Iterator[Problem]:
    for each in dict.fromkeys(name for k, name in enumerate(identifiers) if name in identifiers[:k]):
        yield Problem("duplicate", path, f"{each!r} twice", "each identifier once", "rename one")


def _check_rows(path: str, rows: Sequence[CaseGradient | CaseCurve | CaseTunnel], length_m: float) -> Iterator[Problem]:
    for k, row in enumerate(rows):
        if not 0.0 <= row.from_m < row.to_m <= length_m:
            found = f"from {row.from_m:g} m to {row.to_m:g} m"
            yield Problem(
                "bad_range", f"{path}[{k}].to_m", found, f"rising, within 0 to {length_m:g} m", "correct from_m and to_m"
            )
    if path == "case.tunnels":
        return
    order = sorted(range(len(rows)), key=lambda k: rows[k].from_m)
    for before, after in pairwise(order):
        if rows[after].from_m < rows[before].to_m:
            found = f"begins at {rows[after].from_m:g} m, row {before} ends at {rows[before].to_m:g} m"
            yield Problem("overlap", f"{path}[{after}].from_m", found, "no two rows at one place", "cut or drop one of them")


def _check_arcs(case: StationsCase) -> Iterator[Problem]:
    law = case.curve_resistance
    for k, curve in enumerate(case.curves):
        try:
            arc_resistance(curve.radius_m, None if law is None else (law.a_n_m_per_kn, law.b_m))
        except UsageError:
            found = f"{curve.radius_m:g} m, where a/(R - b) has no value"
            yield Problem(
                "radius_too_small", f"case.curves[{k}].radius_m", found, "above b", "correct radius_m or curve_resistance"
            )


def _check_run(case: StationsCase) -> Iterator[Problem]:
    run, traffic = case.run, case.traffic
    if run.record_every_s < run.period_s:
        found, allowed = f"{run.record_every_s:g} s", f"{run.period_s:g} s (period_s) or more"
        yield Problem("too_fine", "case.run.record_every_s", found, allowed, "rows are recorded at samples only")
    if traffic.least_headway_s > traffic.headway_s:
        found, allowed = f"{traffic.least_headway_s:g} s", f"at most {traffic.headway_s:g} s (headway_s)"
        yield Problem("contradiction", "case.traffic.least_headway_s", found, allowed, "the mean cannot lie below the least")
    if traffic.speed_kmh > case.speed_kmh:
        found, allowed = f"{traffic.speed_kmh:g} km/h", f"at most {case.speed_kmh:g} km/h (speed_kmh)"
        yield Problem("too_fast", "case.traffic.speed_kmh", found, allowed, "lower it")
    for k, time_s in enumerate(case.shown_at_s):
        if not 0.0 <= time_s <= run.duration_s:
            found, allowed = f"{time_s:g} s", f"0 to {run.duration_s:g} s (duration_s)"
            yield Problem("bad_range", f"case.shown_at_s[{k}]", found, allowed, "name a time of the run")


def _check_places(case: StationsCase) -> Iterator[Problem]:
    """Yield where stations do not lie one behind the other on the line."""
    end, before = 0.0, "the beginning of the line"
    for station in case.stations:
        path = _path(station)
        if station.from_m <= end:
            found = f"{station.from_m:g} m"
            yield Problem(
                "unsorted", f"{path}.from_m", found, f"above {end:g} m, {before}", "sort the stations, with line between"
            )
        if station.to_m <= station.from_m:
            yield Problem(
                "bad_range", f"{path}.to_m", f"{station.to_m:g} m", f"above {station.from_m:g} m (from_m)", "correct it"
            )
        end, before = max(station.to_m, end), f"the end of {station.id}"
    if case.length_m <= end:
        found = f"{case.length_m:g} m"
        yield Problem("bad_range", "case.length_m", found, f"above {end:g} m, the end of the last station", "lengthen the line")


def _check_room(case: StationsCase, kind: TrainKind) -> Iterator[Problem]:
    """Yield where a kind of trains does not fit into a station, or could not brake before one or in it."""
    b, h = kind.characteristics.braking_mps2, case.run.period_s
    top = min(case.speed_kmh, kind.characteristics.max_speed_kmh) / KMH
    behind, enters = 0.0, min(case.traffic.speed_kmh / KMH, top)
    for station in case.stations:
        path = _path(station)
        room = station.to_m - station.from_m - SHORT_M
        if kind.length_m > room:
            found = f"room for {room:g} m, trains {kind.id} are {kind.length_m:g} m long"
            yield Problem("train_too_long", f"{path}.to_m", found, remedy="lengthen the station or shorten the train")
        speed = enters if behind == 0.0 else top
        left = station.from_m - HOME_M - behind - (kind.length_m if behind else 0.0)
        needed = speed * speed / (2.0 * b) + speed * h
        if left < needed:
            found = f"trains {kind.id} have {left:g} m of line to brake before it and need {needed:.0f} m"
            yield Problem("no_room_to_brake", f"{path}.from_m", found, remedy="move the station, or let trains be slower")
        slow = min(station.speed_kmh / KMH, top) if station.speed_kmh is not None else top
        needed = slow * slow / (2.0 * b) + slow * h
        if len(station.tracks) > 1 and station.speed_kmh is not None and room < needed:
            found = f"trains {kind.id} have {room:g} m to stop in it from {station.speed_kmh:g} km/h and need {needed:.0f} m"
            yield Problem("no_room_to_brake", f"{path}.speed_kmh", found, remedy="lower the speed or lengthen the station")
        behind = station.to_m
