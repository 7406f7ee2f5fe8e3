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
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
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
GROUP_ROWS = 1_000_000
"""Rows of a row group in a file."""

BESIDE = ".new"
"""Before the suffix of a file that was written beside one that another program holds open."""


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
        self.held: list[Path] = []
        self._count = 0
        self._parts: dict[str, list[Path]] = {}
        self.running = folder / RUNNING / input_hash[:16]
        with _told(folder):
            _refuse_foreign(folder, study, force=force)
            self._made = [path for path in (folder, *folder.parents) if not path.exists()]
            shutil.rmtree(self.running, ignore_errors=True)
            self.running.mkdir(parents=True)

    def append(self, table: str, rows: pa.Table) -> None:
        """Write `rows` of `table` as a complete part."""
        self._count += 1
        path = self.running / f"{table}-{self._count:06d}.parquet"
        with _told(self.folder):
            _write(path, lambda temporary: pq.write_table(rows, temporary, compression="zstd"))
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
            files.append(_write_json(self.running / KEY_FIGURES_FILE, key_figures))
            entries = [{"size": file.stat().st_size, "sha256": _sha256(file)} for file in files]
            earlier = _earlier_files(self.folder)
        with _uninterrupted(), _told(self.folder, "Some files there are new and some old; mend that and run again"):
            complete = run | {"files": {self._move_in(file): entry for file, entry in zip(files, entries, strict=True)}}
            last = self._move_in(_write_json(self.running / RUN_FILE, complete))
            for stale in earlier - {*complete["files"], last, *(path.name for path in self.held)}:
                with suppress(OSError):  # not named by run.json, so no part of the results
                    (self.folder / stale).unlink()
            shutil.rmtree(self.folder / RUNNING, ignore_errors=True)
        return complete

    def discard(self) -> None:
        """Leave no trace: nothing was computed."""
        shutil.rmtree(self.running, ignore_errors=True)
        for folder in (self.folder / RUNNING, *self._made):
            if folder.is_dir() and not any(folder.iterdir()):
                folder.rmdir()

    def keep_unfinished(self, run: dict[str, Any]) -> Path:
        """Leave the parts where they are, with a note of what they are; return their folder."""
        with _told(self.folder):
            _write_json(self.running / RUN_FILE, run)
        return self.running

    def _join(self, table: str) -> Path:
        schema = schema_of(table)

        def write(temporary: Path) -> None:
            with pq.ParquetWriter(temporary, schema, compression="zstd") as writer:
                for group in _regroup(pq.read_table(part).cast(schema) for part in self._parts[table]):
                    writer.write_table(group)

        return _write(self.running / f"{table}.parquet", write)

    def _move_in(self, file: Path) -> str:
        target = self.folder / file.name
        try:
            file.replace(target)
        except PermissionError:  # Windows: another program holds the file that would be replaced
            self.held.append(target)
            target = _beside(target)
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
    path = _run_file(folder)
    if not path.is_file():
        raise UsageError(f"{folder}: no results of a run are there ({RUN_FILE} is missing)")
    run = _read_json(path)
    if run is None or not isinstance(run.get("files"), dict):
        raise UsageError(f"{path}: not what a complete run writes; run the study again")
    for name, entry in run["files"].items():
        file = folder / name
        if not file.is_file() or file.stat().st_size != entry["size"] or _sha256(file) != entry["sha256"]:
            raise UsageError(f"{file}: not the file that the run wrote; run the study again")
    return run


def written_as(run: dict[str, Any], name: str) -> str:
    """Return under which name the run of ``run.json`` wrote the file `name`."""
    return name if name in run["files"] else _beside(Path(name)).name


def table_names(run: dict[str, Any]) -> list[str]:
    """Return the tables that ``run.json`` names, sorted."""
    files = [name for name in run["files"] if name.endswith(".parquet")]
    return sorted(name.removesuffix(".parquet").removesuffix(BESIDE) for name in files)


def _regroup(parts: Iterable[pa.Table]) -> Iterator[pa.Table]:
    """Yield all rows in groups of one size, so that a file does not depend on how many came at a time."""
    waiting = None
    for part in parts:
        waiting = part if waiting is None else pa.concat_tables([waiting, part])
        while waiting.num_rows > GROUP_ROWS:
            yield _one_piece(waiting.slice(0, GROUP_ROWS))
            waiting = waiting.slice(GROUP_ROWS)
    if waiting is not None:
        yield _one_piece(waiting)


def _one_piece(rows: pa.Table) -> pa.Table:
    return rows.unify_dictionaries().combine_chunks()


def _beside(path: Path) -> Path:
    return path.with_name(f"{path.stem}{BESIDE}{path.suffix}")


def _run_file(folder: Path) -> Path:
    """Return the file that says what a run was; one written beside is the newer one."""
    path = folder / RUN_FILE
    return _beside(path) if _beside(path).is_file() else path


def _read_json(path: Path) -> dict[str, Any] | None:
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        return None
    return content if isinstance(content, dict) else None


def _earlier_files(folder: Path) -> set[str]:
    """Return the names of the files of an earlier run, those written beside included."""
    path = _run_file(folder)
    run = (_read_json(path) if path.is_file() else None) or {}
    names = run.get("files", {})
    return {path.name, *(name for name in names if Path(name).name == name)}


def _write(path: Path, write: Callable[[Path], None]) -> Path:
    """Let `write` fill a file that gets its name when it is complete."""
    temporary = path.with_suffix(".tmp")
    try:
        write(temporary)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
    return path


def _write_json(path: Path, content: Any) -> Path:
    text = json.dumps(content, indent=1, ensure_ascii=False)
    return _write(path, lambda temporary: _write_text(temporary, text))


def _write_text(path: Path, text: str) -> None:
    path.write_text(text, encoding="utf-8")


def _refuse_foreign(folder: Path, study: str, *, force: bool) -> None:
    if not folder.exists():
        return
    if not folder.is_dir():
        raise UsageError(f"{folder} is a file; name a folder for the results with --out")
    if force:
        return
    path = _run_file(folder)
    if path.is_file():
        run = _read_json(path)
        owner = "an unreadable run" if run is None else run.get("study")
        if owner != study:
            raise UsageError(f"{folder} holds results of another study ({owner!r}, not {study!r}); choose --out, or --force")
    elif not all(entry.name == RUNNING or _holds_results(entry) for entry in folder.iterdir()):
        raise UsageError(f"{folder} holds files that are no results of a run; choose another --out, or --force")


def _holds_results(entry: Path) -> bool:
    """Return whether something in a folder is a folder of results itself: `journey` writes beside what `run` writes."""
    return (entry / RUNNING).is_dir() or _run_file(entry).is_file()


def _sha256(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


@contextmanager
def _uninterrupted() -> Iterator[None]:
    """Put Ctrl-C off for the moment in which results move in; then it comes too late to stop anything."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, before)


@contextmanager
def _told(folder: Path, harm: str = "Earlier results there are unharmed") -> Iterator[None]:
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
        raise OutputError(f"results cannot be written into {folder}: {reason}. {harm}") from error
