"""Sensitivities of the lost seconds: real runs with small changes of the most loaded devices and of classes of trains."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial

from tractionpower.errors import InputError
from tractionpower.model.change import apply_changes
from tractionpower.model.scenario import Scenario
from tractionpower.model.supply import SectionCabin, Substation
from tractionpower.studies.feasibility import Judgement
from tractionpower.studies.remedies.allowance import Allowance
from tractionpower.studies.remedies.caps import cap_changes, greatest_of
from tractionpower.studies.remedies.case import Case
from tractionpower.studies.remedies.fleet import classes_of
from tractionpower.studies.remedies.remedy import Sensitivity

CAP_PERCENT = 10.0
VOLTAGE_PERCENT = 1.0

Judge = Callable[[Scenario], Judgement]


@dataclass(frozen=True, slots=True)
class SmallChange:
    """A small change: what is changed of whom, by how much, and the changes by path."""

    kind: str
    subject: str
    per: str
    change: tuple[str, ...]


def lost_seconds(judgement: Judgement) -> float:
    """Return the seconds that all trains lose to low voltage [s]."""
    return math.fsum(row.lost_s for row in judgement.lost)


def small_changes(case: Case, judgement: Judgement) -> list[SmallChange]:
    """Return the small changes to try, the most promising first: devices of the areas in which most is lost, then classes."""
    lost: dict[str, float] = {}
    for row in judgement.lost:
        lost[row.area] = lost.get(row.area, 0.0) + row.lost_s
    supply = case.scenario.supply
    ranked = sorted(supply.substations, key=lambda station: (-lost.get(station.id, 0.0), station.id))
    turns = [list(_of_substation(station)) for station in ranked]
    turns += [[_closed(cabin)] for cabin in supply.section_cabins if cabin.state != "closed"]
    turns += [list(_of_classes(case))]
    # One of each in turn, so that a short list holds the best of every kind.
    longest = max(map(len, turns), default=0)
    mixed = [turn[k] for k in range(longest) for turn in turns if k < len(turn)]
    return mixed[: case.bounds.sensitivities]


def sensitivities(
    case: Case, scenario: Scenario, judgement: Judgement, judge: Judge, allowance: Allowance | None = None
) -> tuple[Sensitivity, ...]:
    """Return the sensitivities of the lost seconds, the greatest first.

    Parameters
    ----------
    case
        What is known of the study.
    scenario
        The study, or the window of it that is run.
    judgement
        The judgement of the whole study, by which the changes are chosen.
    judge
        Judges a scenario.
    allowance
        How long to go on.
    """
    allowance = Allowance() if allowance is None else allowance
    changes = small_changes(case, judgement)
    if not changes:
        return ()
    (base,) = allowance.run_all([lambda: lost_seconds(judge(scenario))], 1)
    if base is None:
        return ()

    def try_one(small: SmallChange) -> Sensitivity | None:
        if allowance.over:
            return None
        try:
            lost = lost_seconds(judge(apply_changes(scenario, small.change)))
        except InputError:  # the changed study breaks a rule, such as a voltage beyond the limits of the system
            return None
        return Sensitivity(small.kind, small.subject, small.per, lost - base, small.change)

    tasks = [partial(try_one, small) for small in changes]
    found = [row for row in allowance.run_all(tasks, case.bounds.workers) if row is not None]
    return tuple(sorted(found, key=lambda row: (-abs(row.lost_s_change), row.kind, row.subject)))


def _of_substation(station: Substation) -> Iterator[SmallChange]:
    path = f"supply.substations[{station.id}]"
    if station.state != "in_service":
        yield SmallChange("in_service", station.id, f"{station.state} to in_service", (f"{path}.state=in_service",))
        return
    if station.units_in_service is not None and station.units_in_service < station.units:
        more = station.units_in_service + 1
        yield SmallChange("units", station.id, f"{more} units in place of {more - 1}", (f"{path}.units_in_service={more}",))
    elif station.units > 1:
        yield _one_more_unit(station, path)
    volts = station.no_load_voltage_v * (1.0 + VOLTAGE_PERCENT / 100.0)
    yield SmallChange(
        "no_load_voltage", station.id, f"+{VOLTAGE_PERCENT:g} %", (f"{path}.no_load_voltage_v={round(volts, 6):.10g}",)
    )  # fmt: skip
    least = station.grid_resistance_ohm
    ohm = station.plant_resistance_ohm * (1.0 - VOLTAGE_PERCENT / 100.0)
    if ohm > least:
        text = f"{path}.internal_resistance_ohm={ohm:.9f}"
        if station.unit_resistance_ohm is not None:
            text = f"{path}.unit_resistance_ohm={(ohm - least) * station.units:.9f}"
        yield SmallChange("internal_resistance", station.id, f"-{VOLTAGE_PERCENT:g} %", (text,))


def _one_more_unit(station: Substation, path: str) -> SmallChange:
    # R = R_unit / n + R_grid, see Substation
    units = station.units + 1
    shared = (station.plant_resistance_ohm - station.grid_resistance_ohm) * station.units / units
    changes = [f"{path}.units={units}"]
    if station.unit_resistance_ohm is None:
        changes.append(f"{path}.internal_resistance_ohm={station.grid_resistance_ohm + shared:.9f}")
    if station.units_in_service is not None:
        changes.append(f"{path}.units_in_service={units}")
    return SmallChange("units", station.id, f"{units} units in place of {units - 1}", tuple(changes))


def _closed(cabin: SectionCabin) -> SmallChange:
    change = f"supply.section_cabins[{cabin.id}].state=closed"
    return SmallChange("section_cabin", cabin.id, f"{cabin.state} to closed", (change,))


def _of_classes(case: Case) -> Iterator[SmallChange]:
    classes = classes_of(case.scenario, case.known.values())
    alone = {item.words: (item,) for item in case.foremost if not any(item in members for members in classes.values())}
    for name, members in (classes | alone).items():
        greatest = [(item, peak) for item in members if (peak := greatest_of(case, "current_cap", item)) > 0.0]
        if greatest and not set(members).isdisjoint(case.foremost):
            changes = cap_changes("current_cap", greatest, CAP_PERCENT)
            yield SmallChange("current_cap", name, f"-{CAP_PERCENT:g} %", changes)
