"""A commented study to start from; units, meanings and defaults come from the declarations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from tractionpower.errors import UsageError
from tractionpower.io.finder import STUDY_FILE
from tractionpower.io.shapes import Shape, shape_of
from tractionpower.io.text_files import write_files
from tractionpower.io.wording import printable
from tractionpower.io.yaml_text import entry, flow
from tractionpower.model.line import Line
from tractionpower.model.scenario import StudyFile
from tractionpower.model.supply import Supply

_STUDY: dict[str, Any] = {
    "format": 1,
    "name": "Two substations and a section cabin",
    "line": "line.yaml",
    "supply": "supply.yaml",
    "clock": {"start": "00:00:00", "end": "00:15:00", "step_s": 1.0},
    "coupling": "full",
    "seed": 1,
}

_LINE: dict[str, Any] = {
    "format": 1,
    "name": "Two substations and a section cabin",
    "source": "Template of tractionpower; all values are assumed",
    "tracks": [{"id": "1", "from_km": 0.0, "to_km": 20.0}, {"id": "2", "from_km": 0.0, "to_km": 20.0}],
    "stations": [
        {"id": "A", "name": "Substation A", "km": 0.0},
        {"id": "C", "name": "Section cabin", "km": 10.0},
        {"id": "B", "name": "Substation B", "km": 20.0},
    ],
    "gradients": [],
    "speed_limits": [{"from_km": 0.0, "to_km": 20.0, "kmh": 160.0}],
}

_SUPPLY: dict[str, Any] = {
    "format": 1,
    "system": "dc3000",
    "substations": [
        {"id": "A", "km": 0.0, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12},
        {"id": "B", "km": 20.0, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12},
    ],
    "section_cabins": [{"id": "C", "km": 10.0, "state": "closed"}],
    "contact_lines": [{"tracks": ["1", "2"], "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.05}],
    "return_circuit": [{"tracks": ["1", "2"], "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.01}],
    "loads": [{"id": "depot", "track": "1", "km": 4.0, "power_kw": 400.0}],
}

_README = """\
# A study of a traction supply

Written by `tractionpower new`. Two tracks of 20 km, a substation at each end, a section cabin in the middle and one load.
All values are examples: put yours in their place.

| file | holds |
|---|---|
| `study.yaml` | names the other files, sets the simulated time |
| `line.yaml` | tracks, stations, profile, speed limits |
| `supply.yaml` | substations, section cabins, contact lines, return circuit, loads |

A comment that starts with a key, such as `#seed: 1`, shows a key that may be left out, with its default. Any list of rows may
stand in a CSV file instead, for example `gradients: gradients.csv`; its header row names the keys.

```
tractionpower check .    lists everything that is wrong with the files
tractionpower run .      computes and writes tables and reports
```

Say here where your data come from, what is measured and what is assumed.
"""


def template_texts() -> dict[str, str]:
    """Return the files of the template by name; the study file is the last."""
    return {
        "README.md": _README,
        "line.yaml": commented(Line, _LINE),
        "supply.yaml": commented(Supply, _SUPPLY),
        STUDY_FILE: commented(StudyFile, _STUDY),
    }


def write_template(folder: str | Path) -> list[Path]:
    """Write a commented study into a new or empty folder and return its files.

    Raises
    ------
    UsageError
        If `folder` is a file or holds anything.
    OutputError
        If a file cannot be written; nothing half-written is left.
    """
    target = Path(folder)
    if target.exists() and not target.is_dir():
        raise UsageError(f"{printable(str(target))} is a file; give a new folder")
    if target.is_dir() and any(target.iterdir()):
        raise UsageError(f"the folder {printable(str(target))} is not empty; give a new one")
    texts = template_texts()
    write_files(target, texts)
    return [target / name for name in texts]


def commented(model: type[BaseModel], data: Mapping[str, Any]) -> str:
    """Return a file of the declaration `model` with the values of `data`; every known key is explained.

    Keys that `data` leaves out are shown as comments, with their defaults.
    """
    shape = shape_of(model)
    blocks = [f"# {_first_line(shape)}"]
    for key in shape.keys:
        child = shape.child(key)
        if child is None:
            continue
        text = entry(key, data[key]) if key in data else f"#{key}: {flow(_default(child))}"
        blocks.append("\n".join([*_comments(key, child, data), text]))
    return "\n\n".join(blocks) + "\n"


def _comments(key: str, shape: Shape, data: Mapping[str, Any]) -> Iterator[str]:
    row = shape.child(0) if shape.kind == "rows" else shape if shape.keys else None
    about = [_first_line(row) if row is not None and not shape.meaning else _meaning(shape)]
    if key in data and row is None and shape.schema.get("default") is not None:
        about.append(f"Default: {flow(_default(shape))}.")
    text = " ".join(part for part in about if part)
    if text:
        yield f"# {text}"
    for name in row.keys if row is not None else ():
        child = row.child(name) if row is not None else None
        if row is not None and child is not None:
            yield f"#   {_explained(name, child, name in row.required)}"


def _explained(name: str, shape: Shape, is_required: bool) -> str:
    unit = f" [{shape.unit}]" if shape.unit else ""
    default = shape.schema.get("default")
    ending = " Required." if is_required else "" if default is None else f" Default: {flow(default)}."
    return f"{name}{unit}: {_meaning(shape)}{ending}"


def _meaning(shape: Shape) -> str:
    if shape.meaning:
        return shape.meaning
    words = shape.allowed()
    return f"{words}." if words else ""


def _first_line(shape: Shape) -> str:
    return shape.meaning.partition("\n")[0].replace("``", "")


def _default(shape: Shape) -> Any:
    default = shape.schema.get("default")
    return {key: value for key, value in default.items() if value is not None} if isinstance(default, dict) else default
