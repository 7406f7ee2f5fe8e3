"""A case's outcome as bytes: what workers send, what the store keeps, so that all ways to run give the same.

The bytes are a ZIP archive of ``case.json`` and an Arrow stream for each table; its checksums tell a broken file.
"""

from __future__ import annotations

import io
import json
import zipfile
from typing import Any

import numpy as np
import pyarrow as pa

from tractionpower.results.tables import schema_of
from tractionpower.studies.runner.case import CASE_TABLES, COMPLETE, FIGURES, CaseResult

FORMAT = 2
"""Of the archive; raised when its content changes, so that older ones are not read."""

_MEMBER = "case.json"
_STAMP = (1980, 1, 1, 0, 0, 0)  # no time of day: equal outcomes are equal bytes


def pack(result: CaseResult) -> bytes:
    """Return an outcome as bytes.

    Raises
    ------
    ValueError
        If it has a figure or a table that is not declared.
    """
    unknown = {*result.figures} - {*FIGURES, "status", "reason"} | {*result.tables} - {*CASE_TABLES}
    if unknown:
        raise ValueError(f"not declared for cases: {', '.join(sorted(unknown))}")
    row = {"status": COMPLETE, "reason": ""} | {name: _plain(value) for name, value in result.figures.items()}
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_STORED) as archive:
        archive.writestr(zipfile.ZipInfo(_MEMBER, _STAMP), json.dumps({"format": FORMAT, "row": row}, sort_keys=True))
        for name in sorted(result.tables):
            archive.writestr(zipfile.ZipInfo(name, _STAMP), _stream(name, result.tables[name]))
    return buffer.getvalue()


def is_whole(data: bytes) -> bool:
    """Return whether bytes are a whole outcome of this format."""
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            return archive.testzip() is None and json.loads(archive.read(_MEMBER))["format"] == FORMAT
    except (zipfile.BadZipFile, KeyError, ValueError, TypeError, EOFError, OSError, NotImplementedError):
        return False


def row_of(data: bytes) -> dict[str, Any]:
    """Return status, reason and figures of an outcome."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        row: dict[str, Any] = json.loads(archive.read(_MEMBER))["row"]
    return row


def table_of(data: bytes, table: str) -> pa.Table | None:
    """Return the rows of a table of an outcome, None if it has none."""
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if table not in archive.namelist():
            return None
        with pa.ipc.open_stream(archive.read(table)) as reader:
            return reader.read_all()


def _stream(name: str, rows: pa.Table) -> bytes:
    """Return rows in their declared columns as an Arrow stream."""
    declared = schema_of(name)
    schema = declared.remove(declared.get_field_index("case"))
    whole = rows.select(schema.names).cast(schema).unify_dictionaries().combine_chunks()
    sink = pa.BufferOutputStream()
    with pa.ipc.new_stream(sink, schema, options=pa.ipc.IpcWriteOptions(compression="lz4")) as writer:
        writer.write_table(whole)
    return bytes(sink.getvalue().to_pybytes())


def _plain(value: Any) -> Any:
    """Return a value as JSON can hold it: numpy's scalars as Python's, NaN as none."""
    if isinstance(value, np.generic):
        value = value.item()
    return None if isinstance(value, float) and value != value else value  # noqa: PLR0124 - NaN alone differs from itself
