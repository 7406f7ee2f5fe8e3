"""The tables of a run, each column declared once: name with unit, meaning, type on disk."""

from __future__ import annotations

from dataclasses import dataclass

from tractionpower.model.quantity import Quantity


@dataclass(frozen=True, slots=True)
class Column:
    """A column: its quantity and how it is stored (``f8``, ``f4``, ``text``, ``bool``, ``i4``)."""

    quantity: Quantity
    kind: str = "f4"

    @property
    def name(self) -> str:
        """Name of the column."""
        return self.quantity.name


def _column(name: str, meaning: str, kind: str = "f4") -> Column:
    return Column(Quantity(name, meaning), kind)


TIME = _column("time_s", "Start of the step, seconds after midnight of the study's day.", "f8")
VOLTAGE = _column("voltage_v", "Mean voltage of the step between contact line and rail.")

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
}
