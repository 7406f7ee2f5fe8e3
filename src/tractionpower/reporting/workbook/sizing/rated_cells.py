"""Loads against ratings in cells: permitted, utilisation, what is left and the verdict as formulas on their row."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import pandas as pd

from tractionpower.model.ratings import DutyRow
from tractionpower.reporting.texts import mark, tr
from tractionpower.reporting.workbook.common.verdicts import same_as
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Column
from tractionpower.reporting.workbook.sizing.judging import (
    HOLDS,
    NO,
    UNRATED,
    YES,
    at_most,
    judged,
    known,
    window_in_words,
)
from tractionpower.studies.ratings.use import MOST_PERCENT

USE = mark("utilisation [%]")

LOADS = (
    Column("rated current [A]", "0", key="rated"),
    Column("multiple", "0.00", key="multiple"),
    Column("load: highest RMS in it [A]", "0", key="load"),
    Column("permitted in it [A]", "0", key="permitted"),
    Column(USE, "0.0", key="use"),
    Column("left [A]", "0", key="left"),
    Column(HOLDS, "beside", key="holds"),
    Column("that window begins", "time", key="from"),
)
"""Columns of a load in a window and of what is permitted in it."""

_PERMITTED = 'IF(AND(ISNUMBER({rated}),ISNUMBER({multiple})),{rated}*{multiple},"")'
_MOST = f"{MOST_PERCENT:.0f}"
_USE = (
    'IF(ISNUMBER({permitted}),IF({permitted}>0,MIN(100*{load}/{permitted},'
    f'{_MOST}),IF({{load}}>0,{_MOST},0)),"")'
)  # fmt: skip
"""Utilisation as `use_of` has it; nothing where nothing is said to be permitted."""

_NEAR = 1e-6
"""Share by which numbers of single precision may differ."""

_ROUNDING = 1e-9


@dataclass(frozen=True)
class Judge:
    """What loads are held against.

    Attributes
    ----------
    duties
        Rows of the duty classes that stand in the book.
    permitted
        Permitted utilisation [%].
    """

    duties: tuple[DutyRow, ...]
    permitted: float

    @classmethod
    def of(cls, book: Book) -> Judge:
        """Return that of a book: its devices' duty classes, the permitted utilisation of its study."""
        scenario = book.facts.scenario
        classes = set(book.facts.table("ratings")["duty_class"].astype(str))
        return cls(tuple(row for row in scenario.duty_classes if row.duty_class in classes), scenario.sizing.utilisation_percent)

    @cached_property
    def _numbers(self) -> dict[tuple[str, float], int]:
        return {(row.duty_class, row.window_s): number for number, row in enumerate(self.duties, 1)}

    def duty_cell(self, duty_class: str, window_s: float) -> str:
        """Return the name of the cell with the multiple of a class over a window [s]; empty if it has none."""
        number = self._numbers.get((duty_class, window_s))
        return f"duty_multiple_{number}" if number else ""

    def cells(self, row: Any, limit: str, rated: Any = None) -> dict[str, Any]:
        """Return the values of `LOADS` by their keys, of a row of table ``ratings``.

        Parameters
        ----------
        row
            The row.
        limit
            Address of the permitted utilisation.
        rated
            What stands in the column of the rated current; left out: its value.
        """
        load, permitted, multiple = float(row["load_a"]), permitted_of(row), multiple_of(row)
        found = {"rated": row["rated_current_a"] if rated is None else rated, "load": load}
        found["from"] = row["from_s"] if row["window_s"] > 0.0 else None
        if not known(row["utilisation_percent"]) or not math.isfinite(permitted):
            return found | {"multiple": None, "permitted": None, "use": None, "left": None, "holds": tr(UNRATED)}
        return found | {
            "multiple": self._multiple(row, multiple),
            "permitted": permitted if multiple is None else Formula(_PERMITTED, permitted),
            **self._judged(row, permitted, limit),
        }

    def worst_cells(self, windows: pd.DataFrame, first: int, limit: str) -> dict[str, Any]:
        """Return the same of a device with several windows: of that which is used most, by formulas on sheet Ratings by window.

        Parameters
        ----------
        windows
            The device's rows of table ``ratings``, in the order of that sheet.
        first
            Number of the first of them in the table of that sheet, from 1.
        limit
            Address of the permitted utilisation.
        """
        rows = windows.to_dict("records")
        uses = [use_of(float(row["load_a"]), permitted_of(row)) for row in rows]
        at = uses.index(max(uses))
        row, permitted = rows[at], permitted_of(rows[at])
        multiple, load = multiple_of(row), float(row["load_a"])
        area = window_span("use", first, first + len(rows) - 1)
        kept = self._multiple(row, multiple)
        begin = row["from_s"] if row["window_s"] > 0.0 else None
        return {
            "row": Formula(f"IF(COUNT({area})=0,{first},{first - 1}+MATCH(MAX({area}),{area},0))", first + at),
            "window": Formula(_of_window("window"), window_in_words(row["window_s"])),
            "rated": row["rated_current_a"],
            "multiple": Formula(
                same_as(_of_window("multiple")), "" if multiple is None else multiple,
                kept.text if isinstance(kept, Formula) else "",
            ),
            "load": Formula(_of_window("load"), load),
            "permitted": Formula(same_as(_of_window("permitted")), permitted, "" if multiple is None else _PERMITTED),
            **self._judged(row, permitted, limit),
            "from": Formula(same_as(_of_window("from")), begin),
        }  # fmt: skip

    def _judged(self, row: Any, permitted: float, limit: str) -> dict[str, Any]:
        """Return utilisation, what is left and verdict, by formulas on load and permitted current of the row."""
        load = float(row["load_a"])
        use = use_of(load, permitted)
        word = NO if use > self.permitted * (1.0 + _ROUNDING) else YES
        return {
            "use": Formula(_USE, use),
            "left": Formula('IF(ISNUMBER({permitted}),{permitted}-{load},"")', permitted - load),
            "holds": judged(at_most("use", limit), word, str(row["met"])),
        }

    def _multiple(self, row: Any, multiple: float | None) -> Any:
        """Return the multiple, from the cell of its duty class where that has it."""
        name, window_s = str(row["duty_class"]), float(row["window_s"])
        own = {(duty.duty_class, duty.window_s): duty.multiple for duty in self.duties}.get((name, window_s))
        cell = f"{{{self.duty_cell(name, window_s)}}}"
        return Formula(same_as(cell), multiple) if own is not None and own == multiple else multiple


def several_windows(rows: pd.DataFrame) -> pd.DataFrame:
    """Return the rows of table ``ratings`` of devices that are rated for several windows, as sheet Ratings by window has them."""
    rated = rows[rows["utilisation_percent"].notna()]
    return rated[rated.groupby("device", observed=True)["window_s"].transform("size") > 1]


def window_span(key: str, first: int, last: int) -> str:
    """Return cells of a column of sheet Ratings by window, from a row of its table to another, counted from 1."""
    return f"INDEX({{windows_{key}}},{first}):INDEX({{windows_{key}}},{last})"


def _of_window(key: str) -> str:
    """Return the cell of a column of sheet Ratings by window in the row whose number stands in the column of rows."""
    return f"INDEX({{windows_{key}}},{{row}})"


def use_of(load: float, permitted: float) -> float:
    """Return a utilisation as its cell has it [%]."""
    if permitted == 0.0:
        return MOST_PERCENT if load > 0.0 else 0.0
    return min(100.0 * load / permitted, MOST_PERCENT)


def permitted_of(row: Any) -> float:
    """Return the permitted current of a row of table ``ratings`` as its cell has it: rated current times multiple [A]."""
    multiple = multiple_of(row)
    return float(row["permitted_a"]) if multiple is None else float(row["rated_current_a"]) * multiple


def multiple_of(row: Any) -> float | None:
    """Return the multiple of the rated current that is permitted, None where it is none of a few digits."""
    rated, permitted = float(row["rated_current_a"]), float(row["permitted_a"])
    if not (math.isfinite(rated) and math.isfinite(permitted) and rated > 0.0):
        return None
    multiple = round(permitted / rated, 4)
    return multiple if abs(rated * multiple - permitted) <= _NEAR * permitted else None


def sources_of(ruling: pd.DataFrame) -> tuple[list[tuple[str, str]], dict[tuple[str, str], int]]:
    """Return the sources of ratings in words, each with its status, and the number of each pair of status and source.

    They are too long to stand in every row. Inputs of the user that differ in the device alone are one source.
    """
    told: dict[tuple[str, str], list[str]] = {}
    numbers: dict[tuple[str, str], int] = {}
    pairs = zip(ruling["status"].astype(str), ruling["source"].astype(str), strict=True)
    for status, source in dict.fromkeys(pair for pair in pairs if pair[0]):
        head, blank, tail = source.partition(" of ") if status == "user" else (source, "", "")
        own = told.setdefault((status, f"{head}{blank}"), [])
        own += [tail] if tail else []
        numbers[status, source] = list(told).index((status, f"{head}{blank}")) + 1
    return [(status, f"{head}{', '.join(dict.fromkeys(tails))}") for (status, head), tails in told.items()], numbers


def keyed(columns: Sequence[Column], cells: dict[str, Any]) -> list[Any]:
    """Return cells in the order of their columns."""
    return [cells[column.key] for column in columns]
