"""Sentences that a run of train dynamics records in English, with places for names and numbers."""

from __future__ import annotations

FIGURES = (
    "greatest tension", "greatest compression", "greatest absorbed", "greatest speed", "distance", "greatest acceleration",
    "greatest relative movement", "stopping distance", "stopping time", "braked from", "mean deceleration",
    "traction energy", "electric brake energy", "air brake energy", "resistance energy", "gravity energy", "coupling energy",
    "kinetic energy change", "energy closing error", "steps",
)  # fmt: skip
"""Names of key figures in words."""

DEFINITIONS = (
    "greatest of all couplings and steps",
    "greatest of all couplings and steps: there was none",
    "most work that one coupling has taken in; what its springs hold at the end is part of it",
    "greatest of the first vehicle and all steps, of either direction",
    "how far the first vehicle is at the end from where it started",
    "of greatest magnitude of all vehicles and steps, mean of a step",
    "farthest that a vehicle has moved against the first since the start, of all steps",
    "way of the first vehicle from the brake command to the standstill of the whole train; time of the command",
    "from the brake command to the standstill of the whole train, to the step; time of the command",
    "speed of the first vehicle at the brake command",
    "v²/(2 s) of the speed at the brake command and the stopping distance",
    "kinetic energy with rotating parts, end less start",
    "magnitude of what the ledger leaves over, by the energy put in: traction, kinetic at the start, descent",
    "steps of the method; where a vehicle comes to a stand a step is cut, which counts as two",
)
"""Definitions of key figures."""

PLACES = ("coupling {coupling}", "vehicle {vehicle}", "stop {number}", "{place}, backwards")
"""Where something was found."""

NOTES = (
    "no cycles are counted: {reason}",
    "the energy ledger leaves {share} of the energy put in, more than the {target} asked of {method}: lower tolerance of"
    " {before} to {after}",
    "the energy ledger leaves {share} of the energy put in, more than the {target} asked of {method}: shorten step_s of"
    " {before} s to {after} s",
)
"""Notes of a run."""

OF_STATIONS = (
    "trains that left", "trains still there", "trains that did not come", "highest speed", "waiting time", "mean running time",
    "trains that have run the whole line",
    "trains on the line at the end of the run",
    "trains that the line, or the time, had no room for",
    "highest speed of all rows",
    "time that trains waited for a track or the line ahead",
    "mean time from entering to leaving, stops included",
    "trains still on the line at the end: {count}",
    "trains still on the line at the end: {count} ({names} cannot start)",
    "trains that did not come onto the line: {count}",
)  # fmt: skip
"""Key figures of cases of stations with their definitions, and notes."""

OF_DYNAMICS: tuple[str, ...] = (*FIGURES, *DEFINITIONS, *PLACES, *NOTES, *OF_STATIONS)
"""All of them."""
