"""Long tables as sheets of an Excel workbook (ECMA-376, part 1, clause 18), a column at a time.

A cell at a time, as `openpyxl` writes, a day of trains (600 000 rows of 24 columns) takes a hundred seconds; so it is four.
No cell becomes a formula: numbers are written as numbers, and texts as texts that stay so when somebody edits them.
"""

from __future__ import annotations

import re
import zipfile
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import IO, Any
from xml.sax.saxutils import escape, quoteattr

import pyarrow as pa
import pyarrow.compute as pc

MOST_ROWS = 1_048_576
"""Rows of a sheet, the heading included; a limit of Excel."""

LONGEST_TEXT = 32_767
"""Characters in a cell; a limit of Excel."""

_ROWS_AT_A_TIME = 50_000
_EMPTY = "<c/>"
_HEADING, _QUOTED = 1, 2  # styles in _STYLES: bold; a text that Excel might take for a formula when it is edited
_FORBIDDEN = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # no characters of XML 1.0
_XML = '<?xml version="1.0" encoding="UTF-8" standalone="yes"?>\n'
_MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
_OFFICE = "http://schemas.openxmlformats.org/officeDocument/2006/relationships"
_PACKAGE = "http://schemas.openxmlformats.org/package/2006"
_TYPE = "application/vnd.openxmlformats-officedocument.spreadsheetml"
_FONT = '<sz val="10"/><name val="Arial"/>'
_STYLES = (
    f'{_XML}<styleSheet xmlns="{_MAIN}"><fonts count="2"><font>{_FONT}</font><font><b/>{_FONT}</font></fonts>'
    '<fills count="2"><fill><patternFill patternType="none"/></fill><fill><patternFill patternType="gray125"/></fill></fills>'
    '<borders count="1"><border/></borders><cellStyleXfs count="1"><xf numFmtId="0" fontId="0"/></cellStyleXfs>'
    '<cellXfs count="3"><xf numFmtId="0" fontId="0" xfId="0"/><xf numFmtId="0" fontId="1" xfId="0" applyFont="1"/>'
    '<xf numFmtId="0" fontId="0" xfId="0" quotePrefix="1"/></cellXfs>'
    '<cellStyles count="1"><cellStyle name="Normal" xfId="0" builtinId="0"/></cellStyles></styleSheet>'
)


@dataclass(frozen=True, slots=True)
class Sheet:
    """A sheet: its name, the headings of its columns, and its rows as Arrow tables, some at a time."""

    name: str
    headings: Sequence[str]
    batches: Iterable[pa.Table]


def write_sheets(path: Path, sheets: Sequence[Sheet]) -> None:
    """Write a workbook; the first row of every sheet holds the headings and stays in sight."""
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED, compresslevel=1) as book:
        for number, sheet in enumerate(sheets, 1):
            with book.open(f"xl/worksheets/sheet{number}.xml", "w", force_zip64=True) as stream:
                _write_sheet(stream, sheet)
        book.writestr("xl/styles.xml", _STYLES)
        book.writestr("xl/workbook.xml", _workbook([sheet.name for sheet in sheets]))
        targets = [("worksheet", f"worksheets/sheet{number}.xml") for number in range(1, len(sheets) + 1)]
        book.writestr("xl/_rels/workbook.xml.rels", _relations([*targets, ("styles", "styles.xml")]))
        book.writestr("_rels/.rels", _relations([("officeDocument", "xl/workbook.xml")]))
        book.writestr("[Content_Types].xml", _content_types(len(sheets)))


def _write_sheet(stream: IO[bytes], sheet: Sheet) -> None:
    widths = "".join(
        f'<col min="{number}" max="{number}" width="{max(10, len(heading) + 2)}" customWidth="1"/>'
        for number, heading in enumerate(sheet.headings, 1)
    )
    head = "".join(_text_cell(heading, _HEADING) for heading in sheet.headings)
    stream.write(
        f'{_XML}<worksheet xmlns="{_MAIN}"><sheetViews><sheetView workbookViewId="0">'
        '<pane ySplit="1" topLeftCell="A2" activePane="bottomLeft" state="frozen"/></sheetView></sheetViews>'
        f"<cols>{widths}</cols><sheetData><row>{head}</row>".encode()
    )
    for batch in sheet.batches:
        for first in range(0, batch.num_rows, _ROWS_AT_A_TIME):
            stream.write("".join(_rows(batch.slice(first, _ROWS_AT_A_TIME))).encode())
    stream.write(b"</sheetData></worksheet>")


def _rows(table: pa.Table) -> Iterator[str]:
    cells = [_cells(column.combine_chunks()) for column in table.columns]
    rows: list[str] = pc.binary_join_element_wise("<row>", *cells, "</row>", "").to_pylist()
    return iter(rows)


def _cells(column: pa.Array) -> pa.Array:
    """Return a column as XML, a text for each cell; a missing value is an empty cell."""
    if pa.types.is_dictionary(column.type):
        names = pa.array([_text_cell(name) for name in column.dictionary.to_pylist()], pa.string())
        return names.take(column.indices).fill_null(_EMPTY)
    if pa.types.is_boolean(column.type):
        return pc.if_else(column, '<c t="b"><v>1</v></c>', '<c t="b"><v>0</v></c>').fill_null(_EMPTY)
    if pa.types.is_floating(column.type):  # a sheet has no number for what is not finite
        column = pc.if_else(pc.is_finite(column), column, None)
    # As a text a number of 32 bits has the digits that it is worth, 3600.1 and not 3600.10009765625.
    return pc.binary_join_element_wise("<c><v>", column.cast(pa.string()), "</v></c>", "").fill_null(_EMPTY)


def _text_cell(text: str, style: int = 0) -> str:
    shown = escape(_FORBIDDEN.sub("\ufffd", text)[:LONGEST_TEXT])
    style = style or (_QUOTED if text[:1] in tuple("=+-@") else 0)
    return f'<c t="inlineStr" s="{style}"><is><t xml:space="preserve">{shown}</t></is></c>'


def _workbook(names: Sequence[str]) -> str:
    sheets = "".join(f'<sheet name={quoteattr(name)} sheetId="{n}" r:id="rId{n}"/>' for n, name in enumerate(names, 1))
    views = "<bookViews><workbookView/></bookViews>"
    return f'{_XML}<workbook xmlns="{_MAIN}" xmlns:r="{_OFFICE}">{views}<sheets>{sheets}</sheets></workbook>'


def _relations(targets: Sequence[tuple[str, str]]) -> str:
    items = "".join(
        f'<Relationship Id="rId{number}" Type="{_OFFICE}/{kind}" Target="{target}"/>'
        for number, (kind, target) in enumerate(targets, 1)
    )
    return f'{_XML}<Relationships xmlns="{_PACKAGE}/relationships">{items}</Relationships>'


def _content_types(count: int) -> str:
    parts: dict[str, Any] = {"/xl/workbook.xml": "sheet.main", "/xl/styles.xml": "styles"}
    parts |= {f"/xl/worksheets/sheet{number}.xml": "worksheet" for number in range(1, count + 1)}
    items = "".join(f'<Override PartName="{name}" ContentType="{_TYPE}.{kind}+xml"/>' for name, kind in parts.items())
    relations = "application/vnd.openxmlformats-package.relationships+xml"
    defaults = f'<Default Extension="rels" ContentType="{relations}"/><Default Extension="xml" ContentType="application/xml"/>'
    return f'{_XML}<Types xmlns="{_PACKAGE}/content-types">{defaults}{items}</Types>'
