"""The sheet of what a reader must not take from the figures, since the model does not cover it."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.frame.book import Book
from tractionpower.reporting.workbook.frame.facts import Facts
from tractionpower.reporting.workbook.frame.page import Column

Row = tuple[str, str, str]

COLUMNS = (
    Column("no.", "0"),
    Column("subject", widest=34),
    Column("not covered", "beside", widest=80),
    Column("what follows for the reader", "beside", widest=70),
)


def add(book: Book) -> None:
    """Add the sheet."""
    page = book.page("Not covered", "What the model does not cover")
    page.note("No figure of this workbook tells anything about what stands here; where it matters it needs a study of its own.")
    rows = [*_electric(), *_equipment(book.facts), *_earth(book.facts), *_trains(book.facts)]
    page.table(COLUMNS, [(number, *row) for number, row in enumerate(rows, 1)], frozen=True)


def _electric() -> Iterator[Row]:
    yield (
        tr("Harmonics"),
        tr("Ripple and harmonics of rectifiers, harmonic currents of drives, and what they do to the feeding grid."),
        tr("Voltages and currents are means of a step, without ripple; interference limits need a harmonic study."),
    )
    yield (
        tr("Electromagnetic compatibility"),
        tr("Magnetic fields, induced voltages, and interference with signalling and telecommunication."),
        tr("Nothing here shows compatibility with track circuits or axle counters."),
    )
    yield (
        tr("Transients"),
        tr("Surges, arcs, switching and breaker operation within a step; inductances and capacitances."),
        tr("Each step is a steady state; a peak shorter than a step shows only in its mean."),
    )
    yield (
        tr("Stability of input filters"),
        tr("Oscillation of the filters of inverter drives with the line at constant power."),
        tr("A voltage that is high enough here may still be unstable; the vehicle's supplier has to show it."),
    )
    yield (
        tr("Short circuits"),
        tr("Fault currents, and whether breakers tell a remote fault from the load."),
        tr("Trips here are those of load currents above a setting."),
    )


def _equipment(facts: Facts) -> Iterator[Row]:
    supply = facts.scenario.supply
    shared = any(station.grid_resistance_ohm > 0.0 for station in supply.substations)
    if shared:
        told = tr(
            "The grid is a constant voltage behind a constant resistance at each substation; substations do not load each other."
        )
    else:
        told = tr("The grid is a constant voltage at each substation, whatever is taken from it there or elsewhere.")
    yield (
        tr("Feeding grid"),
        f"{told} {tr('Tap changers, flicker and unbalance are left out.')}",
        tr("Where substations share a weak grid, their voltages sag together more than here."),
    )
    folders = (facts.run.get("compare") or {}).get("folders", ())
    if {facts.run.get("kind"), *(entry["kind"] for entry in folders)} & {"size", "contingency", "sweep"}:
        yield (
            tr("Temperatures"),
            tr("Temperatures over time of transformers, rectifiers, cables and wires: resistances do not follow them."),
            tr("Ratings compare root mean squares over windows with what is permitted; they are no thermal simulation."),
        )
    else:
        yield (
            tr("Temperatures and ratings"),
            tr("Temperatures of equipment, and whether it bears its currents: a run tells currents and judges none of them."),
            tr("Command size holds the currents against ratings and duty classes."),
        )
    yield (
        tr("Ageing and faults"),
        tr("Wear beyond what the inputs give, loose joints, broken bonds or strands, failures on the way."),
        tr("Outages are covered where they are declared: by switch events, or by command contingency."),
    )


def _earth(facts: Facts) -> Iterator[Row]:
    if facts.run.get("return_circuit"):
        yield (
            tr("Touch voltage and earth"),
            tr("Footing resistance, body impedance, potential of the soil near the rails, reinforcement of structures."),
            tr("The rail potential stands for the touch voltage, of which it is the upper bound."),
        )
        yield (
            tr("Corrosion"),
            tr("Where the stray current flows in the ground, and which structures it corrodes."),
            tr("Told is what leaves the rails for each metre, held against what needs no further study."),
        )
    else:
        yield (
            tr("Rail potentials and stray currents"),
            tr("The study gives neither leakage nor earthing, so rails have no potential against earth."),
            tr("Touch voltages and stray currents are not judged; leakage_s_per_km of the return circuit makes them told."),
        )


def _trains(facts: Facts) -> Iterator[Row]:
    if not facts.scenario.runs:
        return
    yield (
        tr("Signals and other trains"),
        tr("Trains do not see each other, are held by no signal, and may overlap; overlaps are counted on the cover."),
        tr("Delays do not spread from train to train over the line, only by turn-rounds, joins and splits of the timetable."),
    )
    yield (
        tr("Forces within a train"),
        tr("Couplers, air brakes, several kinds of powered vehicles in a train, more than one pantograph."),
        tr("A train is one mass, gradients act under its length, and its current is taken at its front."),
    )
    yield (
        tr("Wheel and rail"),
        tr("Slip beyond the adhesion limit, wind, higher resistance at the moment of starting, weather."),
        tr("Wet or icy rails need another adhesion in the vehicle files."),
    )
    yield (
        tr("On board"),
        tr("Batteries that keep auxiliaries alive without a voltage, energy storage, thermostats of heating."),
        tr("Auxiliaries take their power throughout, less below U_min2 and at the limit of current at standstill."),
    )
