"""A train of a discrete-event simulation (Diviš and Kavička, TrainDyn, 3.1 and 3.2: class DynTrain)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import inf, isfinite, nan

import numpy as np
from numpy.typing import NDArray

from tractionpower.dynamics.traindyn.compile import compile_effort, write_characteristics
from tractionpower.dynamics.traindyn.polyline import Polyline, TrackData
from tractionpower.errors import UsageError
from tractionpower.kernels.point_mass import POINT_MASS, STANDING, STATES, advance_point_mass
from tractionpower.model.dynamics.point_mass import TrainCharacteristics

KMH = 3.6
"""km/h per m/s."""

_NO_TRACK = TrackData()


def speed_in_mps(speed_mps: float | None, speed_kmh: float | None) -> float:
    """Return the one of two speeds that is given, in m/s.

    Raises
    ------
    UsageError
        If it is not exactly one, or no speed.
    """
    if (speed_mps is None) == (speed_kmh is None):
        raise UsageError("a speed is given either as speed_mps or as speed_kmh")
    speed = speed_mps if speed_mps is not None else speed_kmh / KMH if speed_kmh is not None else nan
    if not (isfinite(speed) and speed >= 0.0):
        raise UsageError(f"{speed_mps if speed_mps is not None else speed_kmh} is no speed: it must be a number from 0 on")
    return float(speed)


class DynTrain:
    """A train as a point mass; may be subclassed.

    Parameters
    ----------
    name
        Name of the train.
    characteristics
        What it is; may be set later.
    route
        Pieces of track that it runs along, in their order. Behind the end of the last one the track is level and straight.
    place_m
        Where on its route it is [m].
    speed_mps, speed_kmh
        How fast it runs at first; left out: it stands. It keeps that speed until it is told another.
    """

    def __init__(
        self,
        name: str,
        characteristics: TrainCharacteristics | None = None,
        route: Sequence[Polyline] = (),
        *,
        place_m: float = 0.0,
        speed_mps: float | None = None,
        speed_kmh: float | None = None,
    ) -> None:
        self.name = name
        self._route = tuple(route)
        self._data, self._laid = _NO_TRACK, -1
        self._sections = _NO_TRACK.along(())
        self._characteristics: TrainCharacteristics | None = None
        self._method: tuple[float, bool] = (0.0, False)
        self._synchronise: Callable[[DynTrain], None] | None = None
        row = np.zeros(1, POINT_MASS)
        row["place_m"], row["goal_m"], row["stood_s"] = place_m, inf, 0.0
        if speed_mps is not None or speed_kmh is not None:
            row["speed_mps"] = row["required_mps"] = speed_in_mps(speed_mps, speed_kmh)
        self._row = row
        self._before = row.copy()
        if characteristics is not None:
            self.set_train_characteristics(characteristics)

    def set_train_characteristics(self, characteristics: TrainCharacteristics) -> None:
        """Say what the train is: masses, tractive characteristic, resistance, braking."""
        self._now()
        self._characteristics = characteristics
        self._effort = compile_effort(characteristics)
        write_characteristics(characteristics, self._row)

    def accelerate(self, speed_mps: float | None = None, *, speed_kmh: float | None = None, at_m: float | None = None) -> None:
        """Ask for another speed, greater or smaller; the greatest speed of the train caps it. 0 is a `stop`.

        Parameters
        ----------
        speed_mps, speed_kmh
            The speed; one of them.
        at_m
            Place on the route from which on it holds: until there the train keeps the speed it was asked for, and
            comes down on a braking curve. Left out: from now on. Stops and places asked for before are forgotten.

        Raises
        ------
        UsageError
            If the train has no characteristics, or cannot come down to the speed up to that place.
        """
        characteristics = self._known()
        speed = min(speed_in_mps(speed_mps, speed_kmh), characteristics.max_speed_kmh / KMH)
        if speed == 0.0:
            self.stop(at_m=at_m)
            return
        self._now()
        if at_m is None:
            self._set_goal(inf, 0.0)
            self._row["required_mps"] = speed
        else:
            self._refuse_too_near(at_m, speed)
            self._set_goal(at_m, speed)
        self._row["stops"] = False

    def stop(self, *, at_m: float | None = None) -> None:
        """Brake to a stand: at once, or so that the train stands at a place on its route.

        Up to its braking curve the train keeps the speed that it was asked for; `accelerate` makes it forget the stop.

        Raises
        ------
        UsageError
            If the train has no characteristics, or cannot stop up to that place.
        """
        self._known()
        self._now()
        if at_m is None:
            self._set_goal(inf, 0.0)
            self._row["stops"] = True
        else:
            self._refuse_too_near(at_m, 0.0)
            self._set_goal(at_m, 0.0)
            self._row["stops"] = False

    @property
    def characteristics(self) -> TrainCharacteristics | None:
        """What the train is; None: not set yet."""
        return self._characteristics

    @property
    def route(self) -> tuple[Polyline, ...]:
        """Pieces of track that it runs along."""
        return self._route

    def extend_route(self, *polylines: Polyline) -> None:
        """Let the route go on along further pieces of track."""
        self._route, self._laid = (*self._route, *polylines), -1

    @property
    def route_m(self) -> float:
        """Length of its route [m]."""
        return sum(piece.length_m for piece in self._route)

    @property
    def place_m(self) -> float:
        """Where it is on its route [m], at the time of its last calculation."""
        return float(self._row["place_m"][0])

    @property
    def location(self) -> tuple[Polyline | None, float]:
        """The piece of track it is on, and how far from where it entered it [m]; None: it has no route."""
        left = self.place_m
        for piece in self._route:
            if left < piece.length_m or piece is self._route[-1]:
                return piece, left
            left -= piece.length_m
        return None, left

    @property
    def speed_mps(self) -> float:
        """Speed [m/s] at the time of its last calculation."""
        return float(self._row["speed_mps"][0])

    @property
    def speed_kmh(self) -> float:
        """Speed [km/h] at the time of its last calculation."""
        return KMH * self.speed_mps

    @property
    def required_speed_mps(self) -> float:
        """Speed that it was asked for [m/s]; 0 when it brakes to a stand at once."""
        return 0.0 if self._row["stops"][0] else float(self._row["required_mps"][0])

    @property
    def state(self) -> str:
        """What it does: standing, accelerating (full effort), cruising, decelerating, braking_to_stop."""
        return STATES[int(self._row["state"][0])]

    @property
    def is_standing(self) -> bool:
        """Whether it stands."""
        return self.speed_mps == 0.0 and int(self._row["state"][0]) == STANDING

    @property
    def is_stalled(self) -> bool:
        """Whether it stands since its effort is too small, though it was asked to run."""
        wants = self.required_speed_mps > 0.0 and (self._row["goal_mps"][0] > 0.0 or self._row["goal_m"][0] > self.place_m + 1e-9)
        return self.is_standing and bool(wants)

    @property
    def stood_since_s(self) -> float:
        """When it came to a stand [s], inside the period of a sample; NaN while it moves."""
        return float(self._row["stood_s"][0])

    @property
    def calculated_s(self) -> float:
        """Time of its last calculation [s]."""
        return float(self._row["time_s"][0])

    @property
    def acceleration_mps2(self) -> float:
        """Acceleration [m/s2]."""
        return float(self._row["acceleration_mps2"][0])

    @property
    def tractive_force_kn(self) -> float:
        """Tractive effort at the wheel [kN]."""
        return max(float(self._row["force_n"][0]), 0.0) / 1e3

    @property
    def braking_force_kn(self) -> float:
        """Braking force [kN]."""
        return max(-float(self._row["force_n"][0]), 0.0) / 1e3

    @property
    def resistance_kn(self) -> float:
        """Resistance of vehicles and track [kN]; 0 at a stand."""
        return float(self._row["resistance_n"][0]) / 1e3

    def braking_distance_m(self, to_mps: float = 0.0) -> float:
        """Return the distance [m] in which it comes down to a speed [m/s] from where it is now."""
        rate = 2.0 * self._known().braking_mps2
        return max(self.speed_mps**2 - to_mps**2, 0.0) / rate

    def position_at(self, time_s: float) -> float:
        """Return its place [m] at a time from the beginning of the last calculation on.

        Inside that calculation it is where it has been; behind it, where it will be if nothing else is asked of it.

        Raises
        ------
        UsageError
            If the time lies before.
        """
        self._known()
        since = float(self._before["time_s"][0])
        if not time_s >= since:
            raise UsageError(f"train {self.name!r}: its place is known from {since:g} s on, not at {time_s:g} s")
        trial = (self._row if time_s >= self.calculated_s else self._before).copy()
        advance_point_mass(trial, self._effort, self._track(), time_s, *self._method)
        return float(trial["place_m"][0])

    # What follows is for the calculation core, `TrainDynamics`.

    def enter(self, data: TrackData, method: tuple[float, bool], time_s: float, synchronise: Callable[[DynTrain], None]) -> None:
        """Let a calculation core take over the train at a time [s]."""
        self._known()
        standing = self.speed_mps == 0.0
        self._data, self._laid, self._method, self._synchronise = data, -1, method, synchronise
        self._row["time_s"] = time_s
        self._row["stood_s"] = time_s if standing else nan
        self.advance(time_s)

    def leave(self) -> None:
        """Let the core give up the train: it stays as it is."""
        self._synchronise = None

    @property
    def is_added(self) -> bool:
        """Whether a calculation core moves the train."""
        return self._synchronise is not None

    def advance(self, until_s: float) -> None:
        """Move the train to a time [s], not before that of its last calculation."""
        if until_s > self.calculated_s:
            self._before = self._row.copy()
        advance_point_mass(self._row, self._effort, self._track(), float(until_s), *self._method)

    def _track(self) -> NDArray[np.void]:
        if self._laid != self._data.version:
            self._sections, self._laid = self._data.along(self._route), self._data.version
        return self._sections

    def _now(self) -> None:
        if self._synchronise is not None:
            self._synchronise(self)

    def _known(self) -> TrainCharacteristics:
        if self._characteristics is None:
            raise UsageError(f"train {self.name!r} has no characteristics; call set_train_characteristics first")
        return self._characteristics

    def _set_goal(self, at_m: float, speed_mps: float) -> None:
        self._row["goal_m"], self._row["goal_mps"] = at_m, speed_mps

    def _refuse_too_near(self, at_m: float, speed_mps: float) -> None:
        left, needed = at_m - self.place_m, self.braking_distance_m(speed_mps)
        if not left >= needed - 1e-6:
            told = f"to {KMH * speed_mps:.4g} km/h" if speed_mps else "to a stand"
            raise UsageError(
                f"train {self.name!r} cannot brake {told} up to {at_m:g} m: from {KMH * self.speed_mps:.4g} km/h it needs"
                f" {needed:.6g} m and has {left:.6g} m; ask earlier, or stop() without a place"
            )
