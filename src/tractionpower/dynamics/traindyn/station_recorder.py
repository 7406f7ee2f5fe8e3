"""What a case of stations leaves: rows of all trains, events, key figures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from tractionpower.dynamics.traindyn.core import TrainDynamics
from tractionpower.dynamics.traindyn.layout import lay_out
from tractionpower.dynamics.traindyn.traffic import traffic
from tractionpower.dynamics.traindyn.train import DynTrain
from tractionpower.kernels.point_mass import STATES
from tractionpower.model.dynamics.stations import StationsCase
from tractionpower.results.key_figures import KeyFigure
from tractionpower.results.outcome import Writer
from tractionpower.results.tables import make_table

EVENTS = ("entered", "track_given", "arrival", "departure", "passing", "left", "still_there")
"""Kinds of events of trains on a line with stations."""

_LATE = 1e-9

Values = dict[str, Callable[[DynTrain], float]]

NUMBERS: Values = {
    "position_m": lambda train: train.place_m,
    "speed_kmh": lambda train: train.speed_kmh,
    "acceleration_mps2": lambda train: train.acceleration_mps2,
    "resistance_kn": lambda train: train.resistance_kn,
    "tractive_force_kn": lambda train: train.tractive_force_kn,
    "braking_force_kn": lambda train: train.braking_force_kn,
}
"""Columns of a train that are numbers."""


class StationRecorder:
    """Takes rows and events of a case and hands them to a writer.

    Parameters
    ----------
    case
        The case.
    writer
        Takes the tables.
    """

    def __init__(self, case: StationsCase, writer: Writer) -> None:
        self._case, self._writer = case, writer
        self._pieces = [piece.name for piece in lay_out(case).pieces]
        self._kinds = [kind.id for kind in case.trains]
        arrivals = traffic(case)
        self._names = {arrival.name: k for k, arrival in enumerate(arrivals)}
        self._kind_of = [self._kinds.index(arrival.kind.id) for arrival in arrivals]
        self._due_s = 0.0
        self._rows: list[tuple[Any, ...]] = []
        self._events: list[tuple[Any, ...]] = []
        self._came: dict[str, float] = {}
        self._journeys: list[float] = []
        self._waits: list[float] = []
        self._stalled: list[str] = []
        self._counts = dict.fromkeys(EVENTS, 0)
        self._fastest_kmh = 0.0

    def sample(self, time_s: float, core: TrainDynamics) -> None:
        """Record all trains if the next row is due at a time [s]."""
        if time_s < self._due_s - _LATE:
            return
        every = self._case.run.record_every_s
        self._due_s = every * (np.floor(time_s / every + _LATE) + 1.0)
        core.process_trains(lambda train: self._row(time_s, train))

    def _row(self, time_s: float, train: DynTrain) -> None:
        piece, _ = train.location
        where = self._pieces.index(piece.name) if piece is not None else 0
        self._fastest_kmh = max(self._fastest_kmh, train.speed_kmh)
        numbers = (value(train) for value in NUMBERS.values())
        number = self._names[train.name]
        self._rows.append((time_s, number, self._kind_of[number], where, STATES.index(train.state), *numbers))

    def tell(self, time_s: float, train: DynTrain, kind: str, track: str = "", station: str = "", waited_s: float = 0.0) -> None:
        """Record that something has happened to a train, and how long it had to wait for that [s]."""
        self._events.append((time_s, self._names[train.name], EVENTS.index(kind), track, station, train.place_m, waited_s))
        self._counts[kind] += 1
        if waited_s > 0.0:
            self._waits.append(waited_s)
        if kind == "entered":
            self._came[train.name] = time_s
        elif kind == "still_there" and train.is_stalled:
            self._stalled.append(train.name)
        elif kind == "left":
            self._journeys.append(time_s - self._came[train.name])

    def flush(self) -> None:
        """Hand the rows and events that have come together to the writer."""
        if self._rows:
            time_s, trains, kinds, where, states, *numbers = zip(*self._rows, strict=True)
            columns: dict[str, Any] = dict(zip(NUMBERS, numbers, strict=True)) | {
                "time_s": time_s,
                "train": (trains, list(self._names)),
                "kind": (kinds, self._kinds),
                "station_track": (where, self._pieces),
                "state": (states, list(STATES)),
            }
            self._writer.append("point_masses", make_table("point_masses", columns))
        if self._events:
            stations, tracks = ["", *(station.id for station in self._case.stations)], ["", *self._pieces]
            time_s, trains, kinds, where, at, places, waited = zip(*sorted(self._events), strict=True)
            columns = {
                "time_s": time_s,
                "train": (trains, list(self._names)),
                "kind": (kinds, list(EVENTS)),
                "station": ([stations.index(name) for name in at], stations),
                "station_track": ([tracks.index(name) for name in where], tracks),
                "position_m": places,
                "waited_s": waited,
            }
            self._writer.append("station_events", make_table("station_events", columns))
        self._rows, self._events = [], []

    def key_figures(self) -> list[dict[str, Any]]:
        """Return the key figures, as they are written."""
        left, there = self._counts["left"], self._counts["still_there"]
        never = self._case.traffic.trains - self._counts["entered"]
        figures = [
            KeyFigure("trains_that_left", float(left), definition="trains that have run the whole line"),
            KeyFigure("trains_still_there", float(there), definition="trains on the line at the end of the run"),
            KeyFigure("trains_that_did_not_come", float(never), definition="trains that the line, or the time, had no room for"),
            KeyFigure("highest_speed_kmh", self._fastest_kmh, definition="highest speed of all rows"),
            KeyFigure(
                "waiting_time_s", sum(self._waits, 0.0), definition="time that trains waited for a track or the line ahead"
            ),
        ]
        if self._journeys:
            mean = sum(self._journeys) / left
            figures.append(
                KeyFigure("mean_running_time_s", mean, definition="mean time from entering to leaving, stops included")
            )
        return [figure.as_dict() for figure in figures]

    def notes(self) -> list[str]:
        """Return in words what a reader has to know: trains that have not left."""
        there, never = self._counts["still_there"], self._case.traffic.trains - self._counts["entered"]
        told = [f"trains still on the line at the end: {there} ({', '.join(self._stalled)} cannot start)" if self._stalled else
                f"trains still on the line at the end: {there}"] if there else []  # fmt: skip
        return told + ([f"trains that did not come onto the line: {never}"] if never else [])
