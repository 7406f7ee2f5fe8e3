"""Which outages there are: each device by itself, at each grid voltage, and pairs of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import SequenceMatcher
from itertools import combinations

from tractionpower.errors import InputError, Problem
from tractionpower.io.wording import did_you_mean
from tractionpower.model.base import format_time
from tractionpower.model.contingency import OUTAGE_KINDS
from tractionpower.model.limits import common_limits
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import SectionCabin, Substation
from tractionpower.studies.contingency.line_sections import LineSection, find_line_sections
from tractionpower.studies.contingency.moves import Move, Setting, changes_of, grid_changes
from tractionpower.studies.contingency.reserves import worst_waits
from tractionpower.studies.runner.case import Case
from tractionpower.supply.site import survey

GRIDS = ("normal", "low", "high")
BASE = "base"

MOST_NAMED = 12
"""Devices that are named where one is unknown."""

LEAST_LIKE = 0.6
"""How alike the words of two devices are that could be meant by each other, 1 if they are the same."""


@dataclass(frozen=True, slots=True)
class Outage:
    """Something that is out.

    Attributes
    ----------
    kind, subject, mode
        Columns of table ``cases``.
    moves
        What it moves.
    names
        By which a choice of devices may mean it.
    takes
        What is out with it: where this holds all that another takes, the two are no pair.
    bridged
        Feeders that a closed bypass lies across: opening them parts nothing any more.
    """

    kind: str
    subject: str
    mode: str
    moves: tuple[Move, ...]
    names: frozenset[str]
    takes: frozenset[str]
    bridged: frozenset[str] = frozenset()

    @property
    def id(self) -> str:
        """Identifier of its case at normal grid voltage."""
        return f"{self.subject} {self.mode}"

    def contains(self, other: Outage) -> bool:
        """Return whether all that another takes out is out with it."""
        return other.takes <= self.takes

    def contradicts(self, other: Outage) -> bool:
        """Return whether both move a device to different states, or one opens what the other bridges."""
        mine, its = ({move.device: move.settings for move in outage.moves} for outage in (self, other))
        differ = any(mine[device] != its[device] for device in mine.keys() & its.keys())
        return differ or not self.bridged.isdisjoint(its) or not other.bridged.isdisjoint(mine)


@dataclass(frozen=True, slots=True)
class OutageList:
    """The cases of a study of outages.

    Attributes
    ----------
    cases
        The base cases, then the outages at one grid voltage after the other.
    notes
        What is not looked at, and why.
    begins
        When outages of units that a reserve replaces begin, and why then.
    """

    cases: tuple[Case, ...]
    notes: tuple[str, ...]
    begins: tuple[str, ...] = ()


def outages(scenario: Scenario, pairs: bool = False) -> tuple[Case, ...]:
    """Return the cases of a study of outages; see `find_outages`."""
    return find_outages(scenario, pairs=pairs).cases


def find_outages(scenario: Scenario, *, pairs: bool = False, grids: Sequence[str] | None = None) -> OutageList:
    """Return the cases that `scenario.contingency` asks for: base cases first, then outages one by one, then pairs.

    Parameters
    ----------
    scenario
        What is looked at; it has passed the checks.
    pairs
        Whether all pairs of different devices are out, too.
    grids
        Grid voltages of all cases; left out: those of the study, and for pairs the normal one.

    Raises
    ------
    InputError
        If a device is named that does not exist, or outages begin after the end of the clock.
    """
    finder = _Finder(scenario)
    every = list(finder.every())
    chosen = _chosen(scenario, every)
    wanted = grids or scenario.contingency.grid_voltages
    factors = dict(_grid_factors(scenario, sorted({"normal", *wanted}, key=GRIDS.index), finder.notes))
    found = [Case(_at(BASE, grid), _grid(scenario, factors[grid]), "base", "", "", grid, True) for grid in factors]
    wanted = [grid for grid in factors if grid in wanted]
    found += [_case(scenario, (outage,), grid, factors[grid]) for grid in wanted for outage in chosen]
    if pairs:
        of_pairs = wanted if grids is not None or "normal" not in wanted else ["normal"]
        couples = _couples(chosen, finder.notes)
        found += [_case(scenario, pair, grid, factors[grid]) for grid in of_pairs for pair in couples]
    told = {outage.subject for outage in chosen}
    return OutageList(tuple(found), tuple(finder.notes), tuple(words for name, words in finder.begins.items() if name in told))


def _couples(chosen: Sequence[Outage], notes: list[str]) -> list[tuple[Outage, Outage]]:
    """Return the pairs of outages that can be out together and are more than one of them alone; note how many are left out."""
    found, contained, contrary = [], 0, 0
    for first, second in combinations(chosen, 2):
        if first.contains(second) or second.contains(first):
            contained += 1
        elif first.contradicts(second):
            contrary += 1
        else:
            found.append((first, second))
    if contained:
        notes.append(f"{contained} pairs: one outage contains the other")
    if contrary:
        notes.append(f"{contrary} pairs: they move a device to different states, or one opens what the other bypasses")
    return found


def _case(scenario: Scenario, out: tuple[Outage, ...], grid: str, factor: float) -> Case:
    changes = (*_grid(scenario, factor), *changes_of(scenario, (move for outage in out for move in outage.moves)))
    name, subject, mode = (" + ".join(getattr(outage, what) for outage in out) for what in ("id", "subject", "mode"))
    return Case(_at(name, grid), changes, out[0].kind if len(out) == 1 else "pair", subject, mode, grid)


def _at(name: str, grid: str) -> str:
    return name if grid == "normal" else f"{name}, grid {grid}"


def _grid(scenario: Scenario, factor: float) -> tuple[str, ...]:
    return () if factor == 1.0 else grid_changes(scenario, factor)


def _grid_factors(scenario: Scenario, grids: Iterable[str], notes: list[str]) -> Iterator[tuple[str, float]]:
    """Yield each grid voltage with its value as a multiple of the declared one."""
    limits, wish = common_limits(scenario.limits, scenario.supply.system, "grid_"), scenario.contingency
    given = {"normal": 1.0, "low": wish.low_grid_voltage_pu, "high": wish.high_grid_voltage_pu}
    for grid in grids:
        row, factor = limits.get(f"grid_{grid}"), given[grid]
        if factor is None and row is not None:
            factor = row.value
        if factor is None:
            notes.append(f"{grid} grid voltage: left out, for the limits table has no row grid_{grid}")
        elif factor == 1.0 and grid != "normal":
            notes.append(f"{grid} grid voltage: left out, for it is the normal one")
        else:
            yield grid, factor


def _chosen(scenario: Scenario, every: Sequence[Outage]) -> list[Outage]:
    """Return the outages of the wished kinds and devices; a wish that none of them fulfils is an error."""
    wish = scenario.contingency
    of_devices = every
    if wish.devices is not None:
        _refuse_unknown(scenario, wish.devices, every)
        of_devices = [outage for outage in every if not outage.names.isdisjoint(wish.devices)]
    chosen = [outage for kind in OUTAGE_KINDS if kind in wish.kinds for outage in of_devices if outage.kind == kind]
    if every and not chosen:
        found = f"there is no outage of {_listed(wish.kinds)}" + (f" at {', '.join(wish.devices)}" if wish.devices else "")
        there = ", ".join(dict.fromkeys(outage.kind for outage in of_devices))
        path = "contingency.kinds" if there else "contingency.devices"
        raise InputError([Problem("no_outage", path, found, f"there are outages of {there}" if there else "none at all there")])
    return chosen


def _listed(kinds: Sequence[str]) -> str:
    return "any kind" if len(kinds) == len(OUTAGE_KINDS) else f"kind {' or '.join(kinds)}"


def _refuse_unknown(scenario: Scenario, devices: Sequence[str], every: Sequence[Outage]) -> None:
    stations = [*(station.id for station in scenario.supply.substations), *(cabin.id for cabin in scenario.supply.section_cabins)]
    known = list(dict.fromkeys([*stations, *(name for outage in every for name in sorted(outage.names))]))
    more = f" and {len(known) - MOST_NAMED} more" if len(known) > MOST_NAMED else ""
    allowed = f"{', '.join(known[:MOST_NAMED])}{more}"
    problems = [
        Problem(
            "unknown_device", f"contingency.devices[{k}]", f"there is no device {name!r} that could be out",
            allowed, nearest_device(name, known),
        )
        for k, name in enumerate(devices) if name not in known
    ]  # fmt: skip
    if problems:
        raise InputError(problems)


def nearest_device(name: str, known: Sequence[str]) -> str:
    """Return the remedy for an unknown device: the one of as many words that is most like it, word by word.

    >>> nearest_device("A 1 lowkm", ["A", "A 1 high_km", "A 1 low_km", "AA 1 low_km"])
    'did you mean A 1 low_km?'
    """
    words = name.lower().split()

    def likeness(other: str) -> float:
        pairs = zip(words, other.lower().split(), strict=True)
        return sum(SequenceMatcher(None, mine, its).ratio() for mine, its in pairs) / len(words)

    alike = {other: likeness(other) for other in known if len(other.split()) == len(words)} if words else {}
    best = max(alike, key=lambda other: alike[other], default="")
    return f"did you mean {best}?" if alike.get(best, 0.0) >= LEAST_LIKE else did_you_mean(name, known)


class _Finder:
    """Finds all outages, whatever is chosen of them."""

    def __init__(self, scenario: Scenario) -> None:
        self.scenario, self.supply = scenario, scenario.supply
        self.begins_s = scenario.contingency.begins
        if self.begins_s is not None and self.begins_s >= scenario.clock.end:
            found = f"outages that begin at {format_time(self.begins_s)}, after the end of the run"
            raise InputError([Problem("no_outage", "contingency.begins", found, f"before {format_time(scenario.clock.end)}")])
        site = survey(scenario.supply, scenario.line)
        self.feeders = {station.id: site.feeders(station) for station in site.stations}
        self.open_rows = {row.id for row in scenario.supply.feeders if row.state == "open"}
        self.moving = {event.device for event in scenario.supply.switch_events}
        self.substations = sorted(scenario.supply.substations, key=lambda station: station.id)
        self.cabins = sorted(scenario.supply.section_cabins, key=lambda cabin: cabin.id)
        self.notes: list[str] = []
        self.begins: dict[str, str] = {}
        asked = "unit" in scenario.contingency.kinds and self.begins_s is None
        self._worst_s = worst_waits(scenario) if asked else {}

    def every(self) -> Iterator[Outage]:
        """Yield all outages in their order."""
        for station in self.substations:
            yield from self._unit(station)
        wish = self.scenario.contingency
        for station in self.substations:
            yield from self._station("substation", station, wish.substation_modes, ("bypassed", "open"))
        for station in self.substations:
            yield from self._feeders(station)
        for cabin in self.cabins:
            yield from self._station("section_cabin", cabin, wish.cabin_modes, ("bypassed", "open"))
        for section in find_line_sections(self.scenario):
            yield from self._section(section)

    def _skip(self, kind: str, what: str) -> None:
        if kind in self.scenario.contingency.kinds:
            self.notes.append(what)

    def _set(self, device: str, value: str | int, field: str = "state") -> Move:
        return Move(device, ((self.begins_s, field, value),))

    def _unit(self, station: Substation) -> Iterator[Outage]:
        units, name = station.units if station.units_in_service is None else station.units_in_service, f"{station.id} unit"
        if not units or station.state != "in_service":
            self._skip("unit", f"{name}: none is in service")
            return
        names, takes = frozenset({station.id, name}), frozenset({name})
        if station.reserve_units:
            if station.reserve_after_s == 0.0:
                self._skip("unit", f"{name}: its reserve feeds at once, so nothing changes")
                return
            yield Outage("unit", name, f"{units - 1} of {units} in service, reserve after {station.reserve_after_s:g} s",
                         (Move(station.id, self._until_reserve(station, units, name)),), names, takes)  # fmt: skip
            return
        if units == 1:  # no unit is left: the same as a substation whose rectifiers are out
            yield Outage("unit", name, "rectifiers_out", (self._set(station.id, "rectifiers_out"),), names, takes)
            return
        move = self._set(station.id, units - 1, "units_in_service")
        yield Outage("unit", name, f"{units - 1} of {units} in service", (move,), names, takes)

    def _until_reserve(self, station: Substation, units: int, name: str) -> tuple[Setting, ...]:
        """Return what a substation takes while its reserve is awaited; by default in the time that is the worst for it."""
        from_s, lasts = self.begins_s, f"{station.reserve_after_s:g} s"
        if from_s is None:
            from_s = self._worst_s.get(station.id, self.scenario.clock.start)  # not looked for where no unit is asked for
            why = f"when its units carry most over {lasts} with nothing out, by the root mean square"
        else:
            why = "as contingency.begins says"
        again_s = from_s + station.reserve_after_s
        self.begins[name] = f"{name}: out from {format_time(from_s)}, {why}; its reserve feeds {lasts} later"
        return (from_s, "units_in_service", units - 1), (again_s, "units_in_service", units)

    def _station(
        self, kind: str, station: Substation | SectionCabin, modes: Iterable[str], out: Sequence[str]
    ) -> Iterator[Outage]:
        feeders = frozenset(" ".join((station.id, *key)) for key in self.feeders[station.id])
        plant = frozenset({station.id, f"{station.id} unit"})
        for mode in modes:
            if station.state in (*out, mode):
                self._skip(kind, f"{station.id} {mode}: it is {station.state} already")
                continue
            takes = plant if mode == "rectifiers_out" else plant | feeders  # rectifiers out: the busbars still join the feeders
            bridged = feeders if mode == "bypassed" else frozenset[str]()
            move = self._set(station.id, mode)
            yield Outage(kind, station.id, mode, (move,), frozenset({station.id}), takes, bridged)

    def _feeders(self, station: Substation) -> Iterator[Outage]:
        for key in self.feeders[station.id]:
            name = " ".join((station.id, *key))
            if name in self.open_rows or station.state in ("bypassed", "open"):
                self._skip("feeder", f"{name}: it is open already")
                continue
            yield Outage("feeder", name, "open", (self._set(name, "open"),), frozenset({station.id, name}), frozenset({name}))

    def _section(self, section: LineSection) -> Iterator[Outage]:
        if not section.closed:
            self._skip("contact_line", f"{section.name}: nothing feeds it")
            return
        moved = [device for device in section.ends if device in section.closed or self._moves(device)]
        moves = tuple(self._set(device, "open") for device in moved)
        takes = frozenset({section.name, *moved})
        yield Outage("contact_line", section.name, "dead", moves, frozenset({section.name}), takes)

    def _moves(self, device: str) -> bool:
        """Tell whether a feeder, switch or section point is moved in the run, or its substation or section cabin is."""
        return device in self.moving or device.rsplit(" ", 2)[0] in self.moving
