"""The sheets of values: series side by side over the same times or places, and errors as formulas on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.formulas import Formula
from tractionpower.reporting.workbook.frame.page import Block, Column, heading_of

MOST_ROWS = 4000
"""Rows of a sheet of values; of more every n-th stands there."""

AT_ONCE = 5
"""Series side by side on a sheet."""

MOST_SERIES = 40

MEASURED, COMPUTED, ERROR = mark("measured"), mark("computed"), mark("error")

Array = NDArray[Any]


@dataclass(frozen=True)
class Place:
    """Where the values of a series stand, and what they are.

    Attributes
    ----------
    block
        The table.
    column
        Number of the series in it; its columns have keys such as ``measured0``.
    name
        Number by which its ranges are named.
    in_time
        Whether rows are times, else places.
    whole
        Whether all rows of the series are there.
    at, measured, computed
        What stands there; NaN where there is nothing.
    """

    block: Block
    column: int
    name: int
    in_time: bool
    whole: bool
    at: Array
    measured: Array
    computed: Array


def series_words(row: Any) -> str:
    """Return a series of table ``measured_errors`` in words: what it is of, and the quantity without its unit."""
    return f"{recorded(str(row['subject']))}, {heading_of(str(row['quantity'])).split(' [')[0]}"


def add_values(book: Book, rows: pd.DataFrame, errors: pd.DataFrame) -> dict[str, Place]:
    """Add the sheets of values, and return where each series stands."""
    in_time = bool(rows["time_s"].notna().any())
    x = "time_s" if in_time else "position_km"
    rows = rows[rows[x].notna()].astype({"series": str})
    names = [str(name) for name in errors["series"].head(MOST_SERIES) if (rows["series"] == str(name)).any()]
    places: dict[str, Place] = {}
    for first in range(0, len(names), AT_ONCE):
        some = names[first : first + AT_ONCE]
        own = _side_by_side(rows[rows["series"].isin(some)], x)
        every = -(-len(own) // MOST_ROWS) or 1
        kept = pd.DataFrame(own.iloc[::every])
        words = {str(row["series"]): series_words(row) for row in errors.to_dict("records")}
        found = _sheet(book, kept, ({name: words[name] for name in some}, first), in_time=in_time, whole=every == 1)
        places |= dict(zip(some, found, strict=True))
    return places


def _side_by_side(rows: pd.DataFrame, x: str) -> pd.DataFrame:
    """Return values by time or place, a column for each series; a place that is passed again comes again, after the others."""
    again = rows.groupby(["series", x]).cumcount()
    wide = rows.assign(again=again).pivot(index=["again", x], columns="series", values=["measured", "computed"])
    return pd.DataFrame(wide.sort_index().droplevel("again"))


def _sheet(book: Book, kept: pd.DataFrame, told: tuple[dict[str, str], int], *, in_time: bool, whole: bool) -> list[Place]:
    """Add a sheet of some series and name their ranges."""
    names, first = told
    count = first // AT_ONCE + 1
    page = book.page("Values" if count == 1 else f"Values {count}", "Values: measured, computed, error")
    if whole:
        page.note("All values; an empty cell: not measured, or not computed. Errors are formulas: computed less measured.")
    else:
        page.note(tr("Of each series at most some {count} rows; table measured has all.", count=MOST_ROWS))
    columns = [Column("time of day" if in_time else "place [km]", "time" if in_time else "0.000", key="x")]
    for k, name in enumerate(names.values()):
        for key, words in (("measured", MEASURED), ("computed", COMPUTED), ("error", ERROR)):
            columns.append(Column(f"{name}: {tr(words)}", "0.00", key=f"{key}{k}"))
    at = kept.index.to_numpy(float)
    values = [(kept["measured"][name].to_numpy(float), kept["computed"][name].to_numpy(float)) for name in names]
    block = page.table(columns, (_line(at, values, row) for row in range(len(at))), frozen=True)
    places = []
    for k in range(len(names)):
        for key in ("measured", "computed", "error"):
            book.define(f"{key}_{first + k + 1}", page, block.cells(f"{key}{k}"))
        places.append(Place(block, k, first + k + 1, in_time, whole, at, *values[k]))
    return places


def _line(at: Array, values: list[tuple[Array, Array]], row: int) -> list[Any]:
    line: list[Any] = [float(at[row])]
    for k, (measured, computed) in enumerate(values):
        own, other = float(measured[row]), float(computed[row])
        line += [own, other, Formula(f"{{computed{k}}}-{{measured{k}}}", other - own) if np.isfinite(other - own) else None]
    return line


def formulas_of(place: Place) -> dict[str, Formula]:
    """Return the errors of a series as formulas on its values: over the rows that have both."""
    both = np.isfinite(place.measured) & np.isfinite(place.computed)
    if not both.any():
        return {}
    measured, computed = place.measured[both], place.computed[both]
    error = computed - measured
    number = place.name
    e, m, c = (f"{{{key}_{number}}}" for key in ("error", "measured", "computed"))
    rms = [float(np.sqrt(np.mean(values**2))) for values in (measured, computed, error)]
    found = {
        "rows": Formula(f"COUNT({e})", int(both.sum())),
        "mean_measured": Formula(f"SUMPRODUCT(ISNUMBER({e})*{m})/COUNT({e})", float(measured.mean())),
        "mean_computed": Formula(f"SUMPRODUCT(ISNUMBER({e})*{c})/COUNT({e})", float(computed.mean())),
        "mean_error": Formula(f"AVERAGE({e})", float(error.mean())),
        "mean_absolute_error": Formula(f"SUMPRODUCT(ABS({e}))/COUNT({e})", float(np.abs(error).mean())),
        "rms_measured": Formula(f"SQRT(SUMPRODUCT(ISNUMBER({e})*{m}*{m})/COUNT({e}))", rms[0]),
        "rms_computed": Formula(f"SQRT(SUMPRODUCT(ISNUMBER({e})*{c}*{c})/COUNT({e}))", rms[1]),
        "rms_error": Formula(f"SQRT(SUMSQ({e})/COUNT({e}))", rms[2]),
        "largest_error": Formula(f"MAX(MAX({e}),-MIN({e}))", float(np.abs(error).max())),
    }
    if rms[0] > 0.0:
        text = f"100*SQRT(SUMSQ({e})/SUMPRODUCT(ISNUMBER({e})*{m}*{m}))"
        found["relative_percent"] = Formula(text, 100.0 * rms[2] / rms[0])
    if measured.std() > 0.0 and computed.std() > 0.0:
        found["correlation"] = Formula(f"CORREL({m},{c})", float(np.corrcoef(measured, computed)[0, 1]))
    return found
