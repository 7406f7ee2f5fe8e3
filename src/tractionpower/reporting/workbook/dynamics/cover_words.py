"""What the cover of train dynamics tells in sentences: what was computed, what was found, how far to trust it."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from tractionpower.reporting.facts.chain_stops import Stop, stops_of
from tractionpower.reporting.facts.measures import METRIC
from tractionpower.reporting.texts import decimal, mark, number, tr, trn
from tractionpower.reporting.workbook.common.cover_texts import Said, notes_of
from tractionpower.reporting.workbook.dynamics.assumed import METHODS
from tractionpower.reporting.workbook.dynamics.chain_facts import ChainFacts

MOST_STOPS = 4
"""Stops that the cover tells."""

GREATEST = {
    "tension": mark("Greatest tension {force} in coupling {name} at {time} s"),
    "compression": mark("greatest compression {force} in coupling {name} at {time} s"),
}


def head(facts: ChainFacts) -> Iterator[Said]:
    """Tell what was computed."""
    case = facts.scenario.case
    parts = [(part, facts.scenario.vehicle(part.id)) for part in facts.data.parts]
    mass = sum(vehicle.mass_t + vehicle.load_t * part.load_percent / 100.0 for part, vehicle in parts)
    length = sum(vehicle.length_m for _, vehicle in parts)
    vehicles = trn("{count} vehicle", "{count} vehicles", len(parts))
    train = tr("{vehicles}, {mass} t, {length} m", vehicles=vehicles, mass=number(mass), length=number(length))
    yield tr("Train"), f"{train}.", "wrapped"
    end = float(facts.run.get("end_s") or case.run.duration_s)
    method = tr(METHODS[case.run.method], step=number(case.run.step_s, 6), tolerance=decimal(f"{case.run.tolerance:g}"))
    yield tr("What was computed"), f"{tr('{seconds} s of the journey.', seconds=number(end, 2))} {method}", "wrapped"
    units = facts.data.units
    if units is not METRIC:
        shown = {key: (METRIC[key].unit, units[key].unit) for key in ("speed", "force", "deflection", "pressure")}
        text = tr(
            "Tables and charts of this workbook: {metric}. The case asks for {own}: so are the figures and the distributions,"
            " and key figures and extremes are told in both.",
            metric=", ".join(one for one, _ in shown.values()), own=", ".join(other for _, other in shown.values()),
        )  # fmt: skip
        yield tr("Units"), text, "wrapped"
    if case.source:
        yield tr("Case"), case.source, "wrapped"


def _told(facts: ChainFacts, quantity: str, value: float, digits: int = 1) -> str:
    """Return a value in the unit of the case, with that of the tables behind it where this is another."""
    plain = f"{number(value, digits)} {METRIC[quantity].unit}"
    own = facts.data.units[quantity]
    return plain if own is METRIC[quantity] else f"{number(value * own.per, own.digits)} {own.unit} ({plain})"


def found(facts: ChainFacts) -> Iterator[Said]:
    """Tell what was found beside the limits."""
    extremes = facts.data.extremes
    told = []
    for side, words in GREATEST.items():
        forces = facts.data.greatest(side) if len(extremes) else np.zeros(0)
        if len(forces) and np.nanmax(forces) > 0.0:
            k = int(np.nanargmax(forces))
            at = number(float(extremes[f"{side}_at_s"].iloc[k]), 2)
            told.append(tr(words, force=_told(facts, "force", forces[k]), name=facts.data.couplings[k], time=at))
    if told:
        text = "; ".join(told)
        yield tr("Couplings"), f"{text[:1].upper()}{text[1:]}.", "neutral"
    stops = stops_of(facts.results)
    for stop in stops[:MOST_STOPS]:
        yield tr("Stop") if stop.to_m >= stop.from_m else tr("Stop, backwards"), _stop_told(facts, stop), "neutral"
    if len(stops) > MOST_STOPS:
        yield "", tr("and {more} more", more=len(stops) - MOST_STOPS), "wrapped"


def _stop_told(facts: ChainFacts, stop: Stop) -> str:
    far, speed = _told(facts, "distance", stop.distance_m), _told(facts, "speed", stop.speed_kmh)
    seconds, since = number(stop.time_s), number(stop.from_s, 2)
    if not math.isfinite(stop.deceleration_mps2):
        return tr(
            "{distance} in {seconds} s from {speed}, brake command at {time} s.",
            distance=far, seconds=seconds, speed=speed, time=since,
        )  # fmt: skip
    return tr(
        "{distance} in {seconds} s from {speed}, brake command at {time} s, mean deceleration {rate}.",
        distance=far, seconds=seconds, speed=speed, time=since,
        rate=_told(facts, "acceleration", stop.deceleration_mps2, 3),
    )  # fmt: skip


def trust(facts: ChainFacts) -> Iterator[Said]:
    """Tell how the run ended, whether its ledger closes, what was not shown."""
    run = facts.run
    status, steps = str(run.get("status", "")), int(run.get("steps") or 0)
    if status == "complete":
        yield tr("Status of the run"), trn("Complete: {count} step.", "Complete: {count} steps.", steps), "good"
    elif status == "interrupted":
        yield (
            tr("Status of the run"),
            tr("Interrupted after {steps} steps: what follows is a part of the run.", steps=steps),
            "bad",
        )
    else:
        yield tr("Status of the run"), tr("Flagged: the energy ledger does not close."), "bad"
    ledger = (run.get("ledgers") or {}).get("energy")
    if ledger:
        share = decimal(f"{100.0 * float(ledger.get('gap_share') or 0.0):.2g}")
        words = tr("Closes") if ledger.get("closes") else tr("Does not close")
        limit = float(ledger.get("limit_share") or 0.0)
        if limit:
            text = tr("{word}: gap {share} % of the energy that was put in, limit {limit} %.", word=words, share=share,
                      limit=decimal(f"{100.0 * limit:.2g}"))  # fmt: skip
        else:
            text = tr("{word}: gap {share} % of the energy that was put in.", word=words, share=share)
        yield tr("Energy ledger"), text, "good" if ledger.get("closes") else "bad"
    yield (
        tr("Proof"),
        tr("No agreement with a benchmark and no certification is claimed; sheet Not covered tells what the model leaves out."),
        "wrapped",
    )
    yield from notes_of(run.get("notes") or [])
