"""A second program for workbooks: LibreOffice calculates every formula again, and what Excel would repair is looked for.

LibreOffice runs with a profile of its own that always recalculates (``OOXMLRecalcMode`` 0), so that the values that it writes are
its own and not those that the file brought along.
"""

import math
import os
import re
import shutil
import subprocess
import tempfile
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

SOFFICE = shutil.which("soffice") or shutil.which("libreoffice")
needs_office = pytest.mark.skipif(SOFFICE is None, reason="LibreOffice is not on the path")

MAIN = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"
CHART = "{http://schemas.openxmlformats.org/drawingml/2006/chart}"
RELATION = "{http://schemas.openxmlformats.org/officeDocument/2006/relationships}id"
LONGEST_TEXT, LONGEST_NAME = 32_767, 31
ERRORS = ("#REF!", "#NAME?", "#VALUE!", "#DIV/0!", "#N/A", "#NUM!", "#NULL!")
SAME = 1e-9
"""Numbers whose relative difference is smaller are the same."""

SETTINGS = """<?xml version="1.0" encoding="UTF-8"?>
<oor:items xmlns:oor="http://openoffice.org/2001/registry">
<item oor:path="/org.openoffice.Office.Calc/Formula/Load"><prop oor:name="OOXMLRecalcMode"><value>0</value></prop></item>
<item oor:path="/org.openoffice.Office.Common/Misc"><prop oor:name="FirstRun"><value>false</value></prop></item>
</oor:items>
"""

Values = dict[str, dict[str, Any]]
"""What cells hold by sheet and place; of formulas their values."""


def recalculated(paths: Sequence[Path]) -> list[Path]:
    """Return copies of workbooks in which LibreOffice has calculated every formula; paths differ by the names of the files."""
    assert SOFFICE is not None
    place = Path(tempfile.mkdtemp(prefix="office-", dir=paths[0].parent))
    profile = place / "profile" / "user"
    profile.mkdir(parents=True)
    (profile / "registrymodifications.xcu").write_text(SETTINGS, encoding="utf-8")
    target = place / "written"
    command = [SOFFICE, f"-env:UserInstallation={profile.parent.as_uri()}", "--headless", "--norestore"]
    command += ["--convert-to", "xlsx:Calc MS Excel 2007 XML", "--outdir", str(target), *map(str, paths)]
    told = subprocess.run(command, capture_output=True, text=True, timeout=300, check=False, env=os.environ | {"LC_ALL": "C"})
    copies = [target / path.name for path in paths]
    missing = [copy.name for copy in copies if not copy.is_file()]
    assert not missing, f"LibreOffice did not open {missing}: {told.stdout} {told.stderr}"
    return copies


def formulas_agree(path: Path, copy: Path | None = None) -> list[str]:
    """Return where the value that stands beside a formula is not the one that LibreOffice computes.

    Parameters
    ----------
    path
        The workbook.
    copy
        What `recalculated` has made of it; None: it is made here.
    """
    again, _ = read_cells(copy or recalculated([path])[0])
    values, formulas = read_cells(path)
    found = []
    for sheet, own in formulas.items():
        for place, formula in own.items():
            kept, computed = values[sheet].get(place), again[sheet].get(place)
            if not _same(kept, computed):
                found.append(f"{sheet}!{place} ={formula}: {kept!r} in the file, {computed!r} computed")
    return found


def count_formulas(path: Path) -> int:
    """Return how many formulas a workbook has."""
    return sum(len(own) for own in read_cells(path)[1].values())


def read_cells(path: Path) -> tuple[Values, dict[str, dict[str, str]]]:
    """Return values and formulas of all cells as the file holds them; times are numbers of days."""
    values: Values = {}
    formulas: dict[str, dict[str, str]] = {}
    with zipfile.ZipFile(path) as file:
        shared = _shared_texts(file)
        for name, part in sheet_parts(file).items():
            values[name], formulas[name] = {}, {}
            for _, cell in ElementTree.iterparse(file.open(part)):
                if cell.tag == f"{MAIN}c":
                    formula = cell.find(f"{MAIN}f")
                    if formula is not None:
                        formulas[name][cell.get("r", "")] = formula.text or ""
                    value = _value(cell, shared)
                    if value is not None:
                        values[name][cell.get("r", "")] = value
    return values, formulas


def sheet_parts(file: zipfile.ZipFile) -> dict[str, str]:
    """Return the part of each sheet by its name."""
    workbook = ElementTree.fromstring(file.read("xl/workbook.xml"))
    relations = ElementTree.fromstring(file.read("xl/_rels/workbook.xml.rels"))
    targets = {str(each.get("Id")): str(each.get("Target")) for each in relations}
    found = {str(sheet.get("name")): targets[str(sheet.get(RELATION))] for sheet in workbook.iter(f"{MAIN}sheet")}
    return {name: target.lstrip("/") if target.startswith("/") else f"xl/{target}" for name, target in found.items()}


def complaints(path: Path) -> list[str]:
    """Return what Excel is known to repair when it opens a workbook, or to show as an error."""
    with zipfile.ZipFile(path) as file:
        return [*_parts(file), *_sheets(file), *_tables(file), *_names(file), *_charts(file)]


def _parts(file: zipfile.ZipFile) -> Iterator[str]:
    for name in file.namelist():
        if name.endswith((".xml", ".rels")):
            try:
                ElementTree.fromstring(file.read(name))
            except ElementTree.ParseError as error:
                yield f"{name}: {error}"
    for target in (name for name in file.namelist() if name.endswith(".rels")):
        for each in ElementTree.fromstring(file.read(target)):
            if each.get("TargetMode") == "External":
                yield f"{target} leads out of the file, to {each.get('Target')}"


def _sheets(file: zipfile.ZipFile) -> Iterator[str]:
    parts, shared = sheet_parts(file), _shared_texts(file)
    if len({name.casefold() for name in parts}) < len(parts):
        yield "two sheets have the same name"
    yield from (f"{text[:40]!r} is too long for a cell" for text in shared if len(text) > LONGEST_TEXT)
    for name, part in parts.items():
        if not 0 < len(name) <= LONGEST_NAME or re.search(r"[\[\]:*?/\\]", name) or name[0] == "'" or name[-1] == "'":
            yield f"{name!r} cannot be the name of a sheet"
        sheet = ElementTree.fromstring(file.read(part))
        for cell in sheet.iter(f"{MAIN}c"):
            value = _value(cell, shared)
            if cell.get("t") == "e" or (cell.find(f"{MAIN}f") is not None and value in ERRORS):
                yield f"{name}!{cell.get('r')} is the error {value}"
            if cell.find(f"{MAIN}f") is not None and value is None:
                yield f"{name}!{cell.get('r')} has no value beside its formula"
        for each in (*sheet.iter(f"{MAIN}conditionalFormatting"), *sheet.iter(f"{MAIN}mergeCell")):
            reference = each.get("sqref") or each.get("ref") or ""
            if not all(_is_area(one) for one in reference.split()):
                yield f"{name}: {reference!r} is no area"
            for rule in each.iter(f"{MAIN}cfRule"):
                if rule.get("dxfId") is None and rule.get("type") in ("cellIs", "expression", "containsText"):
                    yield f"{name}: the conditional format of {reference} has no look"
        for each in sheet.iter(f"{MAIN}hyperlink"):
            if each.get("location") and not _exists(str(each.get("location")), parts):
                yield f"{name}!{each.get('ref')} leads to {each.get('location')}, which is not there"
        footers = [*sheet.iter(f"{MAIN}oddHeader"), *sheet.iter(f"{MAIN}oddFooter")]
        yield from (f"{name}: a header has more than 255 characters" for each in footers if len(each.text or "") > 255)


def _tables(file: zipfile.ZipFile) -> Iterator[str]:
    names: list[str] = []
    shared = _shared_texts(file)
    for sheet, part in sheet_parts(file).items():
        folder, _, own = part.rpartition("/")
        relations = f"{folder}/_rels/{own}.rels"
        if relations not in file.namelist():
            continue
        tree = ElementTree.fromstring(file.read(part))
        cells = {cell.get("r"): _value(cell, shared) for cell in tree.iter(f"{MAIN}c")}
        merged = [str(each.get("ref")) for each in tree.iter(f"{MAIN}mergeCell")]
        areas: list[str] = []
        for each in ElementTree.fromstring(file.read(relations)):
            if not str(each.get("Type")).endswith("/table"):
                continue
            table = ElementTree.fromstring(file.read(str(each.get("Target")).lstrip("/")))
            area, name = str(table.get("ref")), str(table.get("displayName"))
            names.append(name.casefold())
            if not re.fullmatch(r"[^\W\d]\w*", name) or _is_area(name):
                yield f"{name!r} cannot be the name of a table"
            left, top, right, bottom = _bounds(area)
            headings = [str(column.get("name")) for column in table.iter(f"{MAIN}tableColumn")]
            shown = [cells.get(f"{_letters(column)}{top}") for column in range(left, right + 1)]
            if [_escaped(heading) for heading in headings] != shown:
                yield f"{sheet}: the table {name} has the columns {headings}, its cells {shown}"
            if len({heading.casefold() for heading in headings}) < len(headings):
                yield f"{sheet}: two columns of the table {name} have the same heading"
            if bottom <= top:
                yield f"{sheet}: the table {name} has no rows"
            for other in (*areas, *merged):
                if _overlap(area, other):
                    yield f"{sheet}: the table {name} lies on {other}"
            areas.append(area)
    if len(set(names)) < len(names):
        yield "two tables have the same name"


def _names(file: zipfile.ZipFile) -> Iterator[str]:
    parts = sheet_parts(file)
    seen: set[tuple[str, str | None]] = set()
    for each in ElementTree.fromstring(file.read("xl/workbook.xml")).iter(f"{MAIN}definedName"):
        name, place = str(each.get("name")), each.text or ""
        key = (name.casefold(), each.get("localSheetId"))
        if key in seen:
            yield f"the name {name} is given twice"
        seen.add(key)
        if not name.startswith("_xlnm.") and (not re.fullmatch(r"[A-Za-z_\\][\w.]*", name) or _is_area(name)):
            yield f"{name!r} cannot be a name"
        if not all(_exists(one, parts) for one in re.split(r",(?=(?:[^']*'[^']*')*[^']*$)", place)):
            yield f"the name {name} stands for {place}, which is not there"


def _charts(file: zipfile.ZipFile) -> Iterator[str]:
    parts = sheet_parts(file)
    for part in (name for name in file.namelist() if re.fullmatch(r"xl/charts/chart\d+\.xml", name)):
        tree = ElementTree.fromstring(file.read(part))
        references = [each.text or "" for each in tree.iter(f"{CHART}f")]
        yield from (f"{part} draws {one}, which is not there" for one in references if not _exists(one, parts))
        if not references:
            yield f"{part} draws nothing"


def _exists(reference: str, sheets: dict[str, str]) -> bool:
    sheet, _, area = reference.lstrip("#").rpartition("!")
    name = sheet[1:-1].replace("''", "'") if sheet.startswith("'") else sheet
    return name in sheets and (_is_area(area) or re.fullmatch(r"\$?\d+:\$?\d+|\$?[A-Z]+:\$?[A-Z]+", area) is not None)


def _is_area(text: str) -> bool:
    return all(re.fullmatch(r"\$?[A-Z]{1,3}\$?[1-9]\d{0,6}", end) is not None for end in text.split(":")) and text.count(":") <= 1


def _bounds(area: str) -> tuple[int, int, int, int]:
    first, _, last = area.replace("$", "").partition(":")
    ends = []
    for cell in (first, last or first):
        letters = re.match(r"[A-Z]+", cell)
        assert letters is not None
        column = 0
        for letter in letters[0]:
            column = 26 * column + ord(letter) - 64
        ends += [column, int(cell[letters.end() :])]
    return ends[0], ends[1], ends[2], ends[3]


def _letters(column: int) -> str:
    text = ""
    while column:
        column, rest = divmod(column - 1, 26)
        text = chr(65 + rest) + text
    return text


def _overlap(one: str, other: str) -> bool:
    a, b = _bounds(one), _bounds(other)
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]


def _escaped(heading: str) -> str:
    return heading.replace("_x000a_", "\n")


def _shared_texts(file: zipfile.ZipFile) -> list[str]:
    if "xl/sharedStrings.xml" not in file.namelist():
        return []
    return ["".join(part.text or "" for part in item.iter(f"{MAIN}t"))
            for item in ElementTree.fromstring(file.read("xl/sharedStrings.xml")).iter(f"{MAIN}si")]  # fmt: skip


def _value(cell: ElementTree.Element, shared: Sequence[str]) -> Any:
    """Return what a cell holds: a number, a text, a truth; None if nothing."""
    kind, inner = cell.get("t", "n"), cell.find(f"{MAIN}v")
    if kind == "inlineStr":
        return "".join(part.text or "" for part in cell.iter(f"{MAIN}t"))
    if inner is None:
        return None
    text = inner.text or ""
    if not text and kind != "str":  # openpyxl leaves room for the value of a formula
        return None
    if kind == "s":
        return shared[int(text)]
    if kind == "b":
        return text == "1"
    return text if kind in ("str", "e") else float(text)


def _same(kept: Any, computed: Any) -> bool:
    if isinstance(kept, float) and isinstance(computed, float):
        return math.isclose(kept, computed, rel_tol=SAME, abs_tol=1e-12)
    if isinstance(kept, bool) != isinstance(computed, bool):  # LibreOffice writes truths as numbers with a format
        return float(kept) == float(computed) if None not in (kept, computed) else False
    return (kept or "") == (computed or "") if not isinstance(kept, float) and not isinstance(computed, float) else False
