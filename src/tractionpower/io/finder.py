"""Where studies and shipped data are: a folder, a file, or the name of a line that ships."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from importlib import resources
from pathlib import Path
from typing import Literal

from tractionpower.errors import UsageError
from tractionpower.io.wording import did_you_mean, printable, shown

STUDY_FILE = "study.yaml"

DataKind = Literal["lines", "rollingstock", "validation"]


@dataclass(frozen=True, slots=True)
class Study:
    """A study that was found.

    Attributes
    ----------
    file, folder
        The study file and the folder it stands in, both absolute.
    origin
        Where it was found, in words.
    """

    file: Path
    folder: Path
    origin: str


def find_study(study: str | Path) -> Study:
    """Return the study that a user means by a path or by the name of a shipped line.

    A path that exists wins over a shipped name. A shipped line is named alone, or with one of its study files, such as
    ``two-substations/loads.yaml``. Names are looked up in ``lines`` of the working folder, then in the package.

    Raises
    ------
    UsageError
        If there is no such path and no such name, or if a folder holds no ``study.yaml``.
    """
    path = Path(study)
    if not str(study).strip():
        raise UsageError("the name of the study is empty")
    if _exists(path):
        return _study_at(path)
    for folder, origin in _shipped_folders():
        named = path if path.suffix == ".yaml" else path / STUDY_FILE
        if len(named.parts) == 2 and ".." not in named.parts and _exists(folder / named):
            return Study(folder / named, (folder / named).parent, origin)
    raise UsageError(_unknown(str(study)))


def shipped_names() -> list[str]:
    """Return the names of the lines that can be named without a path, sorted."""
    folders = [folder for folder, _ in _shipped_folders() if folder.is_dir()]
    return sorted({file.parent.name for folder in folders for file in folder.glob(f"*/{STUDY_FILE}")})


def data_folder(kind: DataKind) -> Path:
    """Return the folder of data that travel with the program; in an editable checkout that of the repository.

    The folder need not exist: a repository may have no data of a kind yet.
    """
    package = Path(str(resources.files("tractionpower")))
    installed = package / "_data" / kind
    return installed if installed.is_dir() else package.parents[1] / kind


def _exists(path: Path) -> bool:
    try:
        return path.exists()
    except (OSError, ValueError):  # a name that is too long, or holds a NUL
        return False


def _study_at(path: Path) -> Study:
    file = (path / STUDY_FILE if path.is_dir() else path).absolute()
    if path.is_dir() and not file.exists():
        shown_path = printable(str(path))
        remedy = "give the folder of a study, a study file or the name of a shipped line"
        raise UsageError(f"the folder {shown_path} has no {STUDY_FILE}; {remedy}; `tractionpower new DIR` starts a study")
    return Study(file, file.parent, printable(str(path)))


def _shipped_folders() -> Iterator[tuple[Path, str]]:
    yield Path("lines").absolute(), "the folder lines of the working folder"
    yield data_folder("lines"), "the lines that ship with tractionpower"


def _unknown(name: str) -> str:
    names = shipped_names()
    shipped = f"lines that ship: {', '.join(names)}" if names else "no lines ship with this version"
    parts = [f"there is no study {shown(name)}: neither a path nor a shipped line", did_you_mean(name, names), shipped]
    return "; ".join(part for part in parts if part)
