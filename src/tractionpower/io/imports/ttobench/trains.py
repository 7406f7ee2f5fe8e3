"""Trains of TTOBench: one mass with an inverter drive."""

from __future__ import annotations

from typing import Any

from tractionpower.io.imports import foreign as f
from tractionpower.io.imports.imported import Notes
from tractionpower.io.imports.ttobench.files import TrainFile
from tractionpower.model.vehicle import Train, Vehicle

EFFICIENCY = 0.85
SERVICE_RATE = 0.5
T_PER_M = 2.4
"""Mass of a train over its length, where its file has none (assumed; the FLIRT of TTOBench has 2.1)."""


def vehicle_of(file: TrainFile, notes: Notes, place: str) -> Vehicle | None:
    """Return the train as one vehicle."""
    notes.read.append(f"train {file.metadata.id}: masses, running resistance, efforts and powers, efficiencies, top speed")
    length = file.length.to("m") if file.length else max(1.0, round(file.mass.to("t") / T_PER_M))
    data: dict[str, Any] = {
        "id": file.metadata.id,
        "name": file.metadata.id.replace("_", " "),
        "source": f"{file.metadata.version}, {file.metadata.license}, by {file.metadata.created_by}",
        "kind": "multiple_unit",
        "mass_t": file.mass.to("t"),
        "length_m": length,
        "max_speed_kmh": file.speed.to("km/h"),
        "rotating_mass_factor": f.tidy(1.0 + (file.rho.to("-") if file.rho else 0.0)),
        "resistance": _resistance(file, notes),
        "drive": _drive(file, notes),
        "brake": _brake(file, notes),
    }
    if file.length is None:
        notes.assumed.append(
            f"length of {file.metadata.id}: {length:g} m, {T_PER_M:g} t/m; slopes act under its front, as in the source"
        )
    notes.assumed.append(
        f"{file.metadata.id}: no auxiliaries, no load, no limit by adhesion, no current limit: the source has none"
    )
    return f.built(Vehicle, data, notes, place)


def train_of(file: TrainFile) -> Train:
    """Return the train of that one vehicle."""
    point = file.length is None
    data = {"id": file.metadata.id, "vehicles": [{"id": file.metadata.id}]}
    return Train.model_validate({**data, "mass_distribution": "point"} if point else data)


def accelerated_kg(file: TrainFile) -> float:
    """Return the mass with rotating masses [kg]."""
    return file.mass.to("kg") * (1.0 + (file.rho.to("-") if file.rho else 0.0))


def _resistance(file: TrainFile, notes: Notes) -> dict[str, float]:
    told = {
        "a_n": file.r0.to("N"),
        "b_n_per_kmh": file.r1.to("N/(km/h)"),
        "c_n_per_kmh2": file.r2.to("N/(km/h)^2"),
    }
    table = file.tunnel_resistance
    if table is None or not table.values:
        return told
    if not told["c_n_per_kmh2"]:
        notes.ignored.append("tunnel resistance: it would be a factor on the part with the square of the speed, which is zero")
        return told
    rows = sorted((section, f.converted(c, table.units.coefficient, "N/(km/h)^2")) for section, c in table.values)
    narrow, wide = rows[0], rows[-1]
    factors = [f.tidy(1.0 + c / told["c_n_per_kmh2"]) for _, c in (narrow, wide)]
    notes.read.append(
        f"tunnel resistance as a factor on the part with the square of the speed: {factors[0]:.4g} ({narrow[0]:g} m², a tunnel"
        f" of one track here), {factors[1]:.4g} ({wide[0]:g} m², of two tracks)"
    )
    if len(rows) > 2:
        notes.ignored.append(f"tunnel resistance of {len(rows) - 2} cross sections between the narrowest and the widest")
    return {**told, "tunnel_factor_single_track": factors[0], "tunnel_factor_double_track": factors[1]}


def _drive(file: TrainFile, notes: Notes) -> dict[str, Any]:
    effort = file.force.to("kN")
    if file.acceleration is not None:
        capped = f.tidy((file.acceleration.to("m/s^2") * accelerated_kg(file) + file.r0.to("N")) / 1000.0)
        if capped < effort:
            notes.assumed.append(
                f"starting effort {capped:.4g} kN in place of {effort:.4g} kN, which gives the greatest acceleration of"
                f" {file.acceleration.to('m/s^2'):g} m/s² at the start on level track; uphill the source would allow more effort"
            )
            effort = capped
    if file.efficiency is None:
        notes.assumed.append(f"efficiency of traction {EFFICIENCY:g}: the source has none")
    efficiency = file.efficiency.to("-") if file.efficiency else EFFICIENCY
    return {"kind": "inverter", "starting_effort_kn": effort, "power_kw": file.power.to("kW"), "efficiency": efficiency}


def _brake(file: TrainFile, notes: Notes) -> dict[str, float]:
    brake: dict[str, float] = {}
    if file.braking_force and file.braking_power:
        brake |= {"electric_effort_kn": file.braking_force.to("kN"), "electric_power_kw": file.braking_power.to("kW")}
        if file.braking_efficiency:
            brake["efficiency"] = file.braking_efficiency.to("-")
    elif file.braking_force or file.braking_power:
        notes.ignored.append("electric brake: it has a force or a power, but not both")
    forces = sum(force.to("N") for force in (file.braking_force, file.friction_force) if force)
    by_force = forces / accelerated_kg(file) if forces else SERVICE_RATE
    rate = min(file.deceleration.to("m/s^2"), by_force) if file.deceleration else by_force
    reason = "its greatest deceleration" if file.deceleration and rate < by_force else "its braking forces over its mass"
    reason = reason if forces or file.deceleration else "the source has none"
    notes.assumed.append(
        f"deceleration in service {rate:.3g} m/s² on level track: {reason};"
        " friction brakes give what the electric brake does not, whatever their force in the source"
    )
    return {**brake, "service_rate_mps2": f.tidy(rate)}
