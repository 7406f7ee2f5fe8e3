"""Files that are whole or not there, whatever happens while they are written; and what the system says, in words that help."""

from __future__ import annotations

import errno
import hashlib
import json
import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from tractionpower.errors import OutputError

BESIDE = ".new"
"""Before the suffix of a file that was written beside one that another program holds open."""

_FULL = {errno.ENOSPC, getattr(errno, "EDQUOT", errno.ENOSPC)}
_FORBIDDEN = {errno.EACCES, errno.EPERM, errno.EROFS}


def write_whole(path: Path, write: Callable[[Path], Any]) -> Path:
    """Let `write` fill a file that gets its name `path` when it is complete."""
    temporary = path.with_suffix(".tmp")
    try:
        write(temporary)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)
    return path


def write_or_beside(path: Path, write: Callable[[Path], Any]) -> Path:
    """Let `write` fill a file and return its path: `path`, or one beside it where another program holds `path` open."""
    temporary = path.with_suffix(".tmp")
    try:
        write(temporary)
        return move_in(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)


def move_in(file: Path, target: Path) -> Path:
    """Give a complete file its name, or one beside where another program holds that file open; return which."""
    try:
        file.replace(target)
    except PermissionError:  # Windows: another program holds the file that would be replaced
        target = beside(target)
        file.replace(target)
    return target


def write_text(path: Path, text: str) -> Path:
    """Write a text file in UTF-8."""
    return write_whole(path, lambda temporary: temporary.write_text(text, encoding="utf-8"))


def write_json(path: Path, content: Any) -> Path:
    """Write `content` as JSON for people and programs."""
    return write_text(path, json_text(content))


def json_text(content: Any) -> str:
    """Return `content` as JSON for people and programs."""
    return json.dumps(content, indent=1, ensure_ascii=False)


def read_json(path: Path) -> dict[str, Any] | None:
    """Return the mapping that a JSON file holds, or None if it holds none."""
    try:
        content = json.loads(path.read_text(encoding="utf-8"))
    except ValueError:
        return None
    return content if isinstance(content, dict) else None


def sha256_of(path: Path) -> str:
    """Return the SHA-256 of a file."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def beside(path: Path) -> Path:
    """Return the name of a file that is written beside `path`.

    >>> beside(Path("report.xlsx")).name
    'report.new.xlsx'
    """
    return path.with_name(f"{path.stem}{BESIDE}{path.suffix}")


def is_beside(path: Path) -> bool:
    """Return whether a file has the name of one that is written beside another.

    >>> is_beside(Path("report.new.xlsx")), is_beside(Path("report.xlsx"))
    (True, False)
    """
    return path.stem.endswith(BESIDE)


@contextmanager
def uninterrupted() -> Iterator[None]:
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
def failures_told(folder: Path, harm: str = "Earlier results there are unharmed", what: str = "results") -> Iterator[None]:
    """Turn what the operating system says into an `OutputError` that helps.

    Parameters
    ----------
    folder
        Where `what` is written.
    harm
        What became of the files there.
    what
        What cannot be written then.
    """
    try:
        yield
    except OSError as error:
        raise OutputError(f"{what} cannot be written into {folder}: {reason_of(error)}. {harm}") from error


def reason_of(error: OSError) -> str:
    """Return why something cannot be written, and what helps."""
    if error.errno in _FULL:
        return "the disk is full; make room and run again"
    if error.errno in _FORBIDDEN:
        return "no permission to write; choose another folder with --out"
    return os.strerror(error.errno) if error.errno else str(error)
