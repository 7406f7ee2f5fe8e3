"""What an importer gives back: files to be written, and what it has to say about them."""

from __future__ import annotations

from dataclasses import dataclass, field

from tractionpower.errors import Problem


@dataclass(slots=True)
class Notes:
    """What an importer tells; nothing is dropped or made up in silence.

    Attributes
    ----------
    read
        What was taken over, with counts.
    assumed
        What the source does not say and was assumed, with the value.
    repaired
        What was wrong and mended, only where repair was asked for.
    ignored
        What was left out, and why.
    problems
        What keeps the source from being imported (errors), or is doubtful (warnings).
    """

    read: list[str] = field(default_factory=list)
    assumed: list[str] = field(default_factory=list)
    repaired: list[str] = field(default_factory=list)
    ignored: list[str] = field(default_factory=list)
    problems: list[Problem] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Imported:
    """Files of a study by their names below its folder, and the notes; no files where there are errors."""

    texts: dict[str, str]
    notes: Notes
