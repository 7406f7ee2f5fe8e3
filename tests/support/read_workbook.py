"""Reads back what a workbook shows: tables as rows by heading, times as seconds."""

import datetime as dt
from typing import Any

import pytest
from openpyxl.utils import range_boundaries


def read_table(sheet: Any, number: int = 1) -> list[dict[str, Any]]:
    """Return the rows of the table of that number of a sheet, by heading; times of day become seconds."""
    reference = next(ref for name, ref in sheet.tables.items() if name.endswith(f"_{number}"))
    left, top, right, bottom = range_boundaries(reference)
    rows = list(sheet.iter_rows(top, bottom, left, right, values_only=True))
    return [dict(zip(rows[0], map(seconds, row), strict=True)) for row in rows[1:]]


def seconds(value: Any) -> Any:
    if isinstance(value, dt.timedelta):
        return value.total_seconds()
    if isinstance(value, dt.time):
        return dt.timedelta(hours=value.hour, minutes=value.minute, seconds=value.second).total_seconds()
    if isinstance(value, dt.datetime):
        return (value - dt.datetime(1899, 12, 30)).total_seconds()
    return value


def exactly(value: float) -> Any:
    """Return what equals a number as a workbook holds it, with 16 digits."""
    return pytest.approx(value, rel=5e-16, abs=0.0)


def texts(sheet: Any) -> list[str]:
    """Return all texts of a sheet."""
    return [cell for row in sheet.iter_rows(values_only=True) for cell in row if isinstance(cell, str)]


def filled_rows(sheet: Any) -> int:
    """Return how many rows have something in them."""
    return sum(any(cell is not None for cell in row) for row in sheet.iter_rows(values_only=True))
