"""Checks of the line, and of tracks, places and stretches wherever they are named."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from typing import Literal, get_args

from tractionpower.alignment.axis import TrackAxis, breaks_of, compile_axes, follow_breaks, tracks_at
from tractionpower.alignment.intervals import Patch, Row, find_gaps, find_overlaps, group, name_km, name_tracks, place_rows
from tractionpower.errors import Problem
from tractionpower.kernels.tables import SHARED_NODE_M
from tractionpower.model.line import Connection, Direction, Line, SpeedLimit, Station, Track

Axes = Mapping[str, TrackAxis]

_SHOWN = 8


def check_line(line: Line) -> list[Problem]:
    """Return everything that is wrong or doubtful with `line`; a level line without lists is in order."""
    axes = compile_axes(line)
    problems = check_ids("line.tracks", [track.id for track in line.tracks], by_index=True)
    problems += check_ids("line.stations", [station.id for station in line.stations])
    problems += _check_breaks(line, axes)
    problems += _check_doubled(line)
    for station in line.stations:
        problems += _check_station(station, axes)
    for name in ("gradients", "curves", "tunnels", "speed_limits", "train_current_limits", "power_off"):
        problems += check_rows(f"line.{name}", getattr(line, name), axes)
    for name in ("gradients", "curves", "tunnels"):
        problems += check_overlaps(f"line.{name}", getattr(line, name), axes)
    problems += _check_current_limits(line, axes)
    problems += _check_power_off(line, axes)
    problems += _check_curve_radii(line)
    problems += _check_gradient_gaps(line, axes)
    problems += _check_speed_gaps(line.speed_limits, axes)
    problems += _check_connections(line, axes)
    return problems


# --- for every room that names tracks and kilometres -------------------------------------------------------------


def check_ids(path: str, ids: Sequence[str], *, by_index: bool = False) -> list[Problem]:
    """Return a problem for each identifier that a list gives more than once, at the last of them."""
    last = {name: index for index, name in enumerate(ids)}
    return [
        Problem(
            "duplicate_id",
            f"{path}[{last[name] if by_index else name}]",
            f"the id {name!r} stands {count} times in {path}",
            remedy="give each its own id",
        )
        for name, count in sorted(Counter(ids).items())
        if count > 1
    ]


def check_tracks(path: str, tracks: Sequence[str] | None, axes: Axes) -> list[Problem]:
    """Return problems of the `tracks` of a row or device: unknown ones, one named twice, none at all."""
    if tracks is None:
        return []
    known = _shorten(axes)
    if not tracks:
        return [Problem("no_tracks", path, "the list of tracks is empty", f"tracks: {known}", "leave it out for all tracks")]
    unknown = [name for name in dict.fromkeys(tracks) if name not in axes]
    problems = []
    if unknown:
        remedy = "name tracks of the line, or add the track to it"
        problems.append(Problem("unknown_track", path, f"the line has no {name_tracks(unknown)}", f"tracks: {known}", remedy))
    for name in sorted(name for name, count in Counter(tracks).items() if count > 1):
        problems.append(Problem("duplicate_track", path, f"track {name} is named more than once", remedy="name it once"))
    return problems


def check_place(path: str, km: float, tracks: Iterable[str] | None, axes: Axes) -> list[Problem]:
    """Return a problem if a kilometre is not on all the known `tracks`, or on no track at all if they are left out."""
    found = _off_track(km, tracks, axes)
    return [Problem("off_track", path, found, _extents(tracks, axes), "correct the km or the tracks")] if found else []


def check_rows(path: str, rows: Sequence[Row], axes: Axes) -> list[Problem]:
    """Return problems of the tracks of `rows`, and of the rows that begin or end off their tracks."""
    problems = []
    for index, row in enumerate(rows):
        problems += check_tracks(f"{path}[{index}].tracks", row.tracks, axes)
        off = {end: _off_track(getattr(row, end), row.tracks, axes) for end in ("from_km", "to_km")}
        ends = [end for end, found in off.items() if found]
        if ends:
            place = f"{path}[{index}]" if len(ends) == 2 else f"{path}[{index}].{ends[0]}"
            found = "; ".join(dict.fromkeys(off[end] for end in ends))
            problems.append(Problem("off_track", place, found, _extents(row.tracks, axes), "correct the km or the tracks"))
    return problems


def check_overlaps(path: str, rows: Sequence[Row], axes: Axes) -> list[Problem]:
    """Return a problem for each two `rows` that hold on the same stretch of a track."""
    return [
        Problem(
            "overlap",
            f"{path}[{overlap.rows[1]}]",
            f"rows {overlap.rows[0]} and {overlap.rows[1]} both hold on {overlap}",
            remedy="let one end where the other begins",
        )
        for overlap in find_overlaps(place_rows(enumerate(rows), axes), axes)
    ]


def _off_track(km: float, tracks: Iterable[str] | None, axes: Axes) -> str:
    """Return what is wrong with a place, or an empty text."""
    if tracks is None:
        return "" if tracks_at(axes, km) else f"no track exists at km {name_km(km)}"
    off = [name for name in dict.fromkeys(tracks) if name in axes and not axes[name].contains(km)]
    return f"km {name_km(km)} is not on {name_tracks(off)}" if off else ""


def _extents(tracks: Iterable[str] | None, axes: Axes) -> str:
    """Return the kilometres of `tracks`, of all if left out, tracks of the same extent as one."""
    patches = [
        Patch((name,), float(start), float(end))
        for name in (axes if tracks is None else dict.fromkeys(tracks))
        if name in axes
        for start, end in zip(axes[name].start_km, axes[name].end_km, strict=True)
    ]
    return _shorten((str(item) for item in group(patches)), "; ")


def _shorten(names: Iterable[str], separator: str = ", ") -> str:
    texts = list(names)
    return separator.join(texts[:_SHOWN] + ([f"... ({len(texts)} in all)"] if len(texts) > _SHOWN else []))


# --- for the line alone ------------------------------------------------------------------------------------------


def _check_breaks(line: Line, axes: Axes) -> list[Problem]:
    tracks: dict[str, Track] = {}
    for track in line.tracks:
        tracks.setdefault(track.id, track)
    faults: dict[tuple[int, str, float, float], list[str]] = {}
    for name in sorted(tracks):
        for fault in follow_breaks(tracks[name], line.chainage_breaks)[1]:
            faults.setdefault(fault, []).append(name)
    problems = []
    for index, item in enumerate(line.chainage_breaks):
        problems += check_tracks(f"line.chainage_breaks[{index}].tracks", item.tracks, axes)
        if item.tracks is None and not any(track.from_km < item.at_km < track.to_km for track in tracks.values()):
            path, found = f"line.chainage_breaks[{index}].at_km", f"km {name_km(item.at_km)} lies inside no track"
            problems.append(Problem("off_track", path, found, _extents(None, axes), "correct the km"))
    for (index, end, low, high), names in sorted(faults.items()):
        km = getattr(line.chainage_breaks[index], end)
        found = f"the kilometrage of {name_tracks(names)} cannot jump {'at' if end == 'at_km' else 'to'} km {name_km(km)}"
        if end == "continues_as_km" and km < low:
            found += f": it would run in a ring, past km {name_km(low)} where the piece before begins"
        allowed = f"{'above' if end == 'at_km' else 'from'} km {name_km(low)}, below km {name_km(high)}"
        remedy = "correct the km, the tracks or the break before"
        problems.append(Problem("chainage_break", f"line.chainage_breaks[{index}].{end}", found, allowed, remedy))
    return problems


def _check_doubled(line: Line) -> list[Problem]:
    """Return a warning for each break that jumps back, so that kilometres exist twice."""
    concerned: dict[int, list[str]] = {}
    for track in sorted(line.tracks, key=lambda track: track.id):
        faulty = {index for index, *_ in follow_breaks(track, line.chainage_breaks)[1]}
        for index, item in breaks_of(track, line.chainage_breaks):
            if item.continues_as_km < item.at_km and index not in faulty:
                concerned.setdefault(index, []).append(track.id)
    problems = []
    for index, names in sorted(concerned.items()):
        low, high = line.chainage_breaks[index].continues_as_km, line.chainage_breaks[index].at_km
        path = f"line.chainage_breaks[{index}].continues_as_km"
        found = f"km {name_km(low)} to km {name_km(high)} exist twice on {name_tracks(list(dict.fromkeys(names)))}"
        remedy = "a place there means the first occurrence; describe what stands on the second as a track of its own"
        problems.append(Problem("doubled_km", path, found, "", remedy, "warning"))
    return problems


def _check_station(station: Station, axes: Axes) -> list[Problem]:
    path = f"line.stations[{station.id}]"
    problems = check_tracks(f"{path}.tracks", station.tracks, axes)
    problems += check_place(f"{path}.km", station.km, station.tracks, axes)
    for key, km in (station.stop_km or {}).items():
        track = _stop_track(key, axes)
        problems += check_tracks(f"{path}.stop_km[{key}]", (track,), axes)
        problems += check_place(f"{path}.stop_km[{key}]", km, (track,), axes)
    return problems


def _stop_track(key: str, axes: Axes) -> str:
    """Return the track that a key of `stop_km` names, such as ``1`` or ``1 increasing``."""
    track, _, direction = key.rpartition(" ")
    return track if key not in axes and direction in get_args(Direction) else key


def _check_current_limits(line: Line, axes: Axes) -> list[Problem]:
    """Return warnings: rows that overlap, and more current at standstill than in motion."""
    path, rows = "line.train_current_limits", line.train_current_limits
    problems = [
        Problem(
            "overlap",
            f"{path}[{overlap.rows[1]}]",
            f"rows {overlap.rows[0]} and {overlap.rows[1]} both hold on {overlap}",
            remedy="the lower limit holds; let one end where the other begins",
            severity="warning",
        )
        for overlap in find_overlaps(place_rows(enumerate(rows), axes), axes)
    ]
    for index, row in enumerate(rows):
        if row.standstill_current_a is not None and row.standstill_current_a > row.max_current_a:
            found = f"{row.standstill_current_a:g} A at standstill, above {row.max_current_a:g} A in motion"
            allowed = f"up to max_current_a, {row.max_current_a:g} A"
            where = f"{path}[{index}].standstill_current_a"
            problems.append(Problem("standstill_current", where, found, allowed, "correct one of them", "warning"))
    return problems


def _check_power_off(line: Line, axes: Axes) -> list[Problem]:
    """Return a warning where rows of different kinds overlap."""
    rows = line.power_off
    return [
        Problem(
            "overlap",
            f"line.power_off[{later}]",
            f"rows {first} ({rows[first].kind}) and {later} ({rows[later].kind}) both hold on {overlap}",
            remedy="what takes more away holds; let one end where the other begins",
            severity="warning",
        )
        for overlap in find_overlaps(place_rows(enumerate(rows), axes), axes)
        for first, later in [overlap.rows]
        if rows[first].kind != rows[later].kind
    ]


def _check_curve_radii(line: Line) -> list[Problem]:
    """Return a problem for each curve at whose radius the formula a/(R - b) of the line has no value."""
    if line.curve_resistance is None:  # the radii that Roeckl's formula takes are the bounds of the field itself
        return []
    least = line.curve_resistance.b_m
    return [
        Problem(
            "curve_radius",
            f"line.curves[{index}].radius_m",
            f"the curve resistance a/(R - b) has no value at a radius of {curve.radius_m:g} m",
            f"above b = {least:g} m",
            "correct the radius, or line.curve_resistance.b_m",
        )
        for index, curve in enumerate(line.curves)
        if curve.radius_m <= least
    ]


def _check_gradient_gaps(line: Line, axes: Axes) -> list[Problem]:
    if not line.gradients:  # no gradients at all: the line is meant to be level
        return []
    gaps = find_gaps(place_rows(enumerate(line.gradients), axes), axes)
    remedy = "level is assumed there; add a row with the slope, or with 0 permille"
    return [Problem("gap", "line.gradients", f"no gradient on {gap}", "", remedy, "warning") for gap in gaps]


def _check_speed_gaps(rows: Sequence[SpeedLimit], axes: Axes) -> list[Problem]:
    """Return a warning where a train that no row's category names would find no limit; rows may overlap, the lowest holds."""
    if not rows:
        return []
    up, down = (_speed_gaps(rows, direction, axes) for direction in get_args(Direction))
    categories = sorted({row.category for row in rows if row.category is not None})
    only = f" (rows of category {', '.join(categories)} serve only its trains)" if categories else ""
    return [
        Problem(
            "gap",
            "line.speed_limits",
            f"no speed limit on {gap}{_one_way(gap in up, gap in down)}{only}",
            remedy="add a row; a train that runs there is refused",
            severity="warning",
        )
        for gap in sorted({*up, *down}, key=lambda gap: (gap.from_km, gap.to_km, gap.tracks))
    ]


def _speed_gaps(rows: Sequence[SpeedLimit], direction: Literal["increasing", "decreasing"], axes: Axes) -> list[Patch]:
    general = ((index, row) for index, row in enumerate(rows) if row.category is None and row.direction in {None, direction})
    return find_gaps(place_rows(general, axes), axes)


def _one_way(up: bool, down: bool) -> str:
    return "" if up and down else f" for trains that run with {'increasing' if up else 'decreasing'} km"


def _check_connections(line: Line, axes: Axes) -> list[Problem]:
    problems = []
    known: dict[frozenset[tuple[str, float]], int] = {}
    for index, connection in enumerate(line.connections):
        for end, point in (("from", connection.from_), ("to", connection.to)):
            path = f"line.connections[{index}].{end}"
            problems += check_tracks(f"{path}.track", (point.track,), axes)
            problems += check_place(f"{path}.km", point.km, (point.track,), axes)
        path = f"line.connections[{index}]"
        ends = frozenset((point.track, point.km) for point in (connection.from_, connection.to))
        if _is_one_place(connection, axes):
            found = f"both ends of the connection are one place on track {connection.to.track}: km {name_km(connection.to.km)}"
            remedy = "name the track and km of the other line, or leave the connection out"
            problems.append(Problem("connection_to_itself", path, found, "two places", remedy))
        elif known.setdefault(ends, index) != index:
            found = f"the same connection as row {known[ends]}"
            problems.append(Problem("duplicate_connection", path, found, "each connection once", "leave one out"))
    return problems


def _is_one_place(connection: Connection, axes: Axes) -> bool:
    """Tell whether a connection leads from a place to itself, also through the two kilometres of a chainage break."""
    (track, km), (other, to_km) = ((end.track, end.km) for end in (connection.from_, connection.to))
    if track != other or track not in axes or not (axes[track].contains(km) and axes[track].contains(to_km)):
        return False
    return abs(axes[track].metre(km) - axes[track].metre(to_km)) < SHARED_NODE_M
