"""Figures of cases in words, and which of them stand on the main sheet of a sweep."""

from __future__ import annotations

from tractionpower.reporting.facts.sweep_data import SweepData
from tractionpower.reporting.texts import mark
from tractionpower.reporting.workbook.frame.page import heading_of
from tractionpower.studies.sweep.differences import FIGURES, HIGHER_IS_BETTER

HEADINGS = {
    "lowest_voltage_v": mark("lowest voltage [V]"),
    "highest_voltage_v": mark("highest voltage [V]"),
    "useful_zone_v": mark("mean useful voltage, zone [V]"),
    "useful_train_v": mark("mean useful voltage, train [V]"),
    "useful_zone_time_mean_v": mark("time-mean voltage, zone [V]"),
    "useful_train_time_mean_v": mark("time-mean voltage, train [V]"),
    "above_u_max1_s": mark("longest above U_max1 [s]"),
    "rail_potential_v": mark("greatest rail potential [V]"),
    "late_trains": mark("late trains"),
    "worst_late_s": mark("greatest lateness [s]"),
    "stuck_trains": mark("stuck trains"),
    "dark_trains": mark("trains without voltage"),
    "unfinished_trains": mark("unfinished trains"),
    "unserved_loads": mark("loads without voltage"),
    "unserved_load_s": mark("loads without voltage [s]"),
    "blackout_s": mark("nothing fed [s]"),
    "energy_kwh": mark("energy of substations [kWh]"),
    "line_loss_kwh": mark("loss in the line [kWh]"),
    "highest_demand_kw": mark("highest demand [kW]"),
    "contract_share_percent": mark("demand by contract [%]"),
    "utilisation_percent": mark("highest utilisation [%]"),
    "overloaded": mark("overloaded devices"),
    "breaker_share_percent": mark("peak by breaker setting [%]"),
    "trips": mark("trips of breakers"),
    "flagged_steps": mark("flagged steps"),
}
"""Headings of the figures, as short as a column wants them."""

MAIN = (
    "lowest_voltage_v", "useful_zone_v", "useful_train_v", "highest_voltage_v", "utilisation_percent", "worst_late_s",
    "late_trains", "highest_demand_kw", "energy_kwh", "line_loss_kwh", "rail_potential_v", "overloaded", "trips",
)  # fmt: skip
"""Figures of the main sheet, the most telling first."""

ALWAYS = 4
"""So many of the first stand on the main sheet though they are the same in all cases."""

COUNTS = (
    "late_trains", "stuck_trains", "dark_trains", "unfinished_trains", "unserved_loads", "overloaded", "trips", "flagged_steps",
)  # fmt: skip
"""Figures that are whole numbers."""


STATUSES = {
    "complete": mark("complete"), "flagged": mark("flagged"), "refused": mark("refused"), "failed": mark("failed"),
}  # fmt: skip
"""How a case ended."""


def heading(name: str) -> str:
    """Return the heading of a figure, in English."""
    return HEADINGS.get(name) or heading_of(name)


def style_of(name: str) -> str:
    """Return the style of the cells of a figure."""
    return "0" if name in COUNTS else "0.0"


def shown_figures(data: SweepData) -> list[str]:
    """Return the figures that at least one case has."""
    return [name for name in FIGURES if name in data.measured and data.measured[name].notna().any()]


def main_figures(data: SweepData) -> list[str]:
    """Return the figures of the main sheet: of those that the cases have the first few, and others that differ."""
    differ = set(differing_figures(data))
    return [name for name in MAIN if name in shown_figures(data) and (name in MAIN[:ALWAYS] or name in differ)]


def differing_figures(data: SweepData) -> list[str]:
    """Return the figures that differ between cases, those of the main sheet first."""
    found = data.run["sweep"]["extremes"]
    return [name for name in dict.fromkeys((*MAIN, *FIGURES)) if name in found]


def ranking_figure(data: SweepData) -> str | None:
    """Return the figure by which cases are ranked that violate equally many limits: the most telling one that is judged."""
    found = data.run["sweep"]["extremes"]
    return next((name for name in differing_figures(data) if "best" in found[name]), None)


def higher_is_better(name: str) -> bool:
    """Return whether a case with more of a figure is the better one."""
    return name in HIGHER_IS_BETTER
