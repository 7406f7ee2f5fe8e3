"""Write the reference pages from the declarations: docs/inputs.md and docs/results.md."""

from __future__ import annotations

import types
import typing
from collections.abc import Iterator
from pathlib import Path
from typing import Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo
from pydantic_core import PydanticUndefined

from tractionpower.model.limits import Limit
from tractionpower.model.line import Line
from tractionpower.model.scenario import StudyFile
from tractionpower.model.supply import Supply
from tractionpower.model.timetable import Timetable
from tractionpower.model.vehicle import Train, Vehicle
from tractionpower.results.columns import TABLES

HERE = Path(__file__).parent
FILES = {
    "study.yaml": StudyFile,
    "line.yaml": Line,
    "supply.yaml": Supply,
    "timetable.yaml": Timetable,
    "rollingstock/trains/ID.yaml": Train,
    "rollingstock/vehicles/ID.yaml": Vehicle,
    "limits (CSV)": Limit,
}
INPUTS = """Units stand in the names. A list may be the name of a CSV file instead, relative to the file that names it; its
header row names the keys, those of a nested mapping with dots (`start.time`). A column that is a list of rows itself, such as
`calls`, holds names of further CSV files.

Trains and vehicles are looked for by their id in `rollingstock` of the study's folder, then of the working folder, then among
what ships. A character of an id that a file name cannot hold is written as `%` and two hexadecimal digits (`a%2Fb.yaml` for
a/b).
"""
NOTE = "<!-- made by `make docs` from the declarations; do not edit -->\n"
SIGNS = """Parquet files in the folder of the run. Currents and powers are positive when taken from the line, and when a
substation feeds. A row describes the step that begins at `time_s`; the sum of `power_kw` times the step is the energy.
With `output.every_s` only the steps at that interval have rows; key figures use all of them.
"""
FILES_OF_A_RUN = """## Other files

| file | holds |
|---|---|
| `run.json` | Status, residuals, ledgers, verdicts; size and SHA-256 of every file. Written last: results are what it names. |
| `key_figures.json` | The figures that sum the run up, each with name, value, unit, place, time, definition. |
| `scenario.json` | What was computed, resolved: all inputs in one file. Its SHA-256 is the `input_hash` of the run. |
| `report.xlsx`, `figures/` | For people; `tractionpower report DIR` writes them again from the tables, without a simulation. |
| `.running/` | Complete parts of the tables while a run lasts. `tractionpower report DIR --partial` reads them after a crash. |

## Tables for other programs

`tractionpower export DIR --to csv,xlsx,netcdf [--tables trains,calls] [--out FOLDER]` writes into `DIR/export/`.

- **csv**: one file for each table. UTF-8, comma, decimal point; a missing value is an empty cell. Texts are quoted and stand
  there as they are: Excel takes one that begins with `=` for a formula when it opens a CSV file, so hand on xlsx instead.
- **xlsx**: one workbook `tables.xlsx` with a sheet for each table; nothing in it becomes a formula. A table that is longer
  than a sheet (1 048 575 rows) is refused: export it as CSV.
- **netcdf**: one file for each table (classic format with 64-bit offsets), a variable for each column over the dimension
  `row`, with unit and meaning. A missing number is NaN. Needs SciPy: `pip install tractionpower[netcdf]`.
"""


def inputs_page() -> str:
    """Return the page of all input keys."""
    parts = [NOTE, "# Input files\n", INPUTS]
    for title, model in FILES.items():
        parts.append(f"## {title}\n")
        parts.append(_table(model))
        parts += [f"### {path}\n\n{_table(part)}" for path, part in _parts(model)]
    return "\n".join(parts)


def results_page() -> str:
    """Return the page of all result columns."""
    parts = [NOTE, "# Tables of a run\n"]
    parts.append(SIGNS)
    for name, columns in TABLES.items():
        parts.append(f"## {name}.parquet\n\n| column | unit | meaning |\n|---|---|---|")
        parts += [f"| `{c.name}` | {c.quantity.unit} | {c.quantity.meaning} |" for c in columns]
        parts.append("")
    return "\n".join([*parts, FILES_OF_A_RUN])


def _table(model: type[BaseModel]) -> str:
    rows = ["| key | unit | allowed | default | meaning |", "|---|---|---|---|---|"]
    for name, info in model.model_fields.items():
        extra = info.json_schema_extra if isinstance(info.json_schema_extra, dict) else {}
        source = f" (default: {extra['source']})" if extra.get("source") else ""
        meaning = (info.description or "") + source
        cells = (f"`{info.alias or name}`", extra.get("unit", ""), _allowed(info), _default(info), meaning)
        rows.append("| " + " | ".join(str(cell) for cell in cells) + " |")
    return "\n".join(rows) + "\n"


def _allowed(info: FieldInfo) -> str:
    bounds = []
    for item in info.metadata:
        for attribute, sign in (("gt", ">"), ("ge", "≥"), ("lt", "<"), ("le", "≤")):
            if getattr(item, attribute, None) is not None:
                bounds.append(f"{sign} {getattr(item, attribute):g}")
    literals = [kind for kind in _kinds(info.annotation) if get_origin(kind) is typing.Literal]
    if bool in _kinds(info.annotation):
        return "true, false"
    return ", ".join(bounds) or ", ".join(str(choice) for kind in literals for choice in get_args(kind))


def _default(info: FieldInfo) -> str:
    if info.default is PydanticUndefined:
        return "required" if info.default_factory is None else ""
    if isinstance(info.default, bool):
        return str(info.default).lower()
    if info.default is None or info.default == () or isinstance(info.default, BaseModel):
        return ""
    return str(info.default)


def _kinds(annotation: Any) -> Iterator[Any]:
    yield annotation
    if get_origin(annotation) in {typing.Union, types.UnionType, tuple, typing.Annotated}:
        for inner in get_args(annotation):
            yield from _kinds(inner)


def _parts(model: type[BaseModel], prefix: str = "") -> Iterator[tuple[str, type[BaseModel]]]:
    for name, info in model.model_fields.items():
        for kind in _kinds(info.annotation):
            if isinstance(kind, type) and issubclass(kind, BaseModel):
                path = f"{prefix}{info.alias or name}"
                yield path + _which(kind), kind
                yield from _parts(kind, path + ".")


def _which(model: type[BaseModel]) -> str:
    # One of several declarations is told by its only kind.
    kind = model.model_fields.get("kind")
    choices = get_args(kind.annotation) if kind is not None else ()
    return f" (kind: {choices[0]})" if len(choices) == 1 else ""


def main() -> None:
    """Write both pages."""
    (HERE / "inputs.md").write_text(inputs_page(), encoding="utf-8")
    (HERE / "results.md").write_text(results_page(), encoding="utf-8")


if __name__ == "__main__":
    main()
