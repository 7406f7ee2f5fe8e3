"""Duty classes and rectifier units: the shipped tables and a user's rows over them."""

from __future__ import annotations

from tractionpower.io.overlaid_tables import OverlaidTable
from tractionpower.model.ratings import DutyRow, RectifierUnit, overlay_duty, overlay_units

DUTY_CLASSES = OverlaidTable(
    DutyRow, "duty_classes", "duty class", ("duty_class", "window_s"), overlay_duty, whole=("duty_class",)
)
RECTIFIER_UNITS = OverlaidTable(RectifierUnit, "rectifier_units", "rectifier unit", ("unit",), overlay_units)
