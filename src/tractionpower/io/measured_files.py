"""Reading of the map of a measured file, with the line of each of its keys."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from tractionpower.errors import InputError
from tractionpower.io.documents import Reader
from tractionpower.io.provenance import Mark
from tractionpower.io.text_files import Source
from tractionpower.io.wording import printable
from tractionpower.model.measured import MeasuredMap


@dataclass(frozen=True, slots=True)
class MapFile:
    """A map as read, and where its keys stand."""

    map: MeasuredMap
    mark: Mark

    def place(self, *loc: str | int) -> str:
        """Return file and line of a key, such as ``series, 0, of``."""
        return self.mark.find(loc).place


def read_map(path: Path) -> MapFile:
    """Read the map of a measured file.

    Raises
    ------
    InputError
        With all problems of the map.
    """
    reader = Reader(path.parent)
    content = reader.read(Source(path, printable(path.name), ""), MeasuredMap)
    read = reader.validated(MeasuredMap, content) if content is not None else None
    if read is None or content is None or reader.has_errors:
        raise InputError(reader.problems)
    return MapFile(read, content.mark)
