"""Trains as point masses on a line with stations, in SimPy: the case study of TrainDyn (Diviš and Kavička, 3.4).

Trains come one behind the other, get a free track in the next station, stop there or pass, and go on when the line ahead
is free. Tracks and pieces of line are SimPy resources for one train at a time.
"""

from __future__ import annotations

from collections.abc import Generator
from typing import TYPE_CHECKING, Any

from tractionpower.dynamics.traindyn.core import TrainDynamics
from tractionpower.dynamics.traindyn.layout import HOME_M, SHORT_M, Layout, add_track_data, lay_out
from tractionpower.dynamics.traindyn.station_recorder import StationRecorder
from tractionpower.dynamics.traindyn.traffic import Arrival, traffic
from tractionpower.dynamics.traindyn.train import DynTrain
from tractionpower.errors import UsageError
from tractionpower.model.dynamics.stations import CaseStation, StationsCase

if TYPE_CHECKING:
    import simpy
    from simpy import Resource
    from simpy.resources.resource import Request

Step = Generator["simpy.Event", Any, None]


def import_simpy() -> Any:
    """Return SimPy.

    Raises
    ------
    UsageError
        If it is not installed.
    """
    try:
        import simpy  # noqa: PLC0415 - an extra
    except ImportError as error:
        raise UsageError("cases of stations need SimPy: pip install tractionpower[simpy]") from error
    return simpy


class StationsModel:
    """A case in a SimPy environment.

    Parameters
    ----------
    case
        The case.
    env
        The environment.
    recorder
        Takes what happens.

    Attributes
    ----------
    over
        Happens when all trains have come and left.
    """

    def __init__(self, case: StationsCase, env: simpy.Environment, recorder: StationRecorder) -> None:
        simpy = import_simpy()
        self.case, self.env, self.recorder = case, env, recorder
        self.layout: Layout = lay_out(case)
        law = case.curve_resistance
        self.core = TrainDynamics(env, method=case.run.method, arc_law=None if law is None else (law.a_n_m_per_kn, law.b_m))
        add_track_data(self.core, self.layout, case)
        self._sections: list[Resource] = [simpy.Resource(env) for _ in self.layout.lines]
        self._tracks: list[dict[str, Resource]] = [{name: simpy.Resource(env) for name in each.tracks} for each in case.stations]
        self.core.run(env, case.run.period_s, self._record)
        journeys = [env.process(self._journey(arrival)) for arrival in traffic(case)]
        self.over = env.process(self._wait_for(journeys))  # a condition inside another one would lose its own parts

    def finish(self) -> None:
        """Note which trains are still there."""
        for train in self.core.trains:
            piece, _ = train.location
            self.recorder.tell(self.env.now, train, "still_there", piece.name if piece is not None else "")
        self.recorder.flush()

    def _wait_for(self, journeys: list[simpy.Process]) -> Step:
        yield self.env.all_of(journeys)

    def _record(self) -> None:
        self.recorder.sample(self.env.now, self.core)

    def _journey(self, arrival: Arrival) -> Step:
        """Let a train come, run from station to station, and leave."""
        env, case, kind = self.env, self.case, arrival.kind
        yield env.timeout(arrival.time_s)
        section = self._sections[0].request()
        yield section
        speed = min(case.traffic.speed_kmh, kind.characteristics.max_speed_kmh)
        train = DynTrain(arrival.name, kind.characteristics, (self.layout.lines[0],), speed_kmh=speed)
        self.core.add_train(train)
        self.recorder.tell(env.now, train, "entered", waited_s=env.now - arrival.time_s)
        train.accelerate(speed_kmh=case.speed_kmh)
        for k in range(len(case.stations)):
            section = yield from self._through(train, arrival, k, section)
        yield self.core.when(lambda: train.place_m >= case.length_m)
        self.core.remove_train(train)
        self._sections[-1].release(section)
        self.recorder.tell(env.now, train, "left")

    def _through(self, train: DynTrain, arrival: Arrival, k: int, section: Request) -> Generator[simpy.Event, Any, Request]:
        """Let a train come into a station, stop or pass, and go on; return its hold on the piece of line behind."""
        env, station, length = self.env, self.case.stations[k], arrival.kind.length_m
        track, place = yield from self._get_track(train, k, arrival.chances[k])
        speed = self._speed_kmh(station, track)
        if speed < self.case.speed_kmh:
            train.accelerate(speed_kmh=speed, at_m=station.from_m)
        ahead = None if station.stops else self._sections[k + 1].request()
        yield from self._come_in(train, station, speed, (station.from_m + length, ahead))
        yield self.core.when(lambda: train.place_m >= station.from_m + length)
        self._sections[k].release(section)
        if ahead is None:
            yield self.core.when(lambda: train.is_standing)
            self.recorder.tell(train.stood_since_s, train, "arrival", self._name(k, track), station.id)
            yield env.timeout(max(train.stood_since_s + station.dwell_s - env.now, 0.0))
            ahead = self._sections[k + 1].request()
        asked = env.now
        if not ahead.triggered:
            yield ahead
        train.accelerate(speed_kmh=speed)
        waited = env.now - asked
        if train.is_standing:
            self.recorder.tell(env.now, train, "departure", self._name(k, track), station.id, waited)
        yield self.core.when(lambda: train.place_m >= station.to_m)
        if not station.stops:
            self.recorder.tell(env.now, train, "passing", self._name(k, track), station.id)
        yield self.core.when(lambda: train.place_m >= station.to_m + length)
        self._tracks[k][track].release(place)
        train.accelerate(speed_kmh=self.case.speed_kmh)
        return ahead

    def _get_track(self, train: DynTrain, k: int, chance: float) -> Generator[simpy.Event, Any, tuple[str, Request]]:
        """Get a track of a station for a train, which stops before the station if it has to wait; return it with its hold."""
        station, asked = self.case.stations[k], self.env.now
        track = self._choose(station, k, chance)
        place = self._tracks[k][track].request()
        if not place.triggered:
            train.stop(at_m=station.from_m - HOME_M)
            yield place
            train.accelerate(speed_kmh=self.case.speed_kmh)
        self.recorder.tell(self.env.now, train, "track_given", self._name(k, track), station.id, self.env.now - asked)
        train.extend_route(self.layout.tracks[k][track], self.layout.lines[k + 1])
        return track, place

    def _come_in(self, train: DynTrain, station: CaseStation, speed_kmh: float, until: tuple[float, Request | None]) -> Step:
        """Let a train brake towards the end of its track, unless it passes and the line ahead is free.

        If that gets free before it has come up to a place, it goes on; `until` are that place [m] and its claim to the line.
        """
        inside_m, ahead = until
        if speed_kmh < self.case.speed_kmh:
            yield self.core.when(lambda: train.place_m >= station.from_m)
        if ahead is not None and ahead.triggered:
            return
        train.stop(at_m=station.to_m - SHORT_M)
        if ahead is not None:
            yield self.core.when(lambda: ahead.triggered or train.place_m >= inside_m)
            if ahead.triggered:
                train.accelerate(speed_kmh=speed_kmh)

    def _name(self, k: int, track: str) -> str:
        return self.layout.tracks[k][track].name

    def _choose(self, station: CaseStation, k: int, chance: float) -> str:
        """Return the track that a train gets: one of those that are free, or if none is one that it waits for."""
        held = self._tracks[k]
        free = [track for track in station.tracks if not held[track].count and not held[track].queue] or list(station.tracks)
        return free[0] if station.choice == "first_free" else free[int(chance * len(free))]

    def _speed_kmh(self, station: CaseStation, track: str) -> float:
        """Return the speed through a station on one of its tracks."""
        if station.speed_kmh is None or track == station.tracks[0]:
            return self.case.speed_kmh
        return min(station.speed_kmh, self.case.speed_kmh)
