"""Results on disk: complete parts while a run lasts, joined and moved in at its end, ``run.json`` last.

A folder holds valid results if its ``run.json`` names the size and the hash of every file. Nothing that is there is
touched before the new results are complete.
"""

from __future__ import annotations

import errno
import hashlib
import json
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pyarrow as pa
import pyarrow.parquet as pq

from tractionpower.errors import OutputError, UsageError
from tractionpower.results.columns import TABLES
from tractionpower.results.tables import schema_of

RUN_FILE = "run.json"
KEY_FIGURES_FILE = "key_figures.json"
RUNNING = ".running"


class RunWriter:
    """Writes one run into a folder.

    Parameters
    ----------
    folder
        Where the results go; made when it does not exist.
    study
        Identifier of the study; a folder that holds results of another study is refused.
    input_hash
        Hash of the scenario, which names the folder of the parts.
    force
        Write even where results of another study, or other files, are.

    Raises
    ------
    UsageError
        If the folder belongs to another study.
    OutputError
        If it cannot be written.
    """

    def __init__(self, folder: Path, study: str, input_hash: str, *, force: bool = False) -> None:
        self.folder, self.study = folder, study
        self.beside: list[Path] = []
        self._count = 0
        self._parts: dict[str, list[Path]] = {}
        self.running = folder / RUNNING / input_hash[:16]
        with _told(folder):
            if not force:
                _refuse_foreign(folder, study)
            shutil.rmtree(self.running, ignore_errors=True)
            self.running.mkdir(parents=True)

    def append(self, table: str, rows: pa.Table) -> None:
        """Write `rows` of `table` as a complete part."""
        self._count += 1
        path = self.running / f"{table}-{self._count:06d}.parquet"
        with _told(self.folder):
            temporary = path.with_suffix(".tmp")
            pq.write_table(rows, temporary, compression="zstd")
            temporary.replace(path)
        self._parts.setdefault(table, []).append(path)

    def finish(self, run: dict[str, Any], key_figures: list[dict[str, Any]]) -> dict[str, Any]:
        """Join the parts, move everything in, write ``run.json`` last.

        Returns
        -------
        dict
            What ``run.json`` holds: `run` with the files.
        """
        with _told(self.folder):
            files = [self._join(table) for table in TABLES if table in self._parts]
            path = self.running / KEY_FIGURES_FILE
            path.write_text(json.dumps(key_figures, indent=1, ensure_ascii=False), encoding="utf-8")
            entries = {}
            for file in [*files, path]:
                size, digest = file.stat().st_size, _sha256(file)
                entries[self._move_in(file)] = {"size": size, "sha256": digest}
            complete = run | {"files": entries}
            path = self.running / RUN_FILE
            path.write_text(json.dumps(complete, indent=1, ensure_ascii=False), encoding="utf-8")
            self._move_in(path)
            shutil.rmtree(self.folder / RUNNING, ignore_errors=True)
        return complete

    def discard(self) -> None:
        """Leave no trace: nothing was computed."""
        shutil.rmtree(self.running, ignore_errors=True)
        for folder in (self.folder / RUNNING, self.folder):
            if folder.is_dir() and not any(folder.iterdir()):
                folder.rmdir()

    def keep_unfinished(self, run: dict[str, Any]) -> Path:
        """Leave the parts where they are, with a note of what they are; return their folder."""
        with _told(self.folder):
            (self.running / RUN_FILE).write_text(json.dumps(run, indent=1, ensure_ascii=False), encoding="utf-8")
        return self.running

    def _join(self, table: str) -> Path:
        path = self.running / f"{table}.parquet"
        with pq.ParquetWriter(path, schema_of(table), compression="zstd") as writer:
            for part in self._parts[table]:
                writer.write_table(pq.read_table(part).cast(schema_of(table)))
        return path

    def _move_in(self, file: Path) -> str:
        target = self.folder / file.name
        try:
            file.replace(target)
        except PermissionError:  # Windows: another program holds the file that would be replaced
            target = target.with_name(f"{target.stem}.new{target.suffix}")
            file.replace(target)
            self.beside.append(target)
        return target.name


class MemoryWriter:
    """Keeps the tables of a run in memory."""

    def __init__(self) -> None:
        self._parts: dict[str, list[pa.Table]] = {}

    def append(self, table: str, rows: pa.Table) -> None:
        """Keep `rows` of `table`."""
        self._parts.setdefault(table, []).append(rows)

    def tables(self) -> dict[str, pa.Table]:
        """Return all tables, joined."""
        return {table: pa.concat_tables(parts) for table, parts in self._parts.items()}


def read_run(folder: Path) -> dict[str, Any]:
    """Return ``run.json`` of a folder with valid results.

    Raises
    ------
    UsageError
        If there are no results, or a file is missing or not the one that was written.
    """
    path = folder / RUN_FILE
    if not path.is_file():
        raise UsageError(f"{folder}: no results of a run are there ({RUN_FILE} is missing)")
    run: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    for name, entry in run["files"].items():
        file = folder / name
        if not file.is_file() or file.stat().st_size != entry["size"] or _sha256(file) != entry["sha256"]:
            raise UsageError(f"{file}: not the file that the run wrote; run the study again")
    return run


def read_table(folder: Path, table: str) -> pa.Table:
    """Return a table of a folder with results."""
    return pq.read_table(folder / f"{table}.parquet")


def _refuse_foreign(folder: Path, study: str) -> None:
    if not folder.exists():
        return
    if not folder.is_dir():
        raise UsageError(f"{folder} is a file; name a folder for the results with --out")
    path = folder / RUN_FILE
    if path.is_file():
        try:
            owner = json.loads(path.read_text(encoding="utf-8")).get("study")
        except (ValueError, AttributeError):
            owner = "an unreadable run"
        if owner != study:
            raise UsageError(f"{folder} holds results of another study ({owner!r}, not {study!r}); choose --out, or --force")
    elif any(entry.name != RUNNING for entry in folder.iterdir()):
        raise UsageError(f"{folder} holds files that are no results of a run; choose another --out, or --force")


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@contextmanager
def _told(folder: Path) -> Iterator[None]:
    """Turn what the operating system says into a message that helps."""
    try:
        yield
    except OSError as error:
        if error.errno in (errno.ENOSPC, errno.EDQUOT if hasattr(errno, "EDQUOT") else errno.ENOSPC):
            reason = "the disk is full; make room and run again"
        elif error.errno in (errno.EACCES, errno.EPERM, errno.EROFS):
            reason = "no permission to write; choose another folder with --out"
        else:
            reason = os.strerror(error.errno) if error.errno else str(error)
        raise OutputError(f"results cannot be written into {folder}: {reason}. Earlier results there are unharmed") from error
