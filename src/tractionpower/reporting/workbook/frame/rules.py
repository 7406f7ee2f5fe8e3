"""Conditional formats that follow the named cells of a workbook, as far as it has them in the end."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from openpyxl.formatting.rule import FormulaRule

from tractionpower.reporting.workbook.frame.cells import fill
from tractionpower.reporting.workbook.frame.formulas import Names

TOLERANCE = "tolerance_"
"""How the names of tolerances begin: one that was emptied is none, while by any other empty cell nothing is coloured."""

_PLACE = re.compile(r"\{(\w+)\}")


@dataclass(frozen=True, slots=True)
class Rule:
    """A condition under which the cells of an area show a colour.

    Attributes
    ----------
    sheet, area
        Where it holds.
    test
        The condition as a formula; ``{cell}`` is each cell of the area, other places in braces are names of the workbook, such as
        ``{cell}<{limit_u_min2}``. It holds for numbers only.
    colour
        Colour of the fill.
    values
        What stands in the place of a name that the workbook does not have, since its sheet is left out.
    """

    sheet: Any
    area: str
    test: str
    colour: str
    values: Mapping[str, float] = field(default_factory=dict)

    def write(self, names: Names) -> None:
        """Give the sheet the conditional format."""
        first = self.area.split(":", maxsplit=1)[0]
        found = {name: name if name in names else f"{value:.10g}" for name, value in self.values.items()} | {"cell": first}
        test = _PLACE.sub(lambda match: found[match.group(1)], self.test)
        limits = "".join(f"ISNUMBER({name})," for name in self.values if name in names and not name.startswith(TOLERANCE))
        rule = FormulaRule(formula=[f"AND(ISNUMBER({first}),{limits}{test})"], stopIfTrue=True, fill=fill(self.colour))
        self.sheet.conditional_formatting.add(self.area, rule)
