"""What a column of a table is: its quantity, and how it is stored."""

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


def column(name: str, meaning: str, kind: str = "f4") -> Column:
    """Return a column by its name with the unit as suffix, and its meaning."""
    return Column(Quantity(name, meaning), kind)
