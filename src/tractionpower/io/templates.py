"""A commented study to start from; units, meanings and defaults come from the declarations."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from tractionpower.errors import UsageError
from tractionpower.io.shapes import Shape, shape_of
from tractionpower.io.template_data import FILES, README
from tractionpower.io.text_files import write_files
from tractionpower.io.wording import printable
from tractionpower.io.yaml_text import entry, flow


def template_texts() -> dict[str, str]:
    """Return the files of the template by name; the study file is the last."""
    return {"README.md": README, **{name: commented(model, data) for name, (model, data) in FILES.items()}}


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
    row = _inside(shape.branch(data.get(key)))
    about = [_first_line(row) if row is not None and not shape.meaning else _meaning(shape)]
    if key in data and row is None and shape.schema.get("default") is not None:
        about.append(f"Default: {flow(_default(shape))}.")
    text = " ".join(part for part in about if part)
    if text:
        yield f"# {text}"
    if row is not None:
        yield from _keys(row, "#   ")


def _inside(shape: Shape) -> Shape | None:
    # What has keys of its own: the rows of a list, or a mapping.
    return shape.child(0) if shape.kind == "rows" else shape if shape.keys else None


def _keys(row: Shape, indent: str) -> Iterator[str]:
    for name in row.keys:
        child = row.child(name)
        if child is None:
            continue
        yield f"{indent}{_explained(name, child, name in row.required)}"
        inner = _inside(child)
        if inner is not None:
            yield from _keys(inner, indent + "  ")


def _explained(name: str, shape: Shape, is_required: bool) -> str:
    unit = f" [{shape.unit}]" if shape.unit else ""
    default = shape.schema.get("default")
    ending = " Required." if is_required else "" if default is None else f" Default: {flow(default)}."
    return f"{name}{unit}: {_meaning(shape)}{ending}"


def _meaning(shape: Shape) -> str:
    if shape.meaning:
        choices = [str(choice) for choice in shape.choices]
        is_told = len(choices) < 2 or all(choice in shape.meaning for choice in choices)
        return shape.meaning if is_told else f"{shape.meaning} One of {' | '.join(choices)}."
    words = shape.allowed()
    return f"{words}." if words else ""


def _first_line(shape: Shape) -> str:
    return shape.meaning.partition("\n")[0].replace("``", "")


def _default(shape: Shape) -> Any:
    default = shape.schema.get("default")
    return {key: value for key, value in default.items() if value is not None} if isinstance(default, dict) else default
