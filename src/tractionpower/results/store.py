"""Results on disk: complete parts while a run lasts, joined and moved in at its end, ``run.json`` last.

A folder holds valid results if its ``run.json`` names the size and the hash of every file. Nothing that is there is
touched before the new results are complete.
"""

from __future__ import annotations

import itertools
import re
import shutil
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from pathlib import Path
from typing import Any

import pyarrow as pa

from tractionpower.errors import UsageError
from tractionpower.model.base import Declaration
from tractionpower.results.columns import TABLES
from tractionpower.results.disk import (
    BESIDE,
    beside,
    failures_told,
    json_text,
    move_in,
    read_json,
    sha256_of,
    uninterrupted,
    write_json,
    write_or_beside,
    write_text,
    write_whole,
)
from tractionpower.results.kept import SCENARIO_FILE, canonical_json
from tractionpower.results.parts import is_readable, join_parts, write_part

RUN_FILE = "run.json"
KEY_FIGURES_FILE = "key_figures.json"
JOINING = 2
"""Tables that are joined at a time: each needs memory for some row groups."""

RUNNING = ".running"
CONTINUED = "continued"
PARTIAL = "partial"
"""Folder of the reports of an unfinished run."""

_PART = re.compile(r"(\w+)-(\d+)\.parquet")


class RunWriter:
    """Writes one run into a folder.

    Parameters
    ----------
    folder
        Where the results go; made when it does not exist.
    study
        Identifier of the study; a folder that holds results of another study is refused.
    kind
        What is computed of it, as ``run.json`` says it; a folder of another kind is refused. Empty: a run.
    input_hash
        Hash of the scenario, which names the folder of the parts.
    force
        Write even where results of another study or kind, or other files, are.
    scenario
        What is computed; kept with the results, from the beginning on, so that reports can be made of them later.

    Raises
    ------
    UsageError
        If the folder belongs to another study, or to another kind of results of this one.
    OutputError
        If it cannot be written.
    """

    def __init__(
        self,
        folder: Path,
        study: str,
        input_hash: str,
        *,
        kind: str = "",
        force: bool = False,
        scenario: Declaration | None = None,
    ) -> None:
        self.folder, self.study = folder, study
        self._kind = {"kind": kind} if kind else {}
        self.beside: list[Path] = []
        self.held: list[Path] = []
        self._scenario = scenario
        self._count = 0
        self._parts: dict[str, list[Path]] = {}
        self._files: dict[str, Any] = {}
        self.running = folder / RUNNING / input_hash[:16]
        with failures_told(folder):
            _refuse_foreign(folder, (study, kind), force=force)
            self._made = [path for path in (folder, *folder.parents) if not path.exists()]
            shutil.rmtree(self.running, ignore_errors=True)
            self.running.mkdir(parents=True)
            self._begin(input_hash)

    def _begin(self, input_hash: str) -> None:
        """Note what the parts are going to be, for the case that nobody is left to say it at the end."""
        note: dict[str, Any] = {"format": 1, "status": "interrupted", "study": self.study, "input_hash": input_hash}
        note |= self._kind
        if self._scenario is not None:
            write_text(self.running / SCENARIO_FILE, canonical_json(self._scenario))
            told = {key: getattr(self._scenario, key, other) for key, other in (("name", ""), ("seed", 0))}
            note |= {**told, "verdicts": [], "ledgers": {}}
        write_json(self.running / RUN_FILE, note)

    def append(self, table: str, rows: pa.Table) -> None:
        """Write `rows` of `table` as a complete part; the names that texts are coded by should be the same in all of them."""
        self._count += 1
        path = self.running / f"{table}-{self._count:06d}.parquet"
        with failures_told(self.folder):
            write_whole(path, lambda temporary: write_part(rows, temporary))
        self._parts.setdefault(table, []).append(path)

    def keep(self, scenario: Declaration) -> None:
        """Keep `scenario` with the results instead of that of the beginning: what was driven is known at the end only."""
        self._scenario = scenario
        with failures_told(self.folder):
            write_text(self.running / SCENARIO_FILE, canonical_json(scenario))

    @property
    def beside_parts(self) -> Path:
        """Folder of what a later study into the same folder goes on from; gone when one is finished that has no use for it."""
        return self.folder / RUNNING / CONTINUED

    def finish(self, run: dict[str, Any], key_figures: Sequence[dict[str, Any]], *, is_continued: bool = False) -> dict[str, Any]:
        """Join the parts, move everything in, write ``run.json`` last; what `beside_parts` holds stays if that `is_continued`.

        Returns
        -------
        dict
            What ``run.json`` holds: `run` with the files.
        """
        with uninterrupted():  # all is computed: a second or two, and Ctrl-C would throw it away
            with failures_told(self.folder):
                with ThreadPoolExecutor(JOINING) as threads:
                    files = list(threads.map(self._join, [table for table in TABLES if table in self._parts]))
                files.append(write_json(self.running / KEY_FIGURES_FILE, key_figures))
                if self._scenario is not None:
                    files.append(self.running / SCENARIO_FILE)
                entries = [{"size": file.stat().st_size, "sha256": sha256_of(file)} for file in files]
                earlier = _earlier_files(self.folder)
            with failures_told(self.folder, "Some files there are new and some old; mend that and run again"):
                complete = run | {"files": {self._move_in(file): entry for file, entry in zip(files, entries, strict=True)}}
                last = self._move_in(write_json(self.running / RUN_FILE, complete))
                for stale in earlier - {*complete["files"], last, *(path.name for path in self.held)}:
                    with suppress(OSError):  # not named by run.json, so no part of the results
                        (self.folder / stale).unlink()
                shutil.rmtree(self.folder / PARTIAL, ignore_errors=True)  # reports of a part of a run that is whole now
                self._clear(is_continued)
        self._files = complete["files"]
        return complete

    def amend(self, run: dict[str, Any], *, is_continued: bool = False) -> None:
        """Replace ``run.json`` after `finish` by one that says more; what `beside_parts` holds stays if that `is_continued`."""
        path, text = self.folder / RUN_FILE, json_text(run | {"files": self._files})
        with uninterrupted(), failures_told(self.folder):
            written = write_or_beside(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))
            if written == path:
                beside(path).unlink(missing_ok=True)  # it would be taken for the newer one
            elif written not in self.beside:
                self.beside.append(written)
            self._clear(is_continued)

    def _clear(self, is_continued: bool) -> None:
        """Remove what served the run, and what later studies would go on from unless they do."""
        running = self.folder / RUNNING
        for path in running.iterdir() if running.is_dir() else ():
            if not (is_continued and path == self.beside_parts):
                shutil.rmtree(path, ignore_errors=True)
        _remove_empty(running)

    def discard(self) -> None:
        """Leave no trace: nothing was computed."""
        shutil.rmtree(self.running, ignore_errors=True)
        for folder in (self.folder / RUNNING, *self._made):
            _remove_empty(folder)

    def keep_unfinished(self, run: dict[str, Any], key_figures: Sequence[dict[str, Any]] = ()) -> Path:
        """Leave the parts where they are, with a note of what they are; return their folder."""
        with failures_told(self.folder):
            write_json(self.running / KEY_FIGURES_FILE, key_figures)
            write_json(self.running / RUN_FILE, self._kind | run)
        return self.running

    def _join(self, table: str) -> Path:
        return write_whole(self.running / f"{table}.parquet", lambda temporary: join_parts(table, self._parts[table], temporary))

    def _move_in(self, file: Path) -> str:
        wanted = self.folder / file.name
        written = move_in(file, wanted)
        if written != wanted:
            self.held.append(wanted)
            self.beside.append(written)
        return written.name


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
        partly = "; what an interrupted run has computed is read with --partial" if (folder / RUNNING).is_dir() else ""
        raise UsageError(f"{folder}: no results of a run are there ({RUN_FILE} is missing){partly}")
    run = read_json(path)
    if run is None or not isinstance(run.get("files"), dict):
        raise UsageError(f"{path}: not what a complete run writes; run the study again")
    for name, entry in run["files"].items():
        file = folder / name
        if not file.is_file() or file.stat().st_size != entry["size"] or sha256_of(file) != entry["sha256"]:
            raise UsageError(f"{file}: not the file that the run wrote; run the study again")
    return run


def written_as(run: dict[str, Any], name: str) -> str:
    """Return under which name the run of ``run.json`` wrote the file `name`."""
    return name if name in run["files"] else beside(Path(name)).name


def table_names(run: dict[str, Any]) -> list[str]:
    """Return the tables that ``run.json`` names, sorted."""
    files = [name for name in run["files"] if name.endswith(".parquet")]
    return sorted(name.removesuffix(".parquet").removesuffix(BESIDE) for name in files)


def find_unfinished(folder: Path) -> Path:
    """Return the folder of the parts that the last unfinished run has left in a folder of results.

    Raises
    ------
    UsageError
        If there are none.
    """
    found = [path for path in (folder / RUNNING).glob("*") if (path / RUN_FILE).is_file()]
    if not found:
        raise UsageError(f"{folder}: no parts of an unfinished run are there; without --partial complete results are read")
    return max(found, key=lambda path: (path.stat().st_mtime, path.name))


def parts_of(running: Path) -> dict[str, list[Path]]:
    """Return the complete parts of an unfinished run by table, in their order, up to the first that is damaged."""
    numbered = [(int(match[2]), match[1], path) for path in running.iterdir() if (match := _PART.fullmatch(path.name))]
    tables: dict[str, list[Path]] = {}
    for _, table, path in itertools.takewhile(lambda part: is_readable(part[2]), sorted(numbered)):
        tables.setdefault(table, []).append(path)
    return tables


def _run_file(folder: Path) -> Path:
    """Return the file that says what a run was; one written beside is the newer one."""
    path = folder / RUN_FILE
    return beside(path) if beside(path).is_file() else path


def _remove_empty(folder: Path) -> None:
    """Remove a folder in which nothing is."""
    if folder.is_dir() and not any(folder.iterdir()):
        folder.rmdir()


def _earlier_files(folder: Path) -> set[str]:
    """Return the names of the files of an earlier run, those written beside included."""
    path = _run_file(folder)
    run = (read_json(path) if path.is_file() else None) or {}
    names = run.get("files", {})
    return {path.name, *(name for name in names if Path(name).name == name)}


def _refuse_foreign(folder: Path, own: tuple[str, str], *, force: bool) -> None:
    """Refuse a folder of anything but the `own` study and kind."""
    if not folder.exists():
        return
    if not folder.is_dir():
        raise UsageError(f"{folder} is a file; name a folder for the results with --out")
    if force:
        return
    for run in _interrupted_runs(folder):
        if told := _other(run, own):
            raise UsageError(f"{folder} holds an interrupted run of {told}; choose --out, or --force")
    path = _run_file(folder)
    if path.is_file():
        if told := _other(read_json(path), own):
            raise UsageError(f"{folder} holds results of {told}; choose --out, or --force")
    elif not all(entry.name in (RUNNING, PARTIAL) or _holds_results(entry) for entry in folder.iterdir()):
        raise UsageError(f"{folder} holds files that are no results of a run; choose another --out, or --force")


def _other(run: dict[str, Any] | None, own: tuple[str, str]) -> str:
    """Return in words of what else a run is than of the `own` study and kind; nothing if it is of these."""
    study, kind = own
    owner = "an unreadable run" if run is None else run.get("study")
    if run is None or owner != study:
        return f"another study ({owner!r}, not {study!r})"
    other = run.get("kind") or ""
    return f"another command ({other or 'run'}, not {kind or 'run'})" if other != kind else ""


def _interrupted_runs(folder: Path) -> Iterator[dict[str, Any]]:
    """Yield what is noted of the interrupted runs that a folder holds."""
    for path in (folder / RUNNING).glob(f"*/{RUN_FILE}"):
        run = read_json(path)
        if run is not None:
            yield run


def _holds_results(entry: Path) -> bool:
    """Return whether something in a folder is a folder of results itself: `journey` writes beside what `run` writes."""
    return (entry / RUNNING).is_dir() or _run_file(entry).is_file()
