"""A train as sums over its vehicles, in SI: masses, running resistance, brakes, auxiliaries, and its one kind of drive."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from tractionpower.kernels.wayside import GRAVITY
from tractionpower.model.drive import InverterDrive
from tractionpower.model.vehicle import Part, Train, Vehicle

KMH = 3.6
"""km/h per m/s."""

SINGLE_TRACK_TUNNEL, DOUBLE_TRACK_TUNNEL = 2e-3, 1e-3
"""Resistance that tunnels add where a vehicle gives no factor [N/N] (TrainDyn, eq. 16)."""


@dataclass(frozen=True, slots=True)
class Formation:
    """What a train is as one mass.

    Attributes
    ----------
    mass_kg, inertia_kg
        Mass with load, and inertia with rotating masses: their factor acts on the mass without load.
    length_m, max_mps, service_rate_mps2
        Length, greatest speed, deceleration in service.
    spread_m
        Length over which gradients act; 0: under the front.
    a_n, b_ns_per_m, c_ns2_per_m2
        Running resistance a + b v + c v2.
    tunnel
        What a metre of tunnel of one track and of two adds, as (constant part [N/N], drag [N s2/m2]).
    auxiliary_w, heating_w
        Power of the auxiliaries, and of resistive heating at nominal voltage.
    driver, units
        The powered vehicle, None without one, and how many there are.
    """

    mass_kg: float
    inertia_kg: float
    length_m: float
    max_mps: float
    service_rate_mps2: float
    spread_m: float
    a_n: float
    b_ns_per_m: float
    c_ns2_per_m2: float
    tunnel: tuple[tuple[float, float], tuple[float, float]]
    auxiliary_w: float
    heating_w: float
    driver: Vehicle | None
    units: int


def form(train: Train, vehicles: Mapping[str, Vehicle]) -> Formation:
    """Return the sums over the vehicles of a train, all of which are in `vehicles`; its powered ones are of one kind."""
    parts = [(part, vehicles[part.id]) for part in train.vehicles]
    powered = [(part, vehicle) for part, vehicle in parts if is_powered(part, vehicle)]
    masses = [_mass_kg(part, vehicle) for part, vehicle in parts]
    mass = sum(masses)
    resistances = [_resistance(part, vehicle, kg) for (part, vehicle), kg in zip(parts, masses, strict=True)]
    a, b, c = (sum(column) for column in zip(*resistances, strict=True))
    length = sum(part.count * vehicle.length_m for part, vehicle in parts)
    limits = [vehicle.max_speed_kmh for _, vehicle in parts]
    rates = [vehicle.brake.service_rate_mps2 for _, vehicle in parts]
    rotating = sum(part.count * (vehicle.rotating_mass_factor - 1.0) * vehicle.mass_t * 1e3 for part, vehicle in parts)
    fed = [(part, vehicle) for part, vehicle in parts if vehicle.drive is None or part.powered]
    return Formation(
        mass_kg=mass,
        inertia_kg=mass + rotating,
        length_m=length,
        max_mps=min([*limits, *([train.max_speed_kmh] if train.max_speed_kmh is not None else [])]) / KMH,
        service_rate_mps2=train.service_rate_mps2 if train.service_rate_mps2 is not None else min(rates),
        spread_m=length if train.mass_distribution == "uniform" else 0.0,
        a_n=a,
        b_ns_per_m=b,
        c_ns2_per_m2=c,
        tunnel=(
            _tunnel(parts, masses, resistances, "tunnel_factor_single_track", SINGLE_TRACK_TUNNEL),
            _tunnel(parts, masses, resistances, "tunnel_factor_double_track", DOUBLE_TRACK_TUNNEL),
        ),
        auxiliary_w=sum(part.count * _constant_kw(vehicle) * 1e3 for part, vehicle in fed),
        heating_w=sum(part.count * _heating_kw(vehicle) * 1e3 for part, vehicle in fed),
        driver=powered[0][1] if powered else None,
        units=sum(part.count for part, _ in powered),
    )


def is_powered(part: Part, vehicle: Vehicle) -> bool:
    """Tell whether the vehicles of a part drive the train."""
    return vehicle.drive is not None and part.powered


def _mass_kg(part: Part, vehicle: Vehicle) -> float:
    return part.count * (vehicle.mass_t + part.load_percent / 100.0 * vehicle.load_t) * 1e3


def _resistance(part: Part, vehicle: Vehicle, mass_kg: float) -> tuple[float, float, float]:
    """Return a [N], b [N s/m], c [N s2/m2] of the vehicles of a part."""
    given, weight_kn = vehicle.resistance, mass_kg * GRAVITY / 1e3
    return (
        part.count * given.a_n + weight_kn * given.specific_a_n_per_kn,
        (part.count * given.b_n_per_kmh + weight_kn * given.specific_b_n_per_kn_per_kmh) * KMH,
        (part.count * given.c_n_per_kmh2 + weight_kn * given.specific_c_n_per_kn_per_kmh2) * KMH**2,
    )


def _tunnel(
    parts: list[tuple[Part, Vehicle]],
    masses: list[float],
    resistances: list[tuple[float, float, float]],
    name: str,
    added: float,
) -> tuple[float, float]:
    """Return what a tunnel adds: by weight for vehicles without a factor, else by the factor on the part with v2."""
    factors = [getattr(vehicle.resistance, name) for _, vehicle in parts]
    plain = sum(mass for mass, factor in zip(masses, factors, strict=True) if factor is None)
    drag = sum(c * (factor - 1.0) for (_, _, c), factor in zip(resistances, factors, strict=True) if factor is not None)
    return added * plain / sum(masses), drag


def _constant_kw(vehicle: Vehicle) -> float:
    given = vehicle.auxiliaries
    return given.power_kw + (given.heating_kw if given.heating == "constant_power" else 0.0)


def _heating_kw(vehicle: Vehicle) -> float:
    return vehicle.auxiliaries.heating_kw if vehicle.auxiliaries.heating == "resistive" else 0.0


def brake_efficiency(vehicle: Vehicle) -> float:
    """Return the efficiency of the electric brake of a vehicle."""
    if vehicle.brake.efficiency is not None:
        return vehicle.brake.efficiency
    drive = vehicle.drive
    if isinstance(drive, InverterDrive):
        return drive.efficiency if drive.efficiency is not None else max(p.efficiency for p in drive.efficiency_map)
    return 1.0
