"""Limits of standards: the shipped table and a user's rows over it."""

from __future__ import annotations

from tractionpower.io.overlaid_tables import OverlaidTable
from tractionpower.model.limits import Limit, overlay

LIMITS = OverlaidTable(Limit, "limits", "limit", ("system", "name"), overlay)


def shipped_limits() -> tuple[Limit, ...]:
    """Return the limits that ship with the program, sorted by system and name."""
    return LIMITS.shipped
