"""Where the energy of a run goes, from the substations to the wheels and back, as stages that each balance."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Literal

from tractionpower.reporting.facts.run_data import RunData
from tractionpower.reporting.texts import mark, tr

Kind = Literal["electric", "mechanical", "heat", "drop", "recovered"]

REST_SHARE = 1e-4
"""Differences between ledgers are told beyond this share of all that goes in."""

SOURCE, RETURNED, ON_BOARD = "source", "returned", "on_board"

WORDS: dict[str, tuple[str, Kind]] = {
    SOURCE: (mark("substations, no-load voltage times current (E I)"), "electric"),
    "plant_heat": (mark("heat in transformers and rectifiers"), "heat"),
    "regulation": (mark("regulation (E - U) I: mostly commutation drop, no loss"), "drop"),
    "commutation": (mark("regulation (E - U) I without heat: commutation drop"), "drop"),
    RETURNED: (mark("fed back by braking trains"), "recovered"),
    "conductor": (mark("heat in contact lines, rails and feeders"), "heat"),
    "feeders": (mark("heat in feeders and return feeders"), "heat"),
    "lines": (mark("heat in contact lines and rails"), "heat"),
    "load": (mark("fixed loads"), "electric"),
    "grid": (mark("fed into the grid by two-way substations"), "electric"),
    "line": (mark("from the contact line"), "electric"),
    ON_BOARD: (mark("of the electric brake, used on the train itself"), "recovered"),
    "auxiliaries": (mark("auxiliaries and heating"), "electric"),
    "starting_resistors": (mark("heat in starting resistors"), "heat"),
    "drive_loss": (mark("losses of the drives"), "heat"),
    "wheel": (mark("work at the wheel"), "mechanical"),
    "coupling": (mark("left out by the constant-voltage coupling"), "drop"),
    "resistance": (mark("running resistance, curves and tunnels"), "mechanical"),
    "kinetic": (mark("kinetic energy of trains at the end, less at the beginning"), "mechanical"),
    "potential": (mark("height gained"), "mechanical"),
    "braking_resistors": (mark("heat in braking resistors"), "heat"),
    "brakes": (mark("friction brakes, losses of the electric brakes"), "heat"),
    "all_brakes": (mark("friction brakes, braking resistors, losses of the electric brakes"), "heat"),
    "rest": (mark("differences between the ledgers"), "drop"),
}
"""What each flow is, and its kind."""

GIVEN_WORDS = {"potential": mark("height lost"), "kinetic": mark("kinetic energy of trains at the beginning, less at the end")}
"""What flows are that go in where others of their name go out."""

STAGES: dict[str, tuple[str, Kind]] = {
    "substations": (mark("Substations (E I)"), "electric"),
    "network": (mark("Contact line"), "electric"),
    "trains": (mark("Trains at the pantograph"), "electric"),
    "wheel": (mark("Work at the wheel"), "mechanical"),
    "braking": (mark("Braking"), "mechanical"),
}


@dataclass(frozen=True, slots=True)
class Flow:
    """A flow of energy into a stage or out of it [kWh]."""

    name: str
    words: str
    kind: Kind
    kwh: float


@dataclass(frozen=True, slots=True)
class Stage:
    """A stage: what comes from the stage before and the flows in `gains` leave as `spends` or go on to the next stage.

    What the last stage does not spend is recovered, and goes to the gains of these names in the stages before.
    """

    name: str
    words: str
    kind: Kind
    gains: tuple[Flow, ...]
    spends: tuple[Flow, ...]

    @property
    def left_kwh(self) -> float:
        """Return by how much what goes on differs from what came [kWh]."""
        return sum(flow.kwh for flow in self.gains) - sum(flow.kwh for flow in self.spends)


def energy_stages(data: RunData) -> list[Stage]:
    """Return the stages of a run in their order; none if it has no ledgers or nothing flows."""
    ledgers = data.results.run.get("ledgers") or {}
    electric, trains, wheel = (_energies(ledgers.get(name)) for name in ("electric", "pantograph_to_wheel", "mechanical"))
    recovered = max(trains.get("recovered", 0.0), 0.0)
    returned = min(max(_sum(data, "energy_returned_kwh"), 0.0), recovered) if electric else 0.0
    stages = [
        *(_supply(data, electric, returned) if electric else ()),
        *(_trains(trains, recovered - returned, bool(electric), _any(wheel)) if _any(trains) else ()),
        *(_wheel(wheel, recovered, _braking_resistors(data)) if _any(trains) and _any(wheel) else ()),
    ]
    stages = [stage for stage in stages if stage.gains or stage.spends]
    return _balanced(stages, recovered if _any(wheel) else 0.0)


def _energies(ledger: Mapping[str, Any] | None) -> dict[str, float]:
    """Return the energies of a ledger by name [kWh]."""
    return {name.removesuffix("_kwh"): float(value) for name, value in (ledger or {}).items() if name.endswith("_kwh")}


def _any(energies: Mapping[str, float]) -> bool:
    return any(abs(value) > 1e-6 for value in energies.values())


def _sum(data: RunData, figure: str) -> float:
    """Return the sum of a key figure over all of its places; 0 without it."""
    return sum(float(told["value"] or 0.0) for (name, _), told in data.key_figures.items() if name == figure)


def _split(whole: Mapping[str, float], part: Mapping[str, float], rest: str) -> dict[str, float]:
    """Return a flow in two, of which one is a known `part` of it; as it is where the part is nothing or no part of it."""
    (all_of_it,), (known,) = whole.values(), part.values()
    if not 0.0 < known <= all_of_it * (1.0 + 1e-6):
        return dict(whole)
    return {**part, rest: max(all_of_it - known, 0.0)}


def _braking_resistors(data: RunData) -> float | None:
    """Return the heat in the braking resistors of all trains [kWh]; None if the table does not hold every step."""
    rows, step_s = data.table("trains"), data.scenario.clock.step_s
    every_s = data.scenario.output.every_s
    if rows is None or "braking_resistor_kw" not in rows or (every_s and every_s > step_s):
        return None
    counted = rows["time_s"] >= data.counts_from_s
    return float(rows.loc[counted, "braking_resistor_kw"].sum()) * step_s / 3600.0


def _flow(name: str, kwh: float, *, given: bool = False) -> Flow:
    words, kind = WORDS[name]
    return Flow(name, tr(GIVEN_WORDS.get(name, words) if given else words), kind, abs(kwh))


def _stage(name: str, gains: Mapping[str, float], spends: Mapping[str, float]) -> Stage:
    """Return a stage of signed flows: one that is negative stands on the other side."""
    words, kind = STAGES[name]
    into = [_flow(key, kwh, given=True) for key, kwh in gains.items() if kwh > 0.0]
    into += [_flow(key, kwh, given=True) for key, kwh in spends.items() if kwh < 0.0]
    out = [_flow(key, kwh) for key, kwh in spends.items() if kwh > 0.0]
    out += [_flow(key, kwh) for key, kwh in gains.items() if kwh < 0.0]
    return Stage(name, tr(words), kind, tuple(into), tuple(out))


def _supply(data: RunData, electric: Mapping[str, float], returned: float) -> list[Stage]:
    source, drop = electric.get("source", 0.0), electric.get("regulation", 0.0)
    regulation = _split({"regulation": drop}, {"plant_heat": _sum(data, "plant_heat_kwh")}, "commutation")
    heat = _split({"conductor": electric.get("conductor", 0.0)}, {"feeders": _sum(data, "feeder_heat_kwh")}, "lines")
    spends = heat | {"load": electric.get("load", 0.0)}
    if source <= drop:  # trains and loads feed the grid
        return [_stage("network", {RETURNED: returned}, spends | regulation | {"grid": -source})]
    return [_stage("substations", {SOURCE: source}, regulation), _stage("network", {RETURNED: returned}, spends)]


def _trains(trains: Mapping[str, float], on_board: float, supplied: bool, moved: bool) -> list[Stage]:
    gains = {ON_BOARD: on_board} if supplied else {"line": trains.get("line", 0.0), ON_BOARD: on_board}
    names = ("auxiliaries", "starting_resistors", "drive_loss", "coupling", *(() if moved else ("wheel",)))
    return [_stage("trains", gains, {name: trains.get(name, 0.0) for name in names})]


def _wheel(wheel: Mapping[str, float], recovered: float, resistors: float | None) -> list[Stage]:
    moved = _stage("wheel", {}, {name: wheel.get(name, 0.0) for name in ("resistance", "potential", "kinetic")})
    heat = max(wheel.get("brakes", 0.0) - recovered, 0.0)
    if resistors is None:
        return [moved, _stage("braking", {}, {"all_brakes": heat})]
    resistors = min(resistors, heat)
    return [moved, _stage("braking", {}, {"braking_resistors": resistors, "brakes": heat - resistors})]


def _balanced(stages: list[Stage], recovered: float) -> list[Stage]:
    """Return stages whose sum is what is recovered: a difference between the ledgers becomes a flow of its own, if it matters."""
    if not stages:
        return []
    given = sum(flow.kwh for stage in stages for flow in stage.gains)
    rest = sum(stage.left_kwh for stage in stages) - recovered
    if given <= 0.0 or abs(rest) <= REST_SHARE * given:
        return stages if given > 0.0 else []
    last = stages[-1]
    flow = (_flow("rest", rest),)
    gains, spends = (last.gains, (*last.spends, *flow)) if rest > 0.0 else ((*last.gains, *flow), last.spends)
    return [*stages[:-1], Stage(last.name, last.words, last.kind, gains, spends)]
