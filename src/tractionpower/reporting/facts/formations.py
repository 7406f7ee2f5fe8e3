"""The kinds of trains of a run: by their train, or by the vehicles that they are made of."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence

from tractionpower.model.timetable import TrainRun
from tractionpower.model.vehicle import Train
from tractionpower.movement.compile import train_of


def kind_of(run: TrainRun) -> str:
    """Return the train of a run, or the vehicles that it is made of, from the front."""
    if run.train is not None:
        return run.train
    return " + ".join(part.id if part.count == 1 else f"{part.count} x {part.id}" for part in run.vehicles)


def kinds_of_trains(runs: Iterable[TrainRun], trains: Sequence[Train]) -> dict[str, Train]:
    """Return the trains of some runs by name, each kind once, those of most runs first.

    Trains of the same vehicles that are loaded in another way are kinds of their own, told apart by a number.
    """
    counts: Counter[str] = Counter()
    found: dict[str, tuple[str, Train]] = {}
    for run in runs:
        key = repr((run.train, [part.model_dump() for part in run.vehicles]))
        counts[key] += 1
        if key not in found:
            found[key] = (kind_of(run), train_of(run, trains))
    named: dict[str, Train] = {}
    for key in sorted(counts, key=lambda key: (-counts[key], key)):
        name, train = found[key]
        same = sum(each == name or each.startswith(f"{name} (") for each in named)
        named[f"{name} ({same + 1})" if same else name] = train
    return named
