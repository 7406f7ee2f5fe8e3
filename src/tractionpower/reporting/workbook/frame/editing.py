"""Cells that are made to be edited: spreadsheet programs refuse in them what is no number."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from openpyxl.worksheet.datavalidation import DataValidation

from tractionpower.reporting.texts import tr

EDITABLE = "editable "
"""How the styles of such cells begin."""

MOST = 1e9
"""Greatest number that can be typed into one, of either sign."""


def only_numbers(sheet: Any, cells: Iterable[str], least: float) -> None:
    """Let numbers alone be typed into cells, none below the least; they can be emptied, which says: not judged."""
    rule = DataValidation("decimal", f"{least:.0f}", f"{MOST:.0f}", allow_blank=True, operator="between", showErrorMessage=True)
    rule.errorTitle = tr("Not a number")
    words = tr("Only a number is allowed here: verdicts are calculated with it.")
    if least > -MOST:
        words = tr("Only a number of {least} or more is allowed here: verdicts are calculated with it.", least=f"{least:.0f}")
    rule.error = f"{words} {tr('An empty cell is not judged.')}"
    for cell in cells:
        rule.add(cell)
    sheet.add_data_validation(rule)
