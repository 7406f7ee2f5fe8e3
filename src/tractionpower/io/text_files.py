"""Reading and writing whole text files, with every way it can fail told as a problem."""

from __future__ import annotations

import os
import shutil
import stat
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from tractionpower.errors import InputError, OutputError, Problem
from tractionpower.io.wording import printable

MEGABYTE = 1_000_000


@dataclass(frozen=True, slots=True)
class Source:
    """A file to read.

    Attributes
    ----------
    file
        Where it is.
    label
        How messages call it: relative to the study's folder.
    root
        Model path of its content, for example ``line`` or ``line.gradients``.
    named_at
        Place that names the file, for example ``study.yaml:3``; blamed when the file is missing.
    """

    file: Path
    label: str
    root: str
    named_at: str = ""

    def problem(self, code: str, found: str, allowed: str = "", remedy: str = "", line: int = 0) -> Problem:
        """Return a problem of this file as a whole or of one of its lines."""
        place = f"{self.label}:{line}" if line else self.label
        return Problem(code, self.root, found, allowed, remedy, place=place)

    def fail(self, code: str, found: str, allowed: str = "", remedy: str = "", line: int = 0) -> InputError:
        """Return the exception with one problem of this file."""
        return InputError([self.problem(code, found, allowed, remedy, line)])


def relative_label(file: Path, folder: Path) -> str:
    """Return the name of `file` as seen from `folder`, printable and with forward slashes."""
    try:
        return printable(Path(os.path.relpath(file, folder)).as_posix())
    except ValueError:  # another drive on Windows
        return printable(str(file))


def read_text(source: Source, limit_mb: int, encoding: str = "utf-8") -> str:
    """Return the text of a file in UTF-8, or in another `encoding` (a byte order mark is dropped).

    Raises
    ------
    InputError
        If the file is missing, a folder, not a plain file, larger than `limit_mb` megabytes, not readable or of another
        encoding.
    """
    try:
        _refuse_by_status(source, limit_mb)
        raw = source.file.read_bytes()
    except (FileNotFoundError, NotADirectoryError):
        problem = Problem(
            "missing_file",
            source.root,
            f"there is no file {source.label}",
            remedy="mend the name or add the file",
            place=source.named_at or source.label,
        )
        raise InputError([problem]) from None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        reason = getattr(error, "strerror", None) or str(error)
        raise source.fail("unreadable_file", f"the file cannot be read: {printable(reason)}") from None
    return _decode(source, raw, encoding)


def _refuse_by_status(source: Source, limit_mb: int) -> None:
    status = source.file.stat()
    if stat.S_ISDIR(status.st_mode):
        raise source.fail("not_a_file", "a folder", "a file")
    if not stat.S_ISREG(status.st_mode):
        raise source.fail("not_a_file", "a device or a pipe", "a file")
    if status.st_size > limit_mb * MEGABYTE:
        size = status.st_size / MEGABYTE
        remedy = "is it the right file? results and measurements are no input"
        raise source.fail("file_too_large", f"the file has {size:.1f} MB", f"at most {limit_mb} MB", remedy)


def _decode(source: Source, raw: bytes, encoding: str) -> str:
    try:
        return raw.decode("utf-8-sig" if encoding == "utf-8" else encoding)
    except UnicodeDecodeError as error:
        line = raw.count(b"\n", 0, error.start) + 1
        if encoding != "utf-8":
            found = f"the byte 0x{raw[error.start]:02x} is not {encoding}"
            raise source.fail("not_decoded", found, encoding, line=line) from None
        found = f"the byte 0x{raw[error.start]:02x} is not UTF-8"
        raise source.fail("not_utf8", found, "UTF-8", "save the file as UTF-8 text", line) from None


def write_files(folder: Path, texts: Mapping[str, str]) -> None:
    """Write text files into `folder` by their relative names: first all aside, then moved in one by one, in order.

    Folders that are missing are made.

    Raises
    ------
    OutputError
        If a file cannot be written; nothing half-written is left.
    """
    aside: Path | None = None
    try:
        folder.mkdir(parents=True, exist_ok=True)
        aside = Path(tempfile.mkdtemp(prefix=".writing-", dir=folder))
        for name, text in texts.items():
            (aside / name).parent.mkdir(parents=True, exist_ok=True)
            (aside / name).write_text(text, encoding="utf-8", newline="\n")
        for name in texts:
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (aside / name).replace(folder / name)
    except OSError as error:
        raise OutputError(f"cannot write into {printable(str(folder))}: {error.strerror or error}") from error
    finally:
        if aside is not None:
            shutil.rmtree(aside, ignore_errors=True)
