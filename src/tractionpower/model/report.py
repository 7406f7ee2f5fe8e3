"""How reports look and what stands on them: company, language, choice of sheets, who made and checked them."""

from __future__ import annotations

import re
from datetime import date
from typing import Annotated, Literal

from pydantic import AfterValidator, Field
from pydantic_core import PydanticCustomError

from tractionpower.model.base import Declaration, Format, Text

Language = Literal["en", "pl"]
FigureFormat = Literal["png", "svg", "pdf"]

SHEETS = (
    "Cover", "Acceptance", "Assumptions", "Defaults",
    "Feasibility", "What would save it", "Delays", "Delays by cause", "Sections", "Lost time",
    "Ratings", "Units", "Substation ratings", "Feeder ratings", "Contact line", "Return circuit ratings", "Other ratings",
    "Ratings by window", "Loads by window", "Peaks", "Breakers", "Demand", "Sharing", "Current duration", "Voltage durations",
    "Useful voltage", "Useful voltage by hour",
    "Outages", "Outage voltages", "Outage loads", "Outage trains", "Outage heat map", "What fails", "Device envelope", "Envelope",
    "Delays in outages",
    "Variants", "Best and worst", "Differences", "Verdicts", "All figures", "Inputs that differ",
    "Run", "Zones", "Cases", "Other devices",
    "Trains", "Timetable", "Calls", "Voltages", "Substations", "Feeders", "Return circuit", "Rail potential",
    "Energy", "Train energy", "Losses", "Key figures", "Charts",
    "Extract trains", "Extract worst train", "Voltage profile", "Voltage histogram", "Extract loads", "Extract substation",
    "Load duration", "Events",
    "Coupling forces", "Stops", "Course of the train", "Course of couplings", "Distributions", "Rainflow",
    "Inputs case", "Inputs couplings", "Inputs track", "Inputs commands",
    "Inputs study", "Inputs line", "Inputs supply", "Inputs equipment", "Inputs conductors", "Inputs stock", "Inputs trains",
    "Inputs vehicles", "Inputs timetable", "Inputs limits",
    "Model", "Not covered", "Solver evidence", "Definitions", "Columns", "Errors", "Values",
)  # fmt: skip
"""Names of the sheets of all workbooks, to tell a misspelt one of a template."""

TRAIN_FIGURES = "trains"
"""Name of the figures of single trains, and of their folder."""

FIGURES = (
    "train_graph", "train_graph_fine", "delay_graph", "delay_graph_fine",
    "voltage_along_line", "voltage_histogram", "substation_power", "substation_currents", "substation_loads", "load_duration",
    "energy_flow", "delays_by_cause", "lost_time", "rail_potential", "rail_potential_time",
    "utilisation", "device_load_duration", "sharing", "demand", "useful_voltage_zones", "curves", TRAIN_FIGURES,
    "envelope_voltage", "envelope_rails", "outage_voltages", "outage_delays", "worst_utilisation", "outages_by_km",
    "sweep_curves", "sweep_maps", "sweep_differences", "sweep_scatter", "sweep_voltage", "compare_voltage", "compare_substations",
    "dynamics_controls", "dynamics_speeds", "coupling_forces", "coupling_extremes", "coupling_loops", "coupling_first",
    "brake_cylinders", "dynamics_efforts", "relative_positions", "stopping", "drive_and_speed", "brake_and_speed",
    "coupling_histogram", "acceleration_histogram", "coupling_cycles", "dynamics_energies",
    "arshad_5_speed", "arshad_6_tractive_effort", "arshad_7_acceleration", "arshad_8_cylinder_pressure", "arshad_9_coupler",
    "arshad_10_relative_position",
    "station_topology", "station_distance_time", "station_speed_distance",
)  # fmt: skip
"""Names of all figures but those of measurements, which are called by their series, to tell a misspelt one of a template.

Figures of a train are called ``trains/ID``; pages and members of a group have their name going on behind ``_``.
"""

ShortText = Annotated[Text, Field(max_length=300)]


def _written_date(text: str) -> str:
    # A date is written as the office writes it, in any language; what has no year is none.
    numbers = re.fullmatch(r"(\d{4})-(\d\d?)-(\d\d?)", text.strip())
    try:
        known = bool(re.search(r"(?<!\d)\d{4}(?!\d)", text)) if numbers is None else bool(date(*map(int, numbers.groups())))
    except ValueError:
        known = False
    if text and not known:
        raise PydanticCustomError("date", "this is no date with its year, such as 2026-11-22 or 22 November 2026")
    return text


class Document(Declaration):
    """What an engineering office writes on the cover of a document."""

    title: ShortText = Field(default="", description="Title of the document; left out: the name of the study.")
    project: ShortText = Field(default="", description="Project that it belongs to.")
    client: ShortText = Field(default="", description="Who it is for.")
    number: ShortText = Field(default="", description="Number of the document.")
    revision: ShortText = Field(default="", description="Revision of the document.")
    date: Annotated[ShortText, AfterValidator(_written_date)] = Field(
        default="", description="Date of the document as it is to be written, with its year; left out: the day of writing."
    )
    made_by: ShortText = Field(default="", description="Who made it.")
    checked_by: ShortText = Field(default="", description="Who checked it.")
    approved_by: ShortText = Field(default="", description="Who approved it.")


class ReportFigures(Declaration):
    """Which figures are drawn, and into which kinds of files."""

    formats: Annotated[tuple[FigureFormat, ...], Field(min_length=1)] = Field(
        default=("png",), description="Kinds of files; each figure is written as each of them."
    )
    names: tuple[Text, ...] | None = Field(
        default=None, description="Names of the figures to draw; left out: all.", examples=[list(FIGURES)]
    )


class Report(Declaration):
    """The template of reports.

    It changes nothing that is computed, so it is no part of a scenario and of its hash.
    """

    format: Format = 1
    company: ShortText = Field(default="", description="Who issues the report; on the cover and below each printed page.")
    logo: Text | None = Field(default=None, description="Picture (PNG or JPEG) for the cover, relative to this file.")
    language: Language = Field(default="en", description="Language of the texts: en (English), pl (Polish).")
    paper: Literal["fit", "a4", "a3"] = Field(
        default="fit", description="Paper of the printed sheets, landscape; fit: A4, and A3 for sheets that are too wide for it."
    )
    document: Document = Field(default=Document(), description="What stands on the cover beside the results.")
    assumptions: tuple[Text, ...] = Field(default=(), description="Assumptions of the study, for the sheet of assumptions.")
    sheets: Annotated[tuple[Text, ...], Field(min_length=1)] | None = Field(
        default=None,
        description="Sheets of the workbook in their order, by name; left out: all in the usual order.",
        examples=[list(SHEETS)],
    )
    leave_out: tuple[Text, ...] = Field(default=(), description="Sheets that are left out, by name.")
    figures: ReportFigures = Field(default=ReportFigures(), description="Which figures are drawn, and how.")
