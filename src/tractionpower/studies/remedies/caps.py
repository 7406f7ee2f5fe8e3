"""Caps on current or power, of a train or of all trains of a class."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from tractionpower.studies.remedies.candidate import Candidate, steps_within
from tractionpower.studies.remedies.case import Case
from tractionpower.studies.remedies.fleet import Declared, classes_of

FIELDS = {"current_cap": ("max_current_a", "current_a", "current", "A"), "power_cap": ("max_power_kw", "power_kw", "power", "kW")}
"""For each kind: field of the declaration, field of `case.Peak`, word, unit."""


def caps(case: Case, kind: str) -> Iterator[Candidate]:
    """Yield caps of a kind: on each of the trains that draw the most, then on the classes that they belong to."""
    bounds = case.bounds
    if (most := steps_within(100.0 - bounds.lowest_cap_percent, bounds.cap_step_percent)) == 0:
        return
    foremost = case.foremost
    classes = classes_of(case.scenario, case.known.values())
    theirs = [(name, members) for name, members in classes.items() if not set(members).isdisjoint(foremost)]
    for name, members in [*((item.words, (item,)) for item in foremost), *theirs[: bounds.subjects]]:
        greatest = [(item, peak) for item in members if (peak := greatest_of(case, kind, item)) > 0.0]
        if greatest:
            subject = members[0].name if len(members) == 1 else name
            yield _candidate(case, kind, (subject, name), greatest, most)


def greatest_of(case: Case, kind: str, item: Declared) -> float:
    """Return the greatest current [A] or power [kW] that a train or a service has in the run, and may have."""
    attribute, peak_name, *_ = FIELDS[kind]
    peaks = [float(getattr(case.peaks[run.id], peak_name)) for run in item.runs if run.id in case.peaks]
    cap = getattr(item.trip, attribute)
    return min(max(peaks, default=0.0), float("inf") if cap is None else cap)


def cap_changes(kind: str, greatest: Sequence[tuple[Declared, float]], percent: float) -> tuple[str, ...]:
    """Return the changes by path that hold trains `percent` below their greatest current or power."""
    attribute = FIELDS[kind][0]
    return tuple(f"{item.path}.{attribute}={peak * (1.0 - percent / 100.0):.0f}" for item, peak in greatest)


def _candidate(case: Case, kind: str, names: tuple[str, str], greatest: Sequence[tuple[Declared, float]], most: int) -> Candidate:
    _, _, word, unit = FIELDS[kind]
    subject, words = names
    runs = sum(len(item.runs) for item, _ in greatest)
    costs = case.bounds.costs
    cost = costs.current_cap if kind == "current_cap" else costs.power_cap

    def tell(size: float) -> str:
        values = sorted({f"{peak * (1.0 - size / 100.0):.0f} {unit}" for _, peak in greatest})
        least = f" to {values[0]}" if len(values) == 1 else ""
        return f"{words[0].upper() + words[1:]}: {word} capped{least}, {size:g} % below the greatest in the run."

    return Candidate(
        kind, subject, "%", case.bounds.cap_step_percent, most,
        lambda size: cap_changes(kind, greatest, size), tell, lambda size: cost * size * runs,
    )  # fmt: skip
