"""What ``dynamics run`` prints at its end: forces, stops, speed, energies, verdicts, what a reader has to know."""

# ruff: noqa: PLC0415 - heavy modules are imported inside the functions that need them

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from tractionpower.cli.run_summary import sentence
from tractionpower.model.quantity import Quantity

SHOWN = {
    "greatest_tension_kn": "greatest tension",
    "greatest_compression_kn": "greatest compression",
    "greatest_speed_kmh": "greatest speed",
    "distance_m": "distance",
    "greatest_acceleration_mps2": "greatest acceleration",
    "greatest_relative_movement_m": "greatest movement against the first vehicle",
    "stopping_distance_m": "stopping distance",
    "stopping_time_s": "stopping time",
    "braked_from_kmh": "braked from",
    "mean_deceleration_mps2": "mean deceleration",
    "traction_energy_kwh": "work of traction",
    "air_brake_energy_kwh": "taken by air brakes",
    "electric_brake_energy_kwh": "taken by electric brakes",
    "coupling_energy_kwh": "taken by couplings",
}
"""Key figures that are printed, and how they are called."""

STOPPING = ("stopping_distance_m", "stopping_time_s", "braked_from_kmh", "mean_deceleration_mps2")

LEAST_KWH = 5e-4
"""An energy below it is not printed."""

MOST_STOPS = 3
"""Stops that are printed: the last ones."""


QUANTITIES = {"kN": "force", "km/h": "speed", "m/s²": "acceleration", "m": "distance", "kWh": "energy"}
"""Quantity of each unit of the key figures, by the names of `reporting.facts.measures`."""

DIGITS = {"": 0, "kN": 1, "km/h": 1, "m/s²": 3, "m": 2, "s": 2, "kWh": 3}
"""Decimals that tell something, by unit of the key figures: of a number of things none."""


def show(run: Mapping[str, Any], figures: Sequence[Mapping[str, Any]], units: str = "metric") -> None:
    """Print what a dynamicist asks first, in metric or imperial `units`."""
    from tractionpower.cli.console import new_console, new_table

    console = new_console()
    table = new_table([""], ["", ""])
    table.add_column("")
    table.add_column("")
    known = _chosen(figures) if run["kind"] == "dynamics" else figures
    for figure in known:
        value, unit = _in_units(figure["value"], figure["unit"], units)
        table.add_row(
            SHOWN.get(figure["name"]) or Quantity(figure["name"], "").words,
            f"{value:z.{DIGITS.get(figure['unit'], 2)}f}",
            unit,
            figure["place"],
            f"at {figure['time']}" if figure["time"] else "",
        )
    table.show_header = False
    console.print(table)
    console.print()
    for verdict in run["verdicts"]:
        value, unit = _in_units(verdict["value"], verdict["unit"], units)
        limit, _ = _in_units(verdict["limit_value"], verdict["unit"], units)
        console.print(sentence({**verdict, "value": value, "unit": unit, "limit_value": limit}))
    for line in (*_lines(run), *run["notes"]):
        console.print(line)


def _chosen(figures: Sequence[Mapping[str, Any]]) -> Iterator[Mapping[str, Any]]:
    """Yield the figures that are printed, in their order; of stops the last ones."""
    stops = [figure["place"] for figure in figures if figure["name"] == STOPPING[0]]
    for figure in figures:
        if figure["name"] in STOPPING and figure["place"] not in stops[-MOST_STOPS:]:
            continue
        if figure["name"] in SHOWN and (figure["unit"] != "kWh" or abs(figure["value"]) >= LEAST_KWH):
            yield figure


def _in_units(value: float, unit: str, units: str) -> tuple[float, str]:
    """Return a value of the tables and its unit in the units of the case."""
    from tractionpower.reporting.facts.measures import measures

    measure = measures(units).get(QUANTITIES.get(unit, ""))
    return (value, unit) if measure is None else (value * measure.per, measure.unit)


def _lines(run: Mapping[str, Any]) -> Iterator[str]:
    if run["kind"] != "dynamics":
        return
    unbraked = sum(stop["braked_at_s"] is None for stop in run["stops"])
    if unbraked:
        yield f"stops without a brake command: {unbraked}"
    ledger = run["ledgers"]["energy"]
    closes = "closes" if ledger["closes"] else "DOES NOT CLOSE"
    share = "no number" if ledger["gap_share"] is None else f"{100.0 * ledger['gap_share']:.2g} %"
    limit = f"; {100.0 * ledger['limit_share']:g} % is the limit for {run['method']}"
    yield f"energy ledger {closes}: {share} of the energy put in is left over{limit}"
    words = f"{run['steps']} steps of {run['method']}, {run['end_s']:g} s in {run['wall_seconds']:.1f} s"
    more = f", {run['cut_steps']} cut where a vehicle came to a stand" if run["cut_steps"] else ""
    yield words + more
