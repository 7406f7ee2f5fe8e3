"""The line and the files that timetables are imported into."""

from pathlib import Path

import pytest
from openpyxl import Workbook
from train_study import FILES, write_train_study

from tractionpower.io.imports.imported import Imported
from tractionpower.io.imports.tables.reading import read_table_timetable
from tractionpower.io.text_files import Source
from tractionpower.io.yaml_files import read_yaml


@pytest.fixture
def study(tmp_path):
    """Return a study with stations A (Alfa), B (Łódź Bravo), P (Papa), C (Charlie) on tracks 1 and 2, but without a timetable."""
    folder = write_train_study(tmp_path / "six")
    (folder / "timetable.yaml").unlink()
    return folder


@pytest.fixture
def read(tmp_path, study):
    """Return a function that imports a text as CSV, or sheets of rows as a workbook."""

    def imported(content: str | dict[str, list[list[object]]], **options: object) -> Imported:
        if isinstance(content, str):
            source = tmp_path / "plan.csv"
            source.write_text(content, encoding="utf-8")
        else:
            source = write_sheets(tmp_path / "plan.xlsx", content)
        return read_table_timetable(source, study, **{"train": "local"} | options)

    return imported


@pytest.fixture
def trains_of(read, tmp_path):
    """Return a function that imports and returns the trains as they stand in the file; there must be no error."""

    def trains(content: str | dict[str, list[list[object]]], **options: object) -> list[dict[str, object]]:
        found = read(content, **options)
        assert [problem for problem in found.notes.problems if problem.severity == "error"] == []
        file = tmp_path / "written.yaml"
        file.write_text(found.texts["timetable.yaml"], encoding="utf-8")
        return read_yaml(Source(file, "written.yaml", "")).data["trains"]

    return trains


def write_sheets(path: Path, sheets: dict[str, list[list[object]]]) -> Path:
    """Write a workbook of rows by sheet."""
    book = Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
    book.save(path)
    return path


@pytest.fixture
def study_files():
    """Return the texts of the study's files."""
    return dict(FILES)
