"""What the sheets of a run judge: verdicts of the run whose found value is a formula on data of the workbook."""

from __future__ import annotations

import math
from dataclasses import replace

from tractionpower.reporting.workbook.common.accepted import accepted_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula


def judge(book: Book, name: str, text: str, value: float | None) -> None:
    """Let the verdicts of a name find their value by a formula, where it comes to what the run has found."""
    for verdict in book.facts.verdicts:
        found = verdict["value"]
        if verdict["name"] == name and None not in (found, value) and math.isclose(found, value or 0.0, rel_tol=1e-12):
            book.acceptance.append(replace(accepted_of(verdict), found=Formula(text, found)))
