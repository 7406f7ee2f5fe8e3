"""Live formulas: what a cell computes from others, with the value that it comes to, for viewers that do not calculate."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from openpyxl.utils import absolute_coordinate, quote_sheetname
from openpyxl.workbook.defined_name import DefinedName

_PLACE = re.compile(r"\{(\w+)\}")


@dataclass(frozen=True, slots=True)
class Formula:
    """What a cell computes.

    Attributes
    ----------
    text
        The formula without its equals sign, in English names and commas. A place in braces stands for the cell of the same row
        in the column with that key, or for what has that name in the workbook: ``100*{load}/{permitted}``.
    value
        What it comes to, computed by the program: the same number, text or truth, in the unit of the cell.
    instead
        The formula of a workbook that has not all that `text` asks for; none without one.
    """

    text: str
    value: Any
    instead: str = ""

    def written(self, row: Mapping[str, str], names: Names) -> str | None:
        """Return the formula as a cell holds it; None if it asks for what the workbook does not have.

        Parameters
        ----------
        row
            Cells of the same row by the keys of their columns.
        names
            Names of the workbook.
        """
        for text in filter(None, (self.text, self.instead)):
            places = {name: row.get(name) or (name if name in names else None) for name in _PLACE.findall(text)}
            if None not in places.values():
                return "=" + _PLACE.sub(lambda match, places=places: str(places[match.group(1)]), text)  # type: ignore[misc]
        return None


@dataclass
class Names:
    """The named cells and ranges of a workbook."""

    _places: dict[str, str] = field(default_factory=dict)

    def __contains__(self, name: str) -> bool:
        return name in self._places

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def define(self, name: str, sheet: Any, area: str) -> str:
        """Name a cell or a range of a sheet, such as ``C7`` or ``C7:C99``, and return the name.

        Raises
        ------
        ValueError
            If it cannot be a name in Excel, or is taken.
        """
        if not re.fullmatch(r"[A-Za-z_][A-Za-z_]+[A-Za-z_0-9.]*", name) or re.fullmatch(r"[A-Za-z]{1,3}\d+", name):
            raise ValueError(f"{name!r} cannot be a name in Excel")
        if name in self._places:
            raise ValueError(f"the name {name!r} is taken")
        self._places[name] = f"{quote_sheetname(sheet.title)}!{absolute_coordinate(area)}"
        return name

    def forget(self, sheet: Any) -> None:
        """Drop the names of what stands on a sheet, as it goes."""
        begin = f"{quote_sheetname(sheet.title)}!"
        self._places = {name: area for name, area in self._places.items() if not area.startswith(begin)}

    def write(self, workbook: Any) -> None:
        """Give the workbook its names."""
        for name, area in self._places.items():
            workbook.defined_names[name] = DefinedName(name, attr_text=area)
