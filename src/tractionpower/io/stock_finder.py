"""Where the files of trains, vehicles and couplings are.

The file of an identifier lies in ``rollingstock/trains``, ``vehicles`` or ``couplings`` of the study's folder, of the
working folder, or of the data that ship; the first that exists wins. An identifier is the name of its file
(`tractionpower.io.file_names`), capitals and small letters kept apart on every system.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Literal

from tractionpower.errors import InputError, Problem
from tractionpower.io.file_names import ENDING, identifier_of, looks_like, stands_for
from tractionpower.io.finder import data_folder
from tractionpower.io.wording import did_you_mean, printable, shorten, shown

StockKind = Literal["trains", "vehicles", "couplings"]

FOLDER: Literal["rollingstock"] = "rollingstock"

_PLACES = "the study's folder, the working folder or the data that ship"
_MOST_LISTED = 12


def find_rolling_stock(kind: StockKind, identifier: str, study_folder: Path | None) -> Path | None:
    """Return the file of a train, vehicle or coupling, or None if there is none.

    Parameters
    ----------
    kind
        Which of them.
    identifier
        Its id, which is the name of the file.
    study_folder
        Folder of the study that asks; None if there is no study.

    Raises
    ------
    InputError
        If a folder holds two files for it.
    """
    for folder in _folders(kind, study_folder):
        names = _names(folder)
        found = [name for name in names if stands_for(name, identifier)] or [
            name for name in names if looks_like(name, identifier)
        ]
        if len(found) > 1:
            label = printable(folder.as_posix())
            told = f"two files for {shown(identifier)}: {', '.join(map(printable, found))}"
            raise InputError([Problem("two_files", f"{kind}[{shorten(identifier)}]", told, "one", "delete one", place=label)])
        if found:
            return folder / found[0]
    return None


def known_rolling_stock(kind: StockKind, study_folder: Path | None) -> list[str]:
    """Return the ids of all trains, vehicles or couplings that can be named, sorted."""
    return sorted({identifier_of(name) for folder in _folders(kind, study_folder) for name in _names(folder)})


def shipped_trains() -> list[str]:
    """Return the ids of the trains that ship, sorted."""
    return sorted(map(identifier_of, _names(data_folder(FOLDER) / "trains")))


def shipped_vehicles() -> list[str]:
    """Return the ids of the vehicles that ship, sorted."""
    return sorted(map(identifier_of, _names(data_folder(FOLDER) / "vehicles")))


def not_found(kind: StockKind, identifier: str, study_folder: Path | None, path: str, place: str) -> Problem:
    """Return the problem that no file of `identifier` exists, which `path` of the model at `place` in the files names."""
    one = kind.removesuffix("s")
    known = known_rolling_stock(kind, study_folder)
    places = "the working folder or the data that ship" if study_folder is None else _PLACES
    remedy = did_you_mean(identifier, known) or f"add the file; {_listed(kind, known)}"
    found = f"there is no {one} {shown(identifier)}"
    return Problem(f"unknown_{one}", path, found, f"a file in {FOLDER}/{kind} of {places}", remedy, place=place)


def unknown_stock(name: str, kinds: Sequence[StockKind]) -> str:
    """Return in words that `name` is neither a file nor the id of anything of `kinds`, and what is known."""
    known = {kind: known_rolling_stock(kind, None) for kind in kinds}
    told = f"there is no {kinds[0].removesuffix('s')} {shown(name)}: neither a file nor a name in {FOLDER}"
    hint = did_you_mean(name, [each for names in known.values() for each in names])
    return "; ".join(part for part in (told, hint, *(_listed(kind, names) for kind, names in known.items())) if part)


def _folders(kind: StockKind, study_folder: Path | None) -> Iterator[Path]:
    if study_folder is not None:
        yield study_folder / FOLDER / kind
    yield Path(FOLDER).absolute() / kind
    yield data_folder(FOLDER) / kind


def _names(folder: Path) -> list[str]:
    try:
        names = [file.name for file in folder.iterdir()]
    except OSError:  # there is no such folder, or it is closed
        return []
    return sorted(name for name in names if name.endswith(ENDING) and not name.startswith("."))  # macOS leaves ._ files


def _listed(kind: StockKind, known: list[str]) -> str:
    if not known:
        return f"no {kind} are known"
    more = f", ... ({len(known)} in all)" if len(known) > _MOST_LISTED else ""
    return f"known {kind}: {', '.join(map(shorten, known[:_MOST_LISTED]))}{more}"
