"""Assumptions that line, trains and timetable rest on, as this run has them."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Sequence

from tractionpower.model.drive import InverterDrive, SeriesMotorDrive, TableDrive
from tractionpower.model.timetable import TrainRun
from tractionpower.model.vehicle import Adhesion, Brake, Vehicle
from tractionpower.movement.compile import train_of
from tractionpower.reporting.texts import mark, recorded, tr, trn
from tractionpower.reporting.workbook.common.assumption import Assumption, figure, names
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS, Facts

BY_MODEL = mark("method of the program, docs/model.md")
OF_STUDY = mark("of the study")
DEFAULT = mark("default")


def trains(facts: Facts) -> Iterator[Assumption]:
    """Yield what is taken of line, trains and timetable; nothing of a study without trains."""
    scenario = facts.scenario
    if not scenario.runs:
        return
    vehicles = {vehicle.id: vehicle for vehicle in scenario.vehicles}
    used = {train.id: train for train in (train_of(run, scenario.trains) for run in scenario.runs)}
    needed = {part.id: vehicles[part.id] for train in used.values() for part in train.vehicles}
    powered = {
        part.id for train in used.values() for part in train.vehicles if part.powered and vehicles[part.id].drive is not None
    }
    yield from _others(facts)
    yield from _driving(facts)
    yield from _line(facts)
    point = [train.id for train in used.values() if train.mass_distribution == "point"]
    if len(point) < len(used):
        yield Assumption(
            tr("Gradients and curves act as their mean under the length of a train, whose mass is spread evenly."),
            tr("all trains") if not point else names(each for each in used if each not in point), tr(DEFAULT),
        )  # fmt: skip
    if point:
        yield Assumption(
            tr("Gradients and curves act under the front of a train, as if it were a point."), names(point), tr(OF_STUDY)
        )
    empty = [
        train.id for train in used.values()
        if any(part.load_percent == 0.0 and vehicles[part.id].load_t > 0.0 for part in train.vehicles)
    ]  # fmt: skip
    if empty:
        yield Assumption(tr("Vehicles of these trains that could carry a load run without one."), names(empty), tr(OF_STUDY))
    yield from _drives(facts, [needed[name] for name in sorted(powered)])
    own_rate = {part.id for train in used.values() if train.service_rate_mps2 is None for part in train.vehicles}
    yield from _brakes([needed[name] for name in sorted(needed)], powered, own_rate)
    yield from _auxiliaries(sorted(needed.values(), key=lambda vehicle: vehicle.id))


def _others(facts: Facts) -> Iterator[Assumption]:
    runs = facts.scenario.runs
    if len(runs) > 1:
        pairs = int((facts.run.get("overlaps") or {}).get("count") or 0)
        found = (
            trn("{count} pair of them overlaps in this run.", "{count} pairs of them overlap in this run.", pairs)
            if pairs
            else ""
        )
        text = tr("Trains do not see each other and no signal holds them.")
        yield Assumption(f"{text} {found}".strip(), tr("all trains"), tr(BY_MODEL))
    yield Assumption(
        tr("A train is one mass with one current collector at its front, and takes its current there."),
        tr("all trains"),
        tr(BY_MODEL),
    )


def _driving(facts: Facts) -> Iterator[Assumption]:
    scenario = facts.scenario
    runs = scenario.runs
    usual = scenario.timetable.driving
    plans = [run.id for run in runs if _has_plan(run, usual)]
    if len(plans) < len(runs):
        whose = tr("all trains") if not plans else tr("{count} trains without a plan", count=len(runs) - len(plans))
        yield Assumption(
            tr("Trains are driven flat out: as fast as limits, effort and voltage allow, and wait at stops."), whose, tr(DEFAULT)
        )
    if plans:
        yield Assumption(
            tr("Trains follow a driving plan while they are on time, and are driven flat out when they are late."),
            names(plans),
            tr(OF_STUDY),
        )
    moving = [run.id for run in runs if run.start is not None and run.start.speed_kmh > 0.0]
    if moving:
        yield Assumption(
            tr("These trains come onto the line at the speed that the timetable gives."), names(moving), tr(OF_STUDY)
        )
    early = [run.id for run in runs if _begin(run) < scenario.clock.start]
    if early:
        yield Assumption(
            tr("Trains that start before the clock have run at the nominal voltage until then."), names(early), tr(BY_MODEL)
        )
    unheld = sum(call.stops and call.min_dwell_s == 0.0 for run in runs for call in run.calls)
    if unheld:
        yield Assumption(
            trn("{count} stop has no shortest dwell: a late train leaves it at once.",
                "{count} stops have no shortest dwell: a late train leaves them at once.", unheld),
            tr("timetable"), tr(DEFAULT),
        )  # fmt: skip
    if scenario.clock.start == 0.0 and not scenario.timetable.carry_over:
        yield Assumption(
            tr("Trains of the day before are not on the line at the start."), tr("first hours of the run"), tr(DEFAULT)
        )


def _has_plan(run: TrainRun, usual: object) -> bool:
    driving = run.driving or usual
    return driving is not None and getattr(driving, "kind", "") != "flat_out"


def _begin(run: TrainRun) -> float:
    if run.start is not None:
        return run.start.time
    return run.calls[0].departure or 0.0


def _line(facts: Facts) -> Iterator[Assumption]:
    line = facts.scenario.line
    if not line.gradients:
        yield Assumption(tr("The line is level: the study gives no gradients."), tr("running resistance"), tr(DEFAULT))
    if not line.curves:
        yield Assumption(tr("The line is straight: the study gives no curves."), tr("running resistance"), tr(DEFAULT))
    elif line.curve_resistance is None:
        yield Assumption(
            tr("Resistance in curves by Roeckl: 650/(R - 55) N/kN, 500/(R - 30) below 300 m."),
            tr("running resistance"),
            tr(DEFAULT),
        )
    if not line.tunnels:
        yield Assumption(tr("No tunnels: the study gives none."), tr("running resistance"), tr(DEFAULT))
    if not line.train_current_limits:
        yield Assumption(tr("The line does not limit the currents of trains."), tr("traction"), tr(DEFAULT))
    else:
        free = [limit for limit in line.train_current_limits if limit.standstill_current_a is None]
        if free:
            yield Assumption(
                tr("Where no current at standstill is given, that of the moving train holds."), tr("trains at rest"), tr(DEFAULT)
            )


def _drives(facts: Facts, vehicles: Sequence[Vehicle]) -> Iterator[Assumption]:
    inverters = [(vehicle, vehicle.drive) for vehicle in vehicles if isinstance(vehicle.drive, InverterDrive)]
    constant = [(vehicle.id, drive.efficiency) for vehicle, drive in inverters if drive.efficiency is not None]
    if constant:
        told = names(f"{name} {figure(value)}" for name, value in constant)
        yield Assumption(tr("The efficiency of these drives is constant, at any speed and load."), told, tr(OF_STUDY))
    yield from _knees(facts, vehicles)
    series = [vehicle.id for vehicle in vehicles if isinstance(vehicle.drive, SeriesMotorDrive)]
    if series:
        yield Assumption(
            tr("Series motors choose their grouping and field by the voltage of the step before; at part effort neighbouring"
               " notches take"
               " turns, and the mean counts."),
            names(series), tr(BY_MODEL),
        )  # fmt: skip
    tables = [vehicle.id for vehicle in vehicles if isinstance(vehicle.drive, TableDrive)]
    if tables:
        yield Assumption(
            tr("Effort and current by tables; at part effort the current falls in proportion to the power."),
            names(tables),
            tr(BY_MODEL),
        )
    unlimited = [vehicle.id for vehicle in vehicles if vehicle.adhesive_mass_t is None]
    if unlimited:
        yield Assumption(tr("No adhesion limit: the adhesive mass is not given."), names(unlimited), tr(DEFAULT))
    dry = [vehicle.id for vehicle in vehicles if vehicle.adhesive_mass_t is not None and vehicle.adhesion == Adhesion()]
    if dry:
        usual = Adhesion()
        yield Assumption(
            tr("Adhesion of dry rails by Curtius and Kniffler, {a}/(V + {b}) + {c} with V in km/h.",
               a=figure(usual.a_kmh), b=figure(usual.b_kmh), c=figure(usual.c)),
            names(dry), tr("default; Curtius and Kniffler, secondary"),
        )  # fmt: skip


def _knees(facts: Facts, vehicles: Sequence[Vehicle]) -> Iterator[Assumption]:
    """Yield how drives reduce their current at low voltage."""
    inverters = [(vehicle.id, vehicle.drive) for vehicle in vehicles if isinstance(vehicle.drive, InverterDrive)]
    usual = [name for name, drive in inverters if drive.knee_factor is None]
    limit = facts.limit("knee_factor")
    if usual and limit is not None:
        known = f"{recorded(KNOWN_AS.get(limit.status, limit.status))}; {recorded(limit.source)}"
        yield Assumption(
            tr("Below {knee} of the nominal voltage the current falls in a straight line, to that of the auxiliaries at U_min2.",
               knee=figure(limit.value)),
            names(usual), known,
        )  # fmt: skip
    reckoned = [name for name, drive in inverters if drive.max_current_a is None]
    if reckoned:
        yield Assumption(
            tr("The greatest current of these drives is what their full power takes at that knee."), names(reckoned), tr(DEFAULT)
        )
    others = [vehicle for vehicle in vehicles if isinstance(vehicle.drive, SeriesMotorDrive | TableDrive)]
    free = [vehicle.id for vehicle in others if vehicle.drive is not None and vehicle.drive.knee_factor is None]
    if free:
        yield Assumption(
            tr("These drives do not reduce their current at low voltage: they take what their characteristic gives."),
            names(free), tr(DEFAULT),
        )  # fmt: skip


def _brakes(vehicles: Sequence[Vehicle], powered: Iterable[str], own_rate: Collection[str]) -> Iterator[Assumption]:
    usual = Brake().service_rate_mps2
    default = [vehicle.id for vehicle in vehicles if vehicle.id in own_rate and vehicle.brake.service_rate_mps2 == usual]
    if default:
        yield Assumption(
            tr("Service braking with {rate} m/s² on level straight track.", rate=figure(usual)), names(default), tr(DEFAULT)
        )
    driven = [vehicle for vehicle in vehicles if vehicle.id in set(powered)]
    returning = [vehicle for vehicle in driven if _returns(vehicle)]
    none = [vehicle.id for vehicle in driven if not _returns(vehicle)]
    if returning:
        yield Assumption(
            tr("What the electric brake gives feeds the train's own auxiliaries first; the rest goes back into the line, less"
               " and less"
               " between two voltages of the vehicle (by default U_max1 and U_max2)."),
            names(vehicle.id for vehicle in returning), tr(BY_MODEL),
        )  # fmt: skip
    if none:
        yield Assumption(tr("These vehicles feed nothing back into the line."), names(none), tr(OF_STUDY))


def _returns(vehicle: Vehicle) -> bool:
    brake = vehicle.brake
    by_drive = not isinstance(vehicle.drive, SeriesMotorDrive)
    can = brake.electric_effort_kn > 0.0 and brake.electric_power_kw > 0.0
    return can and (by_drive if brake.regenerates is None else brake.regenerates)


def _auxiliaries(vehicles: Sequence[Vehicle]) -> Iterator[Assumption]:
    some = [vehicle for vehicle in vehicles if vehicle.auxiliaries.power_kw or vehicle.auxiliaries.heating_kw]
    without = [vehicle.id for vehicle in vehicles if vehicle not in some]
    if some:
        yield Assumption(
            tr("Auxiliaries take a constant power throughout, at rest and in motion, less below U_min2; resistive heating goes"
               " with the"
               " square of the voltage."),
            names(vehicle.id for vehicle in some), tr(BY_MODEL),
        )  # fmt: skip
    if without:
        yield Assumption(tr("These vehicles have no auxiliary power."), names(without), tr(DEFAULT))
