"""The tables of a run beside a measurement, each column declared once."""

from __future__ import annotations

from tractionpower.results.column import Column, column

_SERIES = column("series", "What was measured: kind, identifier, quantity.", "text")
_EXTREMES = {
    "lowest_measured": "Lowest measured value",
    "lowest_computed": "Lowest computed value",
    "highest_measured": "Highest measured value",
    "highest_computed": "Highest computed value",
}

MEASURED_TABLES: dict[str, tuple[Column, ...]] = {
    "measured": (
        _SERIES,
        column("time_s", "Start of the step, seconds after midnight, by the run's clock; empty where places are compared.", "f8"),
        column("position_km", "Middle of the piece of the way; empty where times are compared.", "f8"),
        column("measured", "Mean of what was measured over the step, in the unit of the series; empty in a gap.", "f8"),
        column("computed", "Computed value.", "f8"),
        column("error", "Computed less measured value.", "f8"),
    ),
    "measured_errors": (
        _SERIES,
        column("subject", "What was measured.", "text"),
        column("quantity", "Column of the run's table.", "text"),
        column("unit", "Unit of the values of this row.", "text"),
        column("column", "Column of the measured file.", "text"),
        column("rows", "Steps, or pieces of the way, that have both values.", "i4"),
        column("share_percent", "Of those with a computed value."),
        column("shift_s", "Added to the measured times.", "f8"),
        column("smoothing_s", "Window over which both were averaged; 0: none."),
        column("gaps", "Gaps of the measurement.", "i4"),
        column("longest_gap_s", "The longest of them."),
        column("mean_measured", "Mean measured value.", "f8"),
        column("mean_computed", "Mean computed value.", "f8"),
        column("mean_error", "Mean of the errors, computed less measured.", "f8"),
        column("mean_absolute_error", "Mean of their absolute values.", "f8"),
        column("rms_measured", "Root mean square of the measured values.", "f8"),
        column("rms_computed", "Root mean square of the computed values.", "f8"),
        column("rms_error", "Root mean square of the errors.", "f8"),
        column("relative_percent", "rms_error of rms_measured."),
        column("correlation", "Correlation of both; empty for constant values.", "f8"),
        *(
            each
            for name, meaning in _EXTREMES.items()
            for each in (
                column(name, f"{meaning}.", "f8"),
                column(f"{name}_s", f"When, seconds after midnight: {meaning.lower()}.", "f8"),
                column(f"{name}_km", f"Where, with places compared: {meaning.lower()}.", "f8"),
            )
        ),
        column("energy_measured_kwh", "Energy, of series of power, over the steps that have both.", "f8"),
        column("energy_computed_kwh", "The same, computed.", "f8"),
        column("energy_error_percent", "Computed less measured energy, of the measured one."),
    ),
    "measured_shift": (
        column("shift_s", "Shift that was tried.", "f8"),
        column("correlation", "Mean correlation of the series then; empty where too little overlaps.", "f8"),
    ),
}
"""Tables of `compare --measured`."""
