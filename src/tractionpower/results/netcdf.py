"""A table as a NetCDF file (classic format with 64-bit offsets), which xarray, MATLAB, R and others read.

Each column is a variable over the dimension ``row`` with its unit and meaning. Texts are characters in UTF-8 over a
further dimension, true and false the numbers 1 and 0, and a missing number is NaN. A table without rows has no variables.
"""

from __future__ import annotations

import importlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from tractionpower.errors import UsageError

NEEDED = "pip install tractionpower[netcdf]"


def check_netcdf() -> None:
    """Raise an error that says what to install if NetCDF files cannot be written.

    Raises
    ------
    UsageError
        If SciPy is not installed.
    """
    _scipy_io()


def write_netcdf(path: Path, table: pa.Table, about: Mapping[str, str]) -> None:
    """Write a table; `about` says what it is, as attributes of the file.

    Raises
    ------
    UsageError
        If SciPy is not installed.
    """
    with _scipy_io().netcdf_file(path, "w", version=2) as file:
        for name, text in about.items():
            setattr(file, name, text.encode())  # SciPy would write a str in Latin-1
        if not table.num_rows:  # SciPy writes variables over an empty dimension such that the NetCDF library cannot read them
            file.comment = b"the table has no rows"
            return
        file.createDimension("row", table.num_rows)
        for field, column in zip(table.schema, table.columns, strict=True):
            values, attributes = _values(column.combine_chunks())
            dimensions = ["row"]
            if values.ndim == 2:
                dimensions.append(f"{field.name}_length")
                file.createDimension(dimensions[1], values.shape[1])
            variable = file.createVariable(field.name, values.dtype, dimensions)
            variable[:] = values
            told = field.metadata or {}
            attributes |= {"units": told.get(b"unit", b""), "long_name": told.get(b"meaning", b"")}
            for key in sorted(key for key, value in attributes.items() if value):
                setattr(variable, key, attributes[key])


def _values(column: pa.Array) -> tuple[NDArray[Any], dict[str, bytes]]:
    """Return a column as an array of numbers or characters, and what a reader should know to make of it what it was."""
    if pa.types.is_dictionary(column.type):
        names = np.array([*(name.encode() for name in column.dictionary.to_pylist()), b""])
        codes = column.indices.fill_null(len(names) - 1).to_numpy(zero_copy_only=False)
        texts = names[codes]
        width = max(texts.dtype.itemsize, 1)
        return texts.astype(f"S{width}").view("S1").reshape(len(texts), width), {"_Encoding": b"utf-8"}
    if pa.types.is_boolean(column.type):
        return column.to_numpy(zero_copy_only=False).astype(np.int8), {"dtype": b"bool"}  # as xarray writes it
    return column.to_numpy(zero_copy_only=False), {}


def _scipy_io() -> Any:
    try:
        return importlib.import_module("scipy.io")
    except ImportError:
        raise UsageError(f"NetCDF files need SciPy: {NEEDED}") from None
