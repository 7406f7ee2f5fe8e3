"""The tables of train dynamics: vehicles, couplings, controls, statistics."""

from __future__ import annotations

from tractionpower.results.column import Column
from tractionpower.results.column import column as _column

_TIME = _column("time_s", "Time since the start of the case.", "f8")

DYNAMICS_TABLES: dict[str, tuple[Column, ...]] = {
    "vehicles": (
        _TIME,
        _column("vehicle", "Vehicle: its number from the front and its identifier.", "text"),
        _column("position_m", "Place of its middle, distance from where the front of the train started.", "f8"),
        _column("speed_kmh", "Speed."),
        _column("acceleration_mps2", "Acceleration."),
        _column("relative_position_m", "Change of its place against the first vehicle since the start.", "f8"),
        _column("tractive_force_kn", "Tractive effort at the wheel."),
        _column("electric_brake_force_kn", "Effort of the electric brake."),
        _column("brake_force_kn", "Effort of the air brake as it acts at the rail."),
        _column("resistance_kn", "Running resistance with curves and tunnels, as it acts."),
        _column("grade_force_kn", "Force of the gradient against the direction of travel."),
        _column("cylinder_pressure_bar", "Pressure of its brake cylinder, gauge."),
    ),
    "couplings": (
        _TIME,
        _column("coupling", "Coupling: numbers of the vehicles that it joins.", "text"),
        _column("force_kn", "Force; tension (draft) is positive, compression (buff) negative."),
        _column("deflection_mm", "How much longer the coupling is than in the middle of its slack."),
        _column("rate_mps", "Speed at which it lengthens."),
    ),
    "controls": (
        _TIME,
        _column("drive", "Level of the drive control.", "i4"),
        _column("brake", "Level of the brake control; one more than the highest is emergency.", "i4"),
        _column("electric_percent", "Part of the greatest electric brake."),
        _column("independent_bar", "Pressure commanded by the independent brake."),
        _column("reduction_bar", "Reduction of the brake pipe at the driver's valve."),
        _column("traction_kwh", "Work of the tractive effort since the start.", "f8"),
        _column("electric_kwh", "Work that the electric brakes have taken since the start.", "f8"),
        _column("brake_kwh", "Work that the air brakes have taken since the start.", "f8"),
        _column("resistance_kwh", "Work that running, curve and tunnel resistance has taken.", "f8"),
        _column("gravity_kwh", "Work against gravity since the start; negative downhill.", "f8"),
        _column("coupling_kwh", "Work that the couplings have taken in; what their springs hold is part of it.", "f8"),
        _column("kinetic_kwh", "Kinetic energy of all vehicles with their rotating parts.", "f8"),
    ),
    "coupling_extremes": (
        _column("coupling", "Coupling: numbers of the vehicles that it joins.", "text"),
        _column("greatest_tension_kn", "Greatest tension of all steps; 0: never in tension."),
        _column("tension_at_s", "When; empty where never.", "f8"),
        _column("greatest_compression_kn", "Greatest compression of all steps, as a positive number; 0: never in compression."),
        _column("compression_at_s", "When; empty where never.", "f8"),
        _column("absorbed_kj", "Work that it has taken in; what its springs hold at the end is part of it."),
        _column("damper_kj", "Part of it that its viscous damper has."),
        _column(
            "damage",
            "Rainflow ranges to the power of 3 times cycles, over the greatest such sum of all couplings (an index of ours);"
            " empty where no cycles were counted.",
        ),
    ),
    "distributions": (
        _column("of", "drive_speed, brake_speed, coupler_force or acceleration.", "text"),
        _column("level", "Level of the control; empty where there is none."),
        _column("lowest", "Lower end of the bin: km/h, kN or m/s2; empty: no end."),
        _column("highest", "Upper end of the bin; empty: no end."),
        _column("frequency", "Part of the time.", "f8"),
    ),
    "rainflow": (
        _column("coupling", "Coupling: numbers of the vehicles that it joins.", "text"),
        _column("range_kn", "Range of the cycles, in classes of 5 kN: the upper end of the class.", "f8"),
        _column("mean_kn", "Mean of the cycles, in classes of 25 kN: the middle of the class.", "f8"),
        _column("cycles", "How many; half cycles count 0.5.", "f8"),
    ),
    "point_masses": (
        _TIME,
        _column("train", "Train, as a point mass.", "text"),
        _column("kind", "Its kind.", "text"),
        _column("station_track", "Piece of track that its front is on: of the line, or station and track.", "text"),
        _column("position_m", "Place of its front, distance from where trains come.", "f8"),
        _column("speed_kmh", "Speed."),
        _column("acceleration_mps2", "Acceleration."),
        _column("state", "standing, accelerating (full effort), cruising, decelerating, braking_to_stop.", "text"),
        _column("resistance_kn", "Resistance of vehicles and track; 0 at a stand."),
        _column("tractive_force_kn", "Tractive effort at the wheel."),
        _column("braking_force_kn", "Braking force."),
    ),
    "station_events": (
        _TIME,
        _column("train", "Train.", "text"),
        _column("kind", "entered, track_given, arrival, departure, passing, left, still_there.", "text"),
        _column("station", "Station; empty on entering and leaving.", "text"),
        _column("station_track", "Track there.", "text"),
        _column("position_m", "Place of its front.", "f8"),
        _column("waited_s", "How long it had to wait for a free track, or line ahead."),
    ),
}
