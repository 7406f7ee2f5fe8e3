"""``tractionpower curves TRAIN``: effort, resistance and current of a train over speed and voltage."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from tractionpower.model.limits import Limit, SystemVoltages
    from tractionpower.model.vehicle import Train, Vehicle
    from tractionpower.movement.curves import TrainCurves

FASTEST_KMH = 600.0
"""Speed up to which a balancing speed is sought [km/h]."""


def curves(
    train: Annotated[
        str, typer.Argument(metavar="TRAIN", help="A shipped train or vehicle, or the file of a train or a vehicle.")
    ],
    voltage: Annotated[
        list[float] | None, typer.Option("--voltage", metavar="V", help="A voltage; may be repeated. Default: from U_min2 up.")
    ] = None,
    system: Annotated[str, typer.Option("--system", help="System of the voltage limits.")] = "dc3000",
    out: Annotated[Path | None, typer.Option("--out", help="Folder for figure and table; default reports/curves/ here.")] = None,
) -> None:
    """Draw effort and current of a train over its speed."""
    from tractionpower.cli.messages import tell
    from tractionpower.errors import OutputError, UsageError
    from tractionpower.io.limits_files import shipped_limits
    from tractionpower.io.rolling_stock import load_train
    from tractionpower.model.limits import known_systems, system_voltages
    from tractionpower.movement.curves import drive_curves
    from tractionpower.reporting.figures.base.style import png_names, save
    from tractionpower.reporting.figures.trains.curve_figures import curves_figure, has_drive, resistance_figure, write_curves_csv

    limits = shipped_limits()
    if system not in known_systems(limits):
        raise UsageError(f"no system {system!r}; known: {', '.join(known_systems(limits))}")
    for value in voltage or []:
        if not (math.isfinite(value) and 1.0 <= value <= 100_000.0):
            raise UsageError(f"--voltage {value:g}: allowed are 1 to 100000 V")
    declared, vehicles = load_train(train)
    voltages = system_voltages(limits, system)
    _check(train, declared, vehicles, voltages)
    chosen = sorted(set(voltage)) if voltage else None
    drawn = drive_curves(declared, vehicles, limits, system, chosen)
    at_nominal = drive_curves(declared, vehicles, limits, system, [voltages.u_n])
    beyond = partial(_faster_curves, declared, vehicles, limits, system)
    _show(declared.name or declared.id, at_nominal, drawn, beyond)
    folder = out if out is not None else Path("reports") / "curves"
    figure = folder / png_names([declared.id])[declared.id]
    title = f"{declared.name or declared.id}: {drawn.mass_kg / 1000.0:.1f} t, {drawn.length_m:.1f} m"
    draw = curves_figure if has_drive(at_nominal) else resistance_figure
    try:
        paths = [save(draw(drawn, title), figure), write_curves_csv(drawn, figure.with_suffix(".csv"))]
    except OSError as error:
        raise OutputError(f"curves cannot be written into {folder}: {error}") from error
    tell("results: " + ", ".join(str(path) for path in paths))


def _check(argument: str, train: Train, vehicles: Sequence[Vehicle], voltages: SystemVoltages) -> None:
    """Tell what is doubtful with a train and its vehicles, and raise what is wrong, all of it at once."""
    from dataclasses import replace

    from tractionpower.cli.messages import tell_problems
    from tractionpower.errors import raise_errors
    from tractionpower.movement.stock_checks import check_train, check_vehicle

    problems = [problem for vehicle in vehicles for problem in check_vehicle(vehicle, voltages)]
    problems += check_train(f"trains[{train.id}].vehicles", train.vehicles, {item.id: item for item in vehicles}, voltages)
    problems = [replace(problem, place=argument) for problem in problems]
    raise_errors(problems)
    tell_problems(problems)


def _faster_curves(train: Train, vehicles: Sequence[Vehicle], limits: Sequence[Limit], system: str) -> TrainCurves | None:
    """Return the curves at nominal voltage beyond the top speed; None where a table of the drive says nothing there."""
    from tractionpower.model.drive import TableDrive
    from tractionpower.model.limits import system_voltages
    from tractionpower.movement.curves import drive_curves

    known: dict[float | None, float] = {}  # to which speed each curve goes
    for vehicle in vehicles:
        for point in vehicle.drive.effort if isinstance(vehicle.drive, TableDrive) else ():
            known[point.voltage_v] = max(point.speed_kmh, known.get(point.voltage_v, 0.0))
    top = {"max_speed_kmh": min(FASTEST_KMH, *known.values())} if known else {"max_speed_kmh": FASTEST_KMH}
    if known and top["max_speed_kmh"] <= min(vehicle.max_speed_kmh for vehicle in vehicles):
        return None
    faster = [vehicle.model_copy(update=top) for vehicle in vehicles]
    return drive_curves(train.model_copy(update=top), faster, limits, system, [system_voltages(limits, system).u_n])


def _balance(nominal: TrainCurves, beyond: Callable[[], TrainCurves | None]) -> str:
    """Return the balancing speed in words; the curve goes on beyond the top speed where it is known there."""
    from tractionpower.reporting.figures.trains.curve_figures import balancing_speed

    top, speed = float(nominal.speed_mps[-1]), balancing_speed(nominal)
    if speed is not None:
        return f"{3.6 * speed:.1f} km/h"
    faster = beyond()
    speed = None if faster is None else balancing_speed(faster)
    if speed is None:
        return "above its greatest speed"
    return f"{3.6 * max(speed, top):.1f} km/h, above its greatest speed of {3.6 * top:g} km/h"


def _show(name: str, nominal: TrainCurves, drawn: TrainCurves, beyond: Callable[[], TrainCurves | None]) -> None:
    """Print what one asks first of a train: how it starts, how fast it can run, what it takes."""
    from tractionpower.cli.console import new_console
    from tractionpower.reporting.figures.trains.curve_figures import has_drive, starting_gradient

    console = new_console()
    curve = nominal.curves[0]
    console.print(f"{name}: {nominal.mass_kg / 1000.0:.1f} t, {nominal.length_m:.1f} m, {3.6 * nominal.speed_mps[-1]:g} km/h")
    if not has_drive(nominal):
        console.print("no drive")
        return
    console.print(f"starting effort at {curve.voltage_v:g} V: {curve.effort_n[0] / 1000.0:.1f} kN")
    steepest = math.floor(10.0 * starting_gradient(nominal)) / 10.0  # on what is told it does start
    words = f"{steepest:.1f} ‰" if steepest >= 0.0 else "none, it cannot start on the level"
    console.print(f"steepest gradient on which it can start at {curve.voltage_v:g} V: {words}")
    console.print(f"balancing speed on the level at {curve.voltage_v:g} V: {_balance(nominal, beyond)}")
    most = max(((float(c.current_a.max()), c) for c in (curve, *drawn.curves)), key=lambda pair: pair[0])
    at = 3.6 * float(drawn.speed_mps[int(most[1].current_a.argmax())])
    console.print(f"greatest current: {most[0]:.0f} A, at {most[1].voltage_v:g} V and {at:.0f} km/h")
