"""Where cases of train dynamics are: a folder, a file, or the name of one that ships."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from tractionpower.errors import UsageError
from tractionpower.io.finder import data_folder
from tractionpower.io.stock_finder import FOLDER
from tractionpower.io.wording import did_you_mean, printable, shown

CASE_FILE = "case.yaml"

INI = ".ini"
"""Ending of a configuration of Arshad et al."""

_KIND = "dynamics"


@dataclass(frozen=True, slots=True)
class FoundCase:
    """A case that was found.

    Attributes
    ----------
    file
        Its file, absolute: ``case.yaml``, another file in YAML, or a configuration of Arshad et al.
    name
        Name of its folder, or of its file without the ending where the file is not called ``case.yaml``.
    origin
        Where it was found: the path as it was given, or in words.
    """

    file: Path
    name: str
    origin: str

    @property
    def is_ini(self) -> bool:
        """Whether it is a configuration of Arshad et al."""
        return self.file.suffix.lower() == INI


def find_case(case: str | Path) -> FoundCase:
    """Return the case that a user means by a path or by the name of a shipped one; a path that exists wins.

    Names are looked up in ``rollingstock/dynamics`` of the working folder, then among what ships.

    Raises
    ------
    UsageError
        If there is no such path and no such name, or if a folder holds no case, or several.
    """
    path = Path(case)
    if not str(case).strip():
        raise UsageError("the name of the case is empty")
    if _exists(path):
        return _case_at(path, printable(str(path)), by_folder=path.is_dir())
    for folder, origin in _folders():
        if len(path.parts) == 1 and ".." not in path.parts and _exists(folder / path) and _files(folder / path):
            return _case_at(folder / path, origin, by_folder=True)
    raise UsageError(_unknown(str(case)))


def shipped_cases() -> list[str]:
    """Return the names of the cases that can be named without a path, sorted."""
    folders = [folder for folder, _ in _folders() if folder.is_dir()]
    return sorted({each.name for folder in folders for each in folder.iterdir() if each.is_dir() and _files(each)})


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a name that is too long, or holds a NUL
        return False


def _files(folder: Path) -> list[Path]:
    # case.yaml stands alone; without it every configuration in the folder is a candidate.
    if (folder / CASE_FILE).is_file():
        return [folder / CASE_FILE]
    try:
        return sorted(file for file in folder.iterdir() if file.suffix.lower() == INI and not file.name.startswith("."))
    except OSError:  # a closed folder, or a file
        return []


def _case_at(path: Path, origin: str, *, by_folder: bool) -> FoundCase:
    path = path.absolute()
    if not by_folder:
        name = path.parent.name if path.name == CASE_FILE else path.stem
        return FoundCase(path, name, origin)
    files = _files(path)
    if len(files) == 1:
        return FoundCase(files[0], path.name, origin)
    remedy = "give the folder of a case, the file of a case or the name of a shipped one"
    label = printable(str(path))
    if not files:
        raise UsageError(f"the folder {label} has no {CASE_FILE} and no configuration {INI}; {remedy}")
    names = ", ".join(printable(file.name) for file in files)
    raise UsageError(f"the folder {label} has no {CASE_FILE} and several configurations: {names}; name one of them")


def _folders() -> Iterator[tuple[Path, str]]:
    yield Path(FOLDER).absolute() / _KIND, f"the folder {FOLDER}/{_KIND} of the working folder"
    yield data_folder(FOLDER) / _KIND, "the cases that ship with tractionpower"


def _unknown(name: str) -> str:
    names = shipped_cases()
    shipped = f"cases that ship: {', '.join(names)}" if names else "no cases ship with this version"
    parts = [f"there is no case {shown(name)}: neither a path nor a shipped case", did_you_mean(name, names), shipped]
    return "; ".join(part for part in parts if part)
