"""The folders of a comparison: opened, named, and told apart from what is no result."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from tractionpower.errors import UsageError
from tractionpower.results.kept import SCENARIOS
from tractionpower.results.results import Results
from tractionpower.results.store import RUN_FILE, RUNNING

CASES = ("contingency", "sweep")
"""Kinds of folders that hold many cases."""


@dataclass(frozen=True)
class Variant:
    """A folder of results with the name that it has in the comparison."""

    name: str
    folder: Path
    results: Results

    @property
    def study(self) -> str:
        """Study that the results are of."""
        return str(self.results.run.get("study", ""))

    @property
    def has_cases(self) -> bool:
        """Whether it holds many cases instead of one run."""
        return self.results.run.get("kind") in CASES


def open_variants(texts: Sequence[str | Path], base: str | Path | None = None) -> tuple[Variant, ...]:
    """Open folders named ``DIR`` or ``NAME=DIR``; the `base`, by name or folder, or else the first, stands first.

    Raises
    ------
    UsageError
        With all that is wrong with them.
    """
    named = [_named(text) for text in texts]
    own = _named(base) if base is not None else None
    first = _index_of(own, named) if own is not None else 0
    if own is not None and first is None:
        named, first = [own, *named], 0
    if len(named) < 2:
        raise UsageError("a comparison needs at least two folders of results")
    wrong, opened = [], []
    for name, folder in named:
        try:
            opened.append((name, folder, _opened(folder)))
        except UsageError as error:
            wrong.append(str(error))
    places = [folder.resolve() for _, folder in named]
    wrong += [f"{folder}: named twice" for k, (_, folder) in enumerate(named) if places[k] in places[:k]]
    names = _names([(name, folder) for name, folder in named])
    twice = sorted({name for name in names if names.count(name) > 1})
    wrong += [f"two folders are called {name!r}; name them with NAME=DIR" for name in twice]
    if wrong:
        raise UsageError("; ".join(wrong))
    variants = [Variant(name, folder, results) for name, (_, folder, results) in zip(names, opened, strict=True)]
    lead = variants.pop(first or 0)
    return lead, *variants


def _named(text: str | Path) -> tuple[str, Path]:
    """Return name and folder of ``NAME=DIR``; no name where the text is a folder as it stands."""
    name, equals, folder = str(text).partition("=")
    if isinstance(text, Path) or not equals or not name.strip() or Path(text).is_dir():
        return "", Path(text)
    return name.strip(), Path(folder)


def _index_of(own: tuple[str, Path], named: Sequence[tuple[str, Path]]) -> int | None:
    """Return which of the folders the base is: by its folder, or by the name that it was given."""
    for k, (name, folder) in enumerate(named):
        if folder.resolve() == own[1].resolve() or (not own[0] and name and name == str(own[1])):
            return k
    return None


def _names(named: Sequence[tuple[str, Path]]) -> list[str]:
    """Return the names of the folders: as given, else that of the folder, with the folder above where two are the same."""
    plain = [name or folder.resolve().name or str(folder) for name, folder in named]
    return [
        f"{folder.resolve().parent.name}/{short}" if not name and plain.count(short) > 1 else short
        for short, (name, folder) in zip(plain, named, strict=True)
    ]


def _opened(folder: Path) -> Results:
    if not folder.is_dir():
        raise UsageError(f"{folder}: there is no such folder")
    if (folder / RUNNING).is_dir() and not (folder / RUN_FILE).is_file():
        raise UsageError(f"{folder}: its run was interrupted; run the study to its end, parts of runs are not compared")
    results = Results.open(folder)
    if "journeys" in results.run:
        raise UsageError(f"{folder} holds theoretical journeys, not a run")
    if results.run.get("kind") in ("compare", "measured"):
        raise UsageError(f"{folder} holds a comparison itself; name the folders that it compares")
    if results.run.get("kind") in SCENARIOS:
        raise UsageError(f"{folder} holds results of train dynamics, not of a supply; its key_figures.json sums it up")
    return results
