"""The tables of a run, each column declared once: name with unit, meaning, type on disk."""

from __future__ import annotations

from tractionpower.results.column import Column
from tractionpower.results.column import column as _column
from tractionpower.results.dynamics_columns import DYNAMICS_TABLES
from tractionpower.results.measured_columns import MEASURED_TABLES
from tractionpower.results.sizing_columns import SIZING_TABLES

TIME = _column("time_s", "Start of the step, seconds after midnight of the study's day.", "f8")
VOLTAGE = _column("voltage_v", "Mean voltage of the step between contact line and rail.")

DELAY_PARTS = {
    "knock_on": "Part of it that the train brought along from the timed call before, or from its start.",
    "timetable": "Part of it since the timetable gives less than the shortest running time.",
    "current_limit": "Part of it by train current limits of line and run.",
    "voltage": "Part of it by voltage below the nominal one.",
    "dwell": "Part of it added at a stop.",
    "driving": "Part of it since the train was not driven flat out.",
}
"""Parts of a delay, which add up to it."""

ORIGIN_PARTS = {
    "timetable": "to a timetable shorter than the train can run.",
    "current_limit": "to train current limits.",
    "voltage": "to low voltage.",
    "dwell": "to stops and turn-rounds.",
    "driving": "to driving that is not flat out.",
}
"""Where the seconds of a delay first arose; they add up to it."""

TABLES: dict[str, tuple[Column, ...]] = {
    "trains": (
        TIME,
        _column("train", "Identifier of the train's run.", "text"),
        _column("track", "Track that the front of the train is on at the start of the step.", "text"),
        _column("position_km", "Place of the front at the start of the step, kilometre of the line.", "f8"),
        _column("distance_m", "Distance of the front from the start of its route at the start of the step.", "f8"),
        _column("speed_kmh", "Speed at the start of the step."),
        _column("acceleration_mps2", "Mean acceleration of the step; negative slows down."),
        _column("phase", "What the train does at the start of the step.", "text"),
        _column("tractive_force_kn", "Mean tractive effort at the wheel."),
        _column("electric_brake_force_kn", "Mean effort of the electric brake at the wheel."),
        _column("friction_brake_force_kn", "Mean effort of the friction brake."),
        _column("resistance_kn", "Mean running resistance with gradients, curves and tunnels; negative drives downhill."),
        _column("wished_force_kn", "Tractive effort that the driver asks for before limits of voltage and current."),
        _column("limited_by", "What limits the tractive effort.", "text"),
        VOLTAGE,
        _column("current_a", "Current at the pantograph; negative feeds back."),
        _column("power_kw", "Power at the pantograph; negative feeds back."),
        _column("auxiliary_power_kw", "Power of auxiliaries and heating."),
        _column("starting_resistor_kw", "Heat in starting resistors."),
        _column("braking_resistor_kw", "Heat in braking resistors."),
        _column("refused_regeneration_kw", "Power of the electric brake that the line does not take."),
        _column("drive_loss_kw", "Loss between pantograph and wheel, without starting and braking resistors."),
        _column("wheel_power_kw", "Tractive power at the wheel."),
        _column("returned_kw", "Power fed back into the line."),
        _column("rail_potential_v", "Potential of the rails under the train against remote earth; empty where none is defined."),
    ),
    "calls": (
        _column("train", "Identifier of the train's run.", "text"),
        _column("station", "Identifier of the station.", "text"),
        _column("kind", "arrival, departure or pass.", "text"),
        _column("planned_s", "Planned time, seconds after midnight; empty where the timetable has none.", "f8"),
        _column("actual_s", "Computed time, seconds after midnight; empty where the train did not get there.", "f8"),
        _column("dwell_s", "Time that the train stood there, in rows of departures; empty in others."),
        _column("late_s", "Computed less planned time; negative is early."),
    ),
    "substations": (
        TIME,
        _column("substation", "Identifier of the substation.", "text"),
        _column("voltage_v", "Voltage of the busbars; empty where they are not in the network."),
        _column("current_a", "Current that the rectifiers feed."),
        _column("power_kw", "Power at the busbars, U I."),
        _column("regulation_kw", "Internal drop times current, (E - U) I; mostly commutation drop and no loss."),
        _column("loss_kw", "Heat in copper and diodes; empty where dissipative_resistance_ohm is not given."),
        _column("blocked", "Whether the rectifiers block.", "bool"),
    ),
    "feeders": (
        TIME,
        _column("substation", "Identifier of the substation.", "text"),
        _column("track", "Track that the feeder supplies.", "text"),
        _column("side", "Side that it supplies: low_km or high_km; return: from the rails of this track.", "text"),
        _column("current_a", "Current from the busbar into the contact line, or from the rails into the negative busbar."),
    ),
    "cabins": (
        TIME,
        _column("section_cabin", "Identifier of the section cabin.", "text"),
        _column("track", "Track that the feeder supplies.", "text"),
        _column("side", "Side that it supplies: low_km or high_km.", "text"),
        _column("current_a", "Current from the busbar into the contact line."),
    ),
    "switches": (
        TIME,
        _column("switch", "Identifier of the switch.", "text"),
        _column("closed", "Whether it is closed.", "bool"),
        _column("current_a", "Current from its first side to its second."),
    ),
    "loads": (
        TIME,
        _column("load", "Identifier of the load.", "text"),
        VOLTAGE,
        _column("current_a", "Current taken from the line; negative feeds back."),
        _column("power_kw", "Power taken from the line; negative feeds back."),
    ),
    "profile": (
        _column("km", "Place along the line.", "f8"),
        _column("track", "Track.", "text"),
        _column("lowest_voltage_v", "Lowest voltage between contact line and rail."),
        _column("mean_voltage_v", "Mean voltage over the steps in which there is one."),
        _column("highest_voltage_v", "Highest voltage."),
        _column(
            "count",
            "Number of steps with a voltage, or of steps of trains; where the contact line is cut, of the side that has more.",
            "i4",
        ),
        _column(
            "where",
            "cross_section: a fixed place, in every step with a voltage, both sides of a cut together;"
            " pantograph: trains within 0.25 km of it.",
            "text",
        ),
    ),
    "rails": (
        TIME,
        _column("track", "Tracks of the return conductor, several by blanks.", "text"),
        _column("km", "Place along the line.", "f8"),
        _column("potential_v", "Mean potential of the rails against remote earth in the one step that begins then."),
        _column("leakage_a_per_km", "Current from the rails into earth by leakage, per kilometre; negative enters the rails."),
    ),
    "rail_profile": (
        _column("track", "Tracks of the return conductor, several by blanks.", "text"),
        _column("km", "Place along the line.", "f8"),
        _column("lowest_potential_v", "Lowest potential of the rails against remote earth."),
        _column("mean_potential_v", "Mean potential over the run."),
        _column("highest_potential_v", "Highest potential."),
        _column("mean_leakage_a_per_km", "Mean current from the rails into earth by leakage; negative enters the rails."),
        _column("mean_leaving_a_per_km", "The same, steps in which it enters the rails counted as zero."),
        _column(
            "longest_above_limit_s", "Longest unbroken time with a potential, of either sign, above the permanent touch voltage."
        ),
        _column("leakage_s_per_km", "Leakage conductance of the return conductor."),
        _column("length_km", "Length that the place stands for: sums over places give totals."),
    ),
    "earthing": (
        TIME,
        _column("device", "Identifier of the earthing or voltage-limiting device.", "text"),
        _column("potential_v", "Mean potential there, of rails or busbar, against remote earth; empty where not recorded."),
        _column("current_a", "Current into earth; negative comes out of it."),
    ),
    "delays": (
        _column("train", "Identifier of the train's run.", "text"),
        _column("station", "Identifier of the station.", "text"),
        _column("kind", "arrival, departure or pass.", "text"),
        _column("planned_s", "Planned time, seconds after midnight.", "f8"),
        _column("actual_s", "Computed time, seconds after midnight; empty where the train did not get there.", "f8"),
        _column("delay_s", "How late it is: computed less planned time, 0 if it is early; empty where it did not get there."),
        *(_column(f"{part}_s", meaning) for part, meaning in DELAY_PARTS.items()),
        _column("cause", "Largest of these parts; empty within the tolerance; not_reached where it should have come.", "text"),
        *(
            _column(f"origin_{part}_s", f"Of the delay, knock-on followed back to where it first arose: {ORIGIN_PARTS[part]}")
            for part in ORIGIN_PARTS
        ),
    ),
    "sections": (
        _column("train", "Identifier of the train's run.", "text"),
        _column("from_station", "Station at which the section begins; empty: the start of the run.", "text"),
        _column("to_station", "Station at which it ends.", "text"),
        _column("from_km", "Where it begins.", "f8"),
        _column("to_km", "Where it ends.", "f8"),
        _column("planned_s", "Planned running time between two timed calls, the shortest dwells in between taken off."),
        _column("shortest_s", "Running time alone at nominal voltage, flat out, without train current limits."),
        _column("limited_s", "The same with the train current limits of line and run."),
        _column("recorded_s", "The same with these limits on the voltages that the run with the network recorded."),
        _column("actual_s", "Running time with the network; empty where the train did not get there."),
        _column("reserve_s", "planned_s less shortest_s."),
        _column("reserve_left_s", "planned_s less recorded_s: what limits and voltage leave of the reserve."),
        _column("lost_voltage_s", "recorded_s less limited_s: seconds lost to low voltage; negative are gained."),
        _column("lost_current_s", "limited_s less shortest_s: seconds lost to train current limits."),
        _column("worst_track", "Track of the kilometre in which most seconds are lost to low voltage.", "text"),
        _column("worst_km", "Middle of that kilometre; empty where none is lost.", "f8"),
        _column("area", "Substation that is the nearest to it of those that feed there.", "text"),
        _column("lowest_voltage_v", "Lowest voltage at the pantograph, mean of a step."),
    ),
    "lost_time": (
        _column("train", "Identifier of the train's run.", "text"),
        _column("track", "Track.", "text"),
        _column("km", "Middle of a kilometre.", "f8"),
        _column("area", "Substation that is the nearest to it of those that feed there.", "text"),
        _column("lost_s", "Seconds lost to low voltage in it; negative are gained."),
    ),
    "events": (
        TIME,
        _column("kind", "Kind of event.", "text"),
        _column("subject", "Device or train that it concerns.", "text"),
        _column("track", "Track.", "text"),
        _column("position_km", "Place.", "f8"),
        _column("value", "What was found.", "f8"),
        _column("limit", "What is allowed.", "f8"),
        _column("message", "The event in words.", "text"),
    ),
    **SIZING_TABLES,
    **MEASURED_TABLES,
    **DYNAMICS_TABLES,
}
