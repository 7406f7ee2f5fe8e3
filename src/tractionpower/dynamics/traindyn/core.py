"""The calculation core that moves all trains of a simulation (Diviš and Kavička, TrainDyn, 3.1 and 3.2: TrainDynamics)."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from typing import TYPE_CHECKING, Any, ClassVar, Literal, cast

from tractionpower.dynamics.traindyn.compile import DOUBLE_TRACK_TUNNEL, SINGLE_TRACK_TUNNEL, arc_resistance
from tractionpower.dynamics.traindyn.polyline import Polyline, TrackData
from tractionpower.dynamics.traindyn.train import DynTrain
from tractionpower.errors import UsageError

if TYPE_CHECKING:
    import simpy

Method = Literal["euler", "held_speed", "fine"]

METHODS: dict[str, tuple[float, bool]] = {"euler": (0.0, False), "held_speed": (0.0, True), "fine": (0.1, False)}
"""Substep [s] and whether places move with the speed of the sample before, by method."""

_KEPT_AS = "_tractionpower_train_dynamics"

Polylines = Polyline | Iterable[Polyline]


class TrainDynamics:
    """Moves trains by activity scanning: each call of `calculate_speeds` brings all of them to one time.

    Parameters
    ----------
    env
        SimPy environment whose clock counts. With it, what is asked of a train between two samples holds from that moment
        on; without it, from the sample before.
    method
        euler: forces at the beginning of the period, distance by the mean speed (eq. 21 and 22); held_speed: the same speeds,
        but places move with the speed of the sample before, as in AnyLogic, for comparison; fine: substeps of 0.1 s by the
        midpoint rule.
    arc_law
        a [N m/kN] and b [m] of the resistance a / (R - b) of arcs (eq. 15); left out: Roeckl.
    """

    _instance: ClassVar[TrainDynamics | None] = None

    def __init__(
        self, env: simpy.Environment | None = None, *, method: Method = "euler", arc_law: tuple[float, float] | None = None
    ) -> None:
        if method not in METHODS:
            raise UsageError(f"no method {method!r}; there are {', '.join(METHODS)}")
        self._env = env
        self._method = METHODS[method]
        self._arc_law = arc_law
        self._data = TrackData()
        self._trains: dict[str, DynTrain] = {}
        self._awaited: list[tuple[Callable[[], bool], simpy.Event]] = []
        self._time_s = float(env.now) if env is not None else 0.0

    @classmethod
    def get_instance(cls, env: simpy.Environment | None = None) -> TrainDynamics:
        """Return the one core of a SimPy environment, or without one that of the process; it is made when first asked for."""
        if env is not None:
            kept = vars(env)  # it goes with the environment
            if _KEPT_AS not in kept:
                kept[_KEPT_AS] = cls(env)
            return cast("TrainDynamics", kept[_KEPT_AS])
        if cls._instance is None:
            cls._instance = cls()
        return cls._instance

    @classmethod
    def forget_instance(cls) -> None:
        """Let `get_instance` without an environment make a new core: the next simulation of this process."""
        cls._instance = None

    def add_arc(self, polyline: Polylines, radius_m: float, *, between_m: tuple[float, float] | None = None) -> None:
        """Say that one piece of track, or several, lie in an arc of a radius [m] (eq. 15).

        `between_m` are distances on the piece, in its direction, where not all of it does.
        """
        self._data.add(polyline, arc_resistance(radius_m, self._arc_law), between_m)

    def add_inclination(self, polyline: Polylines, permille: float, *, between_m: tuple[float, float] | None = None) -> None:
        """Say that pieces of track rise by so many per mille in their direction, negative: they fall (eq. 13 and 14)."""
        if not abs(permille) <= 200.0:
            raise UsageError(f"an inclination of {permille} per mille; allowed: -200 to 200, and 1 is 1 m on 1 km")
        self._data.add(polyline, permille / 1e3, between_m, is_slope=True)

    def add_tunnel(self, polyline: Polylines, tracks: Literal[1, 2] = 1, *, between_m: tuple[float, float] | None = None) -> None:
        """Say that pieces of track lie in a tunnel of one track, 2 N/kN, or of two, 1 N/kN (2.2.1)."""
        if tracks not in (1, 2):
            raise UsageError(f"a tunnel of {tracks} tracks; the resistance is known for 1 and 2")
        self._data.add(polyline, SINGLE_TRACK_TUNNEL if tracks == 1 else DOUBLE_TRACK_TUNNEL, between_m)

    def add_train(self, train: DynTrain) -> None:
        """Add a train to the calculation, from now on.

        Raises
        ------
        UsageError
            If it has no characteristics, or another train of its name, or it itself, is there.
        """
        if train.name in self._trains or train.is_added:
            raise UsageError(f"train {train.name!r} is in a calculation already; remove it first")
        train.enter(self._data, self._method, self.time_s, self._synchronise)
        self._trains[train.name] = train

    def remove_train(self, train: DynTrain) -> None:
        """Remove a train from the calculation; it stays as it is now.

        Raises
        ------
        UsageError
            If it was not added.
        """
        if self._trains.get(train.name) is not train:
            raise UsageError(f"train {train.name!r} was not added")
        self._synchronise(train)
        del self._trains[train.name]
        train.leave()

    @property
    def trains(self) -> tuple[DynTrain, ...]:
        """All trains in the calculation, in the order in which they came."""
        return tuple(self._trains.values())

    @property
    def time_s(self) -> float:
        """Time of the clock [s]; without a SimPy environment that of the last calculation."""
        return float(self._env.now) if self._env is not None else self._time_s

    def calculate_speeds(self, time_s: float) -> None:
        """Bring all trains to a time [s].

        Raises
        ------
        UsageError
            If the time lies before that of the last calculation.
        """
        if not time_s >= self._time_s:
            raise UsageError(f"speeds were calculated for {self._time_s:g} s already; {time_s} s lies before or is no time")
        for train in self._trains.values():
            train.advance(max(time_s, train.calculated_s))
        self._time_s = float(time_s)

    def process_trains(self, callback: Callable[[DynTrain], object]) -> None:
        """Call `callback` with every train; it may add and remove trains."""
        for train in self.trains:
            callback(train)

    def run(
        self, env: simpy.Environment | None = None, period_s: float = 1.0, then: Callable[[], object] | None = None
    ) -> simpy.Process:
        """Start to calculate all trains every `period_s` [s] of a SimPy environment, and return that process.

        `then` is called behind each calculation, for example to draw or record the trains.

        Raises
        ------
        UsageError
            If there is no environment, it is not that of this core, or the period is not above 0.
        """
        env = env if env is not None else self._env
        if env is None:
            raise UsageError("name the SimPy environment to run in: run(env)")
        if self._env not in (None, env):
            raise UsageError("this core belongs to another SimPy environment; get_instance(env) gives each its own")
        if not 0.0 < period_s < float("inf"):
            raise UsageError(f"a sampling period of {period_s} s; it must be above 0")
        self._env = env
        self._time_s = max(self._time_s, float(env.now))
        return env.process(self._scan(env, float(period_s), then))

    def when(self, condition: Callable[[], bool]) -> simpy.Event:
        """Return a SimPy event that happens at the first sample at which a condition holds: ``yield core.when(...)``.

        Raises
        ------
        UsageError
            If the core has no SimPy environment.
        """
        if self._env is None:
            raise UsageError("waiting needs a SimPy environment: TrainDynamics(env), or run(env) before")
        event = self._env.event()
        if condition():
            return event.succeed()
        self._awaited.append((condition, event))
        return event

    def _scan(
        self, env: simpy.Environment, period_s: float, then: Callable[[], object] | None
    ) -> Generator[simpy.Event, Any, None]:
        first, count = float(env.now), 0
        while True:
            self.calculate_speeds(float(env.now))
            if then is not None:
                then()
            happened = [(condition, event) for condition, event in self._awaited if condition()]
            self._awaited = [each for each in self._awaited if each not in happened]
            for _, event in happened:
                event.succeed()
            count += 1
            yield env.timeout(max(first + count * period_s - env.now, 0.0))  # sums of a period would drift

    def _synchronise(self, train: DynTrain) -> None:
        """Bring a train to the present before something else is asked of it."""
        if self._env is not None:
            train.advance(max(self.time_s, train.calculated_s))
