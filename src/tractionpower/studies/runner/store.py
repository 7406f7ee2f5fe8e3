"""Outcomes of cases, each kept in a file of its own as soon as it is there; what is kept is not run again."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from tractionpower.results.disk import failures_told, write_whole
from tractionpower.studies.runner.packed import is_whole

FOLDER = "cases"


class CaseStore:
    """Keeps outcomes by key.

    Parameters
    ----------
    folder
        Where, such as `RunWriter.beside_parts`; the files lie in its folder ``cases``. None: in memory, for as long as
        this object lives.
    full_tables
        Folder in which each case also leaves the whole results of its run, in a folder of its own. Only processes of
        this machine can: see `run_cases`.
    """

    def __init__(self, folder: Path | None = None, full_tables: Path | None = None) -> None:
        self.folder = None if folder is None else folder / FOLDER
        self.full_tables = full_tables
        self._kept: dict[str, bytes] = {}

    def has(self, key: str) -> bool:
        """Return whether a whole outcome is kept; one that is broken is as good as none."""
        if self.folder is None:
            return key in self._kept
        path = self._path(key)
        return path.is_file() and is_whole(path.read_bytes())

    def put(self, key: str, data: bytes) -> None:
        """Keep an outcome.

        Raises
        ------
        OutputError
            If it cannot be written; what is kept stays.
        """
        if self.folder is None:
            self._kept[key] = data
            return
        with failures_told(self.folder, "The cases that are kept there are unharmed", "outcomes of cases"):
            self.folder.mkdir(parents=True, exist_ok=True)
            write_whole(self._path(key), lambda temporary: temporary.write_bytes(data))

    def get(self, key: str) -> bytes:
        """Return an outcome that is kept."""
        return self._kept[key] if self.folder is None else self._path(key).read_bytes()

    def keys(self) -> Iterator[str]:
        """Yield the keys of all that is kept, broken ones included."""
        yield from sorted(self._kept if self.folder is None else (path.stem for path in self.folder.glob("*.case")))

    def _path(self, key: str) -> Path:
        assert self.folder is not None
        return self.folder / f"{key}.case"
