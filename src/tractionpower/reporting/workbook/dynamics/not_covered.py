"""The sheet of what a reader must not take from the figures of train dynamics, since the model does not cover it."""

from __future__ import annotations

from collections.abc import Iterator

from tractionpower.reporting.texts import tr
from tractionpower.reporting.workbook.common.not_covered import COLUMNS, Row
from tractionpower.reporting.workbook.frame.book import Book


def add(book: Book) -> None:
    """Add the sheet."""
    page = book.page("Not covered", "What the model does not cover")
    page.note("No figure of this workbook tells anything about what stands here; where it matters it needs a study of its own.")
    rows = [*_proof(), *_mechanics(), *_brakes()]
    page.table(COLUMNS, [(number, *row) for number, row in enumerate(rows, 1)], frozen=True)


def _proof() -> Iterator[Row]:
    yield (
        tr("Benchmark"),
        tr(
            "Agreement with the International Benchmarking of Longitudinal Train Dynamics Simulators: its inputs were not"
            " at hand."
        ),
        tr("The equations are shown by closed forms and ledgers, not by that benchmark."),
    )
    yield (
        tr("Certification"),
        tr(
            "Any certification or approval, of UIC or others: UIC Code 421, EN 15839 and the approval of TrainDy do not"
            " reach here."
        ),
        tr("Forces here do not replace the proof that a composition of trains is permitted."),
    )
    yield (
        tr("Measurements"),
        tr("A validation against forces, pressures or tachographs that were measured on this train."),
        tr("Where forces decide, compare with a measurement or a train of the same kind."),
    )


def _mechanics() -> Iterator[Row]:
    yield (
        tr("Lateral and vertical motion"),
        tr("Lateral forces of compressed couplings in curves, derailment, lifting, wheel loads."),
        tr("A compression below its limit says nothing of other curves or of empty wagons between loaded ones."),
    )
    yield (
        tr("Wear and failure of couplings"),
        tr("Temperature, wear and scatter of draft gears and buffers; broken couplings, uncoupling on the way."),
        tr("Gears are as given for the whole run; the index of damage compares couplings and is no life."),
    )
    yield (
        tr("Loads that move"),
        tr("Liquids, loads that slide, elasticity of the car bodies."),
        tr("Each vehicle is rigid; its load moves with it."),
    )
    yield (
        tr("Wheel and rail"),
        tr("Slip and slide control, sanding, locked wheels, weather along the way."),
        tr("Adhesion is a curve over speed; wet or icy rails need another one in the vehicle files."),
    )


def _brakes() -> Iterator[Row]:
    yield (
        tr("Gas dynamics of the brake pipe"),
        tr("Flow and pressure waves in the pipe, leaks, distributor valves, exhaustion of reservoirs by repeated braking."),
        tr(
            "Every vehicle gets the course of the driver's valve, later by its distance; long trains brake more slowly at"
            " the rear."
        ),
    )
    yield (
        tr("Heat of the brakes"),
        tr("Temperatures of blocks, discs and wheels, and fading."),
        tr("Friction follows speed and force alone; long descents need a thermal study."),
    )
    yield (
        tr("Supply of the traction"),
        tr("Voltage and current limits of the contact line, fuel and engine of diesel locomotives."),
        tr("Command run simulates electric supply and train movement together, with the train as one mass."),
    )
