"""The sheets of assumptions and of defaults of a run of train dynamics."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.dynamics.engines import powered
from tractionpower.reporting.texts import mark, recorded, tr
from tractionpower.reporting.workbook.common.assumption import Assumption, figure, names
from tractionpower.reporting.workbook.common.assumptions import COLUMNS, DEFAULTS, defaults_of
from tractionpower.reporting.workbook.dynamics.chain_facts import ChainFacts, facts_of
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import KNOWN_AS

METHODS = {
    "symplectic": mark("Symplectic Euler: velocities first, then places, with a fixed step of {step} s."),
    "rk4": mark("Classical Runge-Kutta of fourth order with a fixed step of {step} s."),
    "euler": mark("Explicit Euler with a fixed step of {step} s; for comparison, it feeds energy into vibrations."),
    "variable": mark("Dormand-Prince with a step by tolerance {tolerance}, {step} s at most."),
}
"""Methods of integration in words."""

ZOBORY = mark("Zobory and Bekefi 1994")
ARSHAD = mark("Arshad et al.")


def add(book: Book) -> None:
    """Add the sheets: the numbered assumptions, and the defaults of the program that are in use."""
    facts = facts_of(book)
    groups = (
        (mark("method"), [*_method(facts)]),
        (mark("train"), [*_train(facts)]),
        (mark("brakes and traction"), [*_brakes(facts)]),
        (mark("track"), [*_track(facts)]),
        (mark("sources of inputs"), [*_sources(facts)]),
        (mark("notes of the run"), [Assumption(recorded(str(n)), tr("this run"), tr("told by the program"))
                                    for n in facts.run.get("notes") or ()]),
        (mark("the study's own"), [Assumption(text, "", tr("by the author of the study")) for text in book.report.assumptions]),
    )  # fmt: skip
    rows = [(tr(title), *row) for title, found in groups for row in found]
    page = book.page("Assumptions", "Assumptions of this run")
    page.note(
        "What the results rest on beside the inputs as given. Every line holds in this run; what the run does not use is left"
        " out."
        " Numbers that the study leaves to the program are on sheet Defaults."
    )
    page.table(COLUMNS, [(k, *row) for k, row in enumerate(rows, 1)], frozen=True)
    case = facts.scenario.case
    parts, drives = facts.data.parts, powered(facts.scenario)
    driven = [part for part, is_powered in zip(parts, drives, strict=True) if is_powered]
    defaults = [
        row
        for title, found in (
            ("run", [case.run]), ("air_brake", [case.air_brake]), ("track", [case.track]),
            ("traction", [part.traction for part in driven if part.traction is not None]),
            ("electric_brake", [part.electric_brake for part in driven if part.electric_brake is not None]),
            ("brake", [part.brake for part in parts if part.brake is not None]), ("couplings", facts.scenario.couplings),
            ("vehicles", facts.scenario.vehicles),
        )
        for row in defaults_of(title, found)
    ]  # fmt: skip
    if defaults:
        page = book.page("Defaults", "Defaults of the program that act in this run")
        page.note(
            "Numbers that the study leaves to the program, or gives as it would take them. Held by: how many have this value."
        )
        page.table(DEFAULTS, defaults, frozen=True)


def _method(facts: ChainFacts) -> Iterator[Assumption]:
    case = facts.scenario.case
    every = tr("whole run")
    words = tr(METHODS[case.run.method], step=figure(case.run.step_s), tolerance=figure(case.run.tolerance))
    yield Assumption(words, every, tr("of the case"))
    yield Assumption(tr("Lags of efforts, brake pipe and cylinders are integrated exactly, not step by step."), every, tr(ZOBORY))
    yield Assumption(
        tr("Rows are recorded every {seconds} s; extremes, cycles and distributions take every step.",
           seconds=figure(case.run.record_every_s)),
        every, tr("of the case"),
    )  # fmt: skip


def _train(facts: ChainFacts) -> Iterator[Assumption]:
    train = tr("all vehicles")
    yield Assumption(
        tr("Each vehicle is one mass that moves along the track only; rotating parts add to its inertia, not to its weight."),
        train, tr(ZOBORY),
    )  # fmt: skip
    for kind in facts.kinds:
        known = "; ".join(part for part in (kind.source, recorded(KNOWN_AS.get(kind.status, kind.status))) if part)
        text = tr("Coupling {name}: draw gear and buffers of both vehicles as one, with a slack of {slack} mm.",
                  name=kind.id, slack=figure(kind.slack_mm))  # fmt: skip
        yield Assumption(text, tr("couplings"), known)
        for gear in (kind.draw, kind.buff):
            if gear is not None and gear.wedge is not None:
                text = tr("Coupling {name}: friction of its wedge falls linearly until {speed} m/s and is constant beyond.",
                          name=kind.id, speed=figure(gear.wedge.blending_mps))  # fmt: skip
                yield Assumption(text, tr("couplings"), tr("Arshad et al., equation 1; the speed is assumed"))
                break
    yield Assumption(
        tr("At a stand resistance and brakes hold a vehicle up to what they can give, and never push it."), train,
        tr("Zobory and Bekefi 1994, equations 1 and 6"),
    )  # fmt: skip
    if facts.scenario.case.unified_resistance == "paper":
        text = tr("Adhesion caps the sum of all resistances and brakes, as printed; air and bearings do not pass through it.")
    else:
        text = tr("Adhesion caps the air brake alone, not running resistance.")
    yield Assumption(text, train, tr("Zobory and Bekefi 1994, equation 6; adhesion after Curtius and Kniffler, secondary"))


def _brakes(facts: ChainFacts) -> Iterator[Assumption]:
    case, parts = facts.scenario.case, facts.data.parts
    air = case.air_brake
    braked = [part for part in parts if part.brake is not None]
    if braked:
        where = tr("brake pipe")
        yield Assumption(
            tr("A change of the brake pipe travels at {speed} m/s and arrives at every vehicle with the same exponential course.",
               speed=figure(air.propagation_mps)),
            where, tr("Zobory and Bekefi 1994, equation 3"),
        )  # fmt: skip
        yield Assumption(
            tr("A cylinder gets {gain} times the reduction of the pipe, {pressure} bar at most.", gain=figure(round(air.gain, 4)),
               pressure=figure(air.cylinder_pressure_bar)),
            where, tr(ZOBORY),
        )  # fmt: skip
    laws = {part.brake.friction.law for part in braked if part.brake is not None}
    if "karwatzki" in laws:
        yield Assumption(tr("Friction of blocks over speed and force after Karwatzki."), tr("brakes"), tr("recalled"))
    driven = [part for part, drives in zip(parts, powered(facts.scenario), strict=True) if drives]
    if driven:
        yield Assumption(
            tr("Tractive effort of a level is the lesser of its effort and its power over speed, unless points are given."),
            names(part.id for part in driven), tr("of the case"),
        )  # fmt: skip
    yield Assumption(
        tr("The supply is not computed: traction has the power of its level at all times."), tr("powered vehicles"),
        tr("method of the program, docs/model.md"),
    )  # fmt: skip


def _track(facts: ChainFacts) -> Iterator[Assumption]:
    case = facts.scenario.case
    track = case.track
    where = tr("track")
    if case.grade == "train":
        yield Assumption(tr("The gradient is the mean under the whole train."), where, tr("Arshad et al., equation 11"))
    else:
        yield Assumption(tr("The gradient is the one under the middle of each vehicle."), where, tr(ZOBORY))
    if track.rounding_radius_m > 0.0 and track.gradients:
        text = tr("Between gradients the track is rounded with {radius} m.", radius=figure(track.rounding_radius_m))
        yield Assumption(text, where, tr("Zobory and Bekefi 1994, section 3"))
    if track.curves and track.curve_resistance is None:
        text = tr("Curve resistance after Roeckl: 650/(R - 55) N/kN from 300 m on, 500/(R - 30) below.")
        yield Assumption(text, tr("curves"), tr("secondary source"))
    if track.curves and not track.transitions:
        yield Assumption(tr("Curves have no transitions: their resistance begins at once."), tr("curves"), tr("of the case"))


def _sources(facts: ChainFacts) -> Iterator[Assumption]:
    if facts.scenario.case.source:
        yield Assumption(facts.scenario.case.source, tr("case"), tr("source of the case"))
    for vehicle in facts.scenario.vehicles:
        if vehicle.source:
            yield Assumption(vehicle.source, tr("vehicle {id}", id=vehicle.id), tr("source of the vehicle"))
