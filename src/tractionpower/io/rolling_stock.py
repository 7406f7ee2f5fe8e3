"""Reading of the trains, vehicles and couplings that a study, a case or a command names, each once, with all their problems."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Generic, TypeVar

from pydantic import TypeAdapter, ValidationError

from tractionpower.errors import InputError, Problem, UsageError
from tractionpower.io.documents import Reader
from tractionpower.io.problems import Input
from tractionpower.io.provenance import Loc, Mark, path_of
from tractionpower.io.stock_finder import (
    FOLDER,
    StockKind,
    find_rolling_stock,
    not_found,
    shipped_trains,
    shipped_vehicles,
    unknown_stock,
)
from tractionpower.io.text_files import Source, relative_label
from tractionpower.io.wording import shorten, shown
from tractionpower.model.base import Identifier
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.model.vehicle import Part, Train, Vehicle

__all__ = ["RollingStock", "find_rolling_stock", "load_train", "load_vehicle", "shipped_trains", "shipped_vehicles"]

_IDENTIFIER: TypeAdapter[str] = TypeAdapter(Identifier)


def load_vehicle(vehicle: str | Path) -> Vehicle:
    """Return the vehicle in a file or of an id; a path that exists wins.

    Raises
    ------
    InputError
        With all problems of the file.
    UsageError
        If there is neither such a file nor such a vehicle.
    """
    path = _existing(vehicle)
    stock = RollingStock(Reader(Path.cwd()), _study_folder(path))
    if path is None and not stock.has("vehicles", str(vehicle)):
        raise UsageError(unknown_stock(str(vehicle), ("vehicles",)))
    if path is None:
        stock.add_vehicle(str(vehicle))
    else:
        stock.vehicles.read(path, "vehicle", "")
    stock.raise_errors()
    return stock.vehicles.sorted()[0]


def load_train(train: str | Path) -> tuple[Train, tuple[Vehicle, ...]]:
    """Return the train in a file or of an id, and the vehicles that it is made of, sorted by id; a path that exists wins.

    The id or file of a vehicle stands for a train of this one vehicle.

    Raises
    ------
    InputError
        With all problems of the files.
    UsageError
        If there is neither such a file, nor such a train or vehicle.
    """
    path = _existing(train)
    stock = RollingStock(Reader(Path.cwd()), _study_folder(path))
    if path is not None:
        stock.add_file(path)
    elif stock.has("trains", str(train)):
        stock.add_train(str(train))
    elif stock.has("vehicles", str(train)):
        stock.add_vehicle(str(train))
    else:
        raise UsageError(unknown_stock(str(train), ("trains", "vehicles")))
    stock.raise_errors()
    trains, vehicles = stock.trains.sorted(), stock.vehicles.sorted()
    if trains:
        return trains[0], vehicles
    only = vehicles[0]
    return Train(id=only.id, name=only.name, source=only.source, vehicles=(Part(id=only.id),)), vehicles


class RollingStock:
    """The trains, vehicles and couplings that are named by somebody, each read once.

    Parameters
    ----------
    reader
        Reads the files and collects their problems.
    study_folder
        Folder of the study that names them; None if there is no study.
    """

    def __init__(self, reader: Reader, study_folder: Path | None) -> None:
        self._reader, self._folder = reader, study_folder
        self.trains: _Shelf[Train] = _Shelf("trains", Train, reader)
        self.vehicles: _Shelf[Vehicle] = _Shelf("vehicles", Vehicle, reader)
        self.couplings: _Shelf[Coupling] = _Shelf("couplings", Coupling, reader)

    def has(self, kind: StockKind, identifier: str) -> bool:
        """Return whether a file of that id exists."""
        return find_rolling_stock(kind, identifier, self._folder) is not None

    def add_timetable(self, content: Input) -> None:
        """Read the trains and vehicles that the runs and services of a timetable name."""
        for key in ("trains", "services"):
            runs = content.data.get(key)
            for index, run in enumerate(runs if isinstance(runs, list) else ()):
                if not isinstance(run, dict):
                    continue
                train = _identifier(run.get("train"))
                if train is not None:
                    self.add_train(train, content, (key, index, "train"))
                self._add_parts(run, content, (key, index))

    def add_case(self, content: Input) -> None:
        """Read the vehicles and couplings that a case of train dynamics names."""
        self._add_parts(content.data, content, ())
        parts = content.data.get("vehicles")
        owners: list[tuple[Loc, Any]] = [((), content.data)]
        owners += [(("vehicles", index), part) for index, part in enumerate(parts if isinstance(parts, list) else ())]
        for loc, owner in owners:
            coupling = _identifier(owner.get("coupling")) if isinstance(owner, dict) else None
            if coupling is not None:
                self._add(self.couplings, coupling, content, (*loc, "coupling"))

    def add_train(self, identifier: str, namer: Input | None = None, loc: Loc = ()) -> None:
        """Read a train, which the file `namer` names at `loc`, and its vehicles."""
        content = self._add(self.trains, identifier, namer, loc)
        if content is not None:
            self._add_parts(content.data, content, ())

    def add_vehicle(self, identifier: str, namer: Input | None = None, loc: Loc = ()) -> None:
        """Read a vehicle, which the file `namer` names at `loc`."""
        self._add(self.vehicles, identifier, namer, loc)

    def add_file(self, path: Path) -> None:
        """Read a file that holds a train, with its vehicles, or a vehicle."""
        aside = Reader(self._reader.folder)
        glance = aside.read(Source(path, relative_label(path, aside.folder), ""), Train)
        if glance is not None and "vehicles" not in glance.data and {"kind", "mass_t"} & glance.data.keys():
            self.vehicles.read(path, "vehicle", "")
            return
        content = self.trains.read(path, "train", "")
        if content is not None:
            self._add_parts(content.data, content, ())

    def raise_errors(self) -> None:
        """Raise what is wrong, if anything is."""
        if self._reader.has_errors:
            raise InputError(self._reader.problems)

    def _add_parts(self, owner: dict[str, Any], content: Input, loc: Loc) -> None:
        parts = owner.get("vehicles")
        for index, part in enumerate(parts if isinstance(parts, list) else ()):
            vehicle = _identifier(part.get("id")) if isinstance(part, dict) else None
            if vehicle is not None:
                self.add_vehicle(vehicle, content, (*loc, "vehicles", index, "id"))

    def _add(self, shelf: _Shelf[Any], identifier: str, namer: Input | None, loc: Loc) -> Input | None:
        # Returns the content only when it is read for the first time.
        if identifier in shelf.seen:
            return None
        try:
            file = find_rolling_stock(shelf.kind, identifier, self._folder)
        except InputError as error:
            self._reader.problems += error.problems
            shelf.seen.add(identifier)
            return None
        place = namer.mark.find(loc).place if namer is not None else ""
        if file is None:  # told at every place that names it
            path = path_of(namer.root, loc, namer.data) if namer is not None else ""
            self._reader.problems.append(not_found(shelf.kind, identifier, self._folder, path, place))
            return None
        shelf.seen.add(identifier)
        return shelf.read(file, f"{shelf.kind}[{shorten(identifier)}]", place, identifier)


Item = TypeVar("Item", Train, Vehicle, Coupling)


@dataclass(slots=True)
class _Shelf(Generic[Item]):
    # What was read of one kind.
    kind: StockKind
    model: type[Item]
    reader: Reader
    seen: set[str] = field(default_factory=set)
    items: dict[str, Item] = field(default_factory=dict)
    marks: dict[str, Mark] = field(default_factory=dict)

    def read(self, file: Path, root: str, named_at: str, identifier: str | None = None) -> Input | None:
        """Read a file; its id must be `identifier` where one is given."""
        content = self.reader.read(Source(file, relative_label(file, self.reader.folder), root, named_at), self.model)
        if content is None:
            return None
        item = self.reader.validated(self.model, content)
        own = _identifier(content.data.get("id"))
        if identifier is not None and own is not None and own != identifier:
            allowed, place = f"{shown(identifier)}, as the file is called", content.mark.find(("id",)).place
            told = Problem("wrong_id", f"{root}.id", shown(own), allowed, "give both the same name", place=place)
            self.reader.problems.append(told)
        name = identifier or own
        if item is not None and name is not None:
            self.items[name], self.marks[name] = item, content.mark
        return content

    def sorted(self) -> tuple[Item, ...]:
        """Return what was read, by id."""
        return tuple(self.items[name] for name in sorted(self.items))

    def mark(self) -> Mark:
        """Return the files and lines of `sorted`."""
        names = sorted(self.items)
        children: dict[str | int, Mark] = {index: self.marks[name] for index, name in enumerate(names)}
        return Mark(f"{FOLDER}/{self.kind}", 0, children, {name: index for index, name in enumerate(names)})


def _identifier(value: Any) -> str | None:
    try:
        return _IDENTIFIER.validate_python(value)
    except ValidationError:  # told by the check of the file
        return None


def _existing(name: str | Path) -> Path | None:
    try:
        path = Path(name)
        return path.absolute() if str(name).strip() and path.is_file() else None
    except (OSError, ValueError):  # a name that is too long, or holds a NUL
        return None


def _study_folder(file: Path | None) -> Path | None:
    # A file that lies where a study keeps its rolling stock finds its fellows there.
    lies_in_a_study = file is not None and file.parent.parent.name == FOLDER
    return file.parents[2] if file is not None and lies_in_a_study else None
