"""Rotations, joins and splits as links between runs, and as rows of the train tables (`kernels.turns`)."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tractionpower.kernels.train_tables import LEAVE, STAY, TURN, TrainTables
from tractionpower.kernels.wayside import HERE_M
from tractionpower.model.services import DAY_BEFORE
from tractionpower.model.timetable import Timetable


@dataclass(frozen=True, slots=True)
class Link:
    """A run that becomes another one.

    Attributes
    ----------
    path
        Model path of what declares it.
    first, then
        Identifiers of the runs.
    turn_s
        Shortest time from the end of the one to the start of the other [s].
    kind
        ``rotation``, ``join`` or ``split``.
    """

    path: str
    first: str
    then: str
    turn_s: float
    kind: str


def declared_links(timetable: Timetable) -> Iterator[Link]:
    """Yield the links of a timetable as declared."""
    counts = Counter(rotation.id for rotation in timetable.rotations)
    for k, rotation in enumerate(timetable.rotations):
        name = rotation.id if rotation.id and counts[rotation.id] == 1 else k
        for n, (first, then) in enumerate(pairwise(rotation.runs), start=1):
            yield Link(f"timetable.rotations[{name}].runs[{n}]", first, then, rotation.turn_round_s, "rotation")
    for k, join in enumerate(timetable.joins):
        for n, portion in enumerate(join.portions):
            yield Link(f"timetable.joins[{k}].portions[{n}]", portion, join.into, join.coupling_s, "join")
    for k, split in enumerate(timetable.splits):
        for n, portion in enumerate(split.portions):
            yield Link(f"timetable.splits[{k}].portions[{n}]", split.run, portion, split.uncoupling_s, "split")


def links_of(timetable: Timetable, names: Sequence[str]) -> list[Link]:
    """Return the links between the runs `names`, those of the day before included, in the order of the names."""
    known, links = set(names), list(declared_links(timetable))
    links += [Link(item.path, item.first + DAY_BEFORE, item.then + DAY_BEFORE, item.turn_s, item.kind) for item in links]
    kept = [link for link in links if link.first in known and link.then in known]
    return sorted(kept, key=lambda link: (link.first, link.then))


def together(timetable: Timetable, names: Sequence[str]) -> set[tuple[int, int]]:
    """Return which runs stand beside each other as portions of one train, by number, the lower one first."""
    number = {name: k for k, name in enumerate(names)}
    groups: dict[tuple[str, str], list[int]] = {}
    for link in links_of(timetable, names):
        if link.kind != "rotation":
            one, other = (link.then, link.first) if link.kind == "join" else (link.first, link.then)
            groups.setdefault((link.kind, one), []).append(number[other])
    return {(a, b) for group in groups.values() for a in group for b in group if a < b}


def link_turns(tables: TrainTables, names: Sequence[str], timetable: Timetable) -> TrainTables:
    """Return the tables of trains with the links between them; `names` are those of their rows, in rising order.

    A train that another one takes over stays at the end of its run; one that leaves the line there comes back as the other
    when that begins.
    """
    links = links_of(timetable, names)
    if not links:
        return tables
    number = {name: k for k, name in enumerate(names)}
    trains, turns = tables.trains.copy(), np.zeros(len(links), TURN)
    for n, link in enumerate(links):  # sorted: those of a train lie together
        first, then = trains[number[link.first]], trains[number[link.then]]
        turns[n] = number[link.then], link.turn_s
        first["first_turn"] = n - first["turns"]
        first["turns"] += 1
        then["waits"] += 1
        then["takes_over"] |= first["end"] != LEAVE and _stands_at_start(tables, then)
    for link in links:
        first, then = trains[number[link.first]], trains[number[link.then]]
        if then["takes_over"] and first["end"] != LEAVE:
            first["end"] = STAY
    return tables._replace(trains=trains, turns=turns)


def _stands_at_start(tables: TrainTables, train: np.void) -> bool:
    """Tell whether a run begins with a stop, at rest."""
    if train["stops"] == 0 or train["start_mps"] > 0.0:
        return False
    first = tables.stops[train["first_stop"]]
    return bool(first["stops"] and first["at_m"] <= HERE_M)
