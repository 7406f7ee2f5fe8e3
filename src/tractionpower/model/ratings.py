"""What devices can bear, as data: duty classes and rectifier units, every value with its source and how it is known."""

from __future__ import annotations

from collections.abc import Sequence

from pydantic import Field

from tractionpower.model.base import Count, Declaration, Identifier, Real, Text
from tractionpower.model.limits import Status
from tractionpower.model.quantity import field
from tractionpower.model.supply import Supply


class DutyRow(Declaration):
    """One row of the table of duty classes: what a class permits over a window, as a multiple of the rated current.

    A class is met where the highest sliding root mean square of the current over each of its windows stays within the
    multiple. A window longer than the run is held against the whole run.
    """

    duty_class: Identifier = Field(description="Name of the class.")
    window_s: Real = field("window_s", "Length of the sliding window; 0: the whole run.", at_least=0)
    multiple: Real = Field(gt=0, le=100, description="Permitted root mean square over the window, in rated currents.")
    meaning: Text = Field(default="", description="The row in words.")
    source: Text = Field(default="", description="Where it comes from.")
    status: Status = Field(default="user", description="How the value is known.")


class RectifierUnit(Declaration):
    """A type of rectifier unit: transformer and rectifier."""

    unit: Identifier = Field(description="Name by which substations call it.")
    rated_current_a: Real = field("rated_current_a", "Rated direct current.", above=0)
    rated_voltage_v: Real = field("rated_voltage_v", "Rated direct voltage.", above=0)
    duty_class: Identifier = Field(description="Duty class, by the table of duty classes.")
    pulses: Count = Field(ge=2, description="Pulses of the rectifier.")
    transformer_mva: Real | None = Field(default=None, gt=0, description="Rated power of the transformer [MVA].")
    short_circuit_percent: Real | None = field(
        "short_circuit_percent", "Short-circuit voltage of the transformer.", above=0, at_most=100, default=None
    )
    load_loss_kw: Real | None = field("load_loss_kw", "Load losses of the transformer.", at_least=0, default=None)
    diodes_in_series: Count = Field(default=0, ge=0, description="Diodes in series.")
    diode_drop_v: Real = field("diode_drop_v", "Voltage drop of one diode.", at_least=0, default=0.0)
    source: Text = Field(default="", description="Where it comes from.")
    status: Status = Field(default="user", description="How the values are known.")


def overlay_duty(base: Sequence[DutyRow], rows: Sequence[DutyRow]) -> tuple[DutyRow, ...]:
    """Return `base` with the classes that `rows` name replaced as a whole or added: half of an old class would be none."""
    own = {row.duty_class for row in rows}
    kept = [row for row in base if row.duty_class not in own]
    return tuple(sorted([*kept, *rows], key=lambda row: (row.duty_class, row.window_s)))


def overlay_units(base: Sequence[RectifierUnit], rows: Sequence[RectifierUnit]) -> tuple[RectifierUnit, ...]:
    """Return `base` with each row replaced or added by `rows`, matched by the name of the unit."""
    merged = {row.unit: row for row in [*base, *rows]}
    return tuple(merged[name] for name in sorted(merged))


def duty_of(table: Sequence[DutyRow], duty_class: str) -> tuple[DutyRow, ...]:
    """Return the rows of a class, by rising windows; none if the table does not have it."""
    return tuple(sorted((row for row in table if row.duty_class == duty_class), key=lambda row: row.window_s))


def find_unit(table: Sequence[RectifierUnit], unit: str) -> RectifierUnit | None:
    """Return the row of a unit, or None."""
    return next((row for row in table if row.unit == unit), None)


def used_units(supply: Supply, table: Sequence[RectifierUnit]) -> tuple[RectifierUnit, ...]:
    """Return the rows of `table` that a supply system names."""
    named = {station.unit for station in supply.substations}
    return overlay_units([row for row in table if row.unit in named], ())


def used_duty(supply: Supply, table: Sequence[DutyRow], units: Sequence[RectifierUnit]) -> tuple[DutyRow, ...]:
    """Return the rows of `table` whose class a supply system, or one of the `units` that it uses, names."""
    named = {station.duty_class for station in supply.substations} | {unit.duty_class for unit in units}
    return overlay_duty([row for row in table if row.duty_class in named], ())
