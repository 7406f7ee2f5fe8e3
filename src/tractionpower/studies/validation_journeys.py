"""Figures of theoretical journeys for reference cases, ``journeys.<train>.<figure>``."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from tractionpower.model.scenario import Scenario
from tractionpower.movement.journey import Journey
from tractionpower.results.store import MemoryWriter
from tractionpower.results.trains import J_PER_KWH, KMH_PER_MPS
from tractionpower.studies.journeys import Form, compute_journeys, end_of

PREFIX = "journeys."
"""How the names of these figures begin."""

ENERGIES = {
    "wheel_kwh": "wheel_w",
    "drive_loss_kwh": "drive_loss_w",
    "starting_resistor_kwh": "starting_resistor_w",
    "braking_resistor_kwh": "braking_resistor_w",
    "auxiliary_kwh": "auxiliary_w",
    "refused_kwh": "refused_w",
}
"""Figures that are energies, and the fields of `TRAIN_ROW` that they are summed up from."""


def journey_figures(scenario: Scenario, voltage_v: float | None, form: Form) -> tuple[dict[str, float], str]:
    """Return the figures of the journeys of all trains of a study, and the status of their computation.

    They are the key figures of the journeys under their own names, net and other energies, distance, greatest effort, speed at
    the end; for every call ``at_<station>_s``, its arrival after the start of the run, ``speed_at_<station>_kmh`` where the
    train passes, and ``from_<station before>_to_<station>_s``, the time from one arrival to the next.

    Parameters
    ----------
    scenario
        The study.
    voltage_v
        Voltage at the pantograph [V]; None: the nominal one.
    form
        Form of the equations of motion.

    Raises
    ------
    InputError
        If the study has errors.
    UsageError
        If it has no trains.
    """
    outcome = compute_journeys(scenario, MemoryWriter(), voltage_v=voltage_v, form=form)
    figures = {f"{PREFIX}{journey.run.id}.{name}": value for journey in outcome.journeys for name, value in _figures(journey)}
    for figure in outcome.key_figures:
        figures[f"{PREFIX}{figure['place'].removeprefix('train ')}.{figure['name']}"] = figure["value"]
    for run in (journey.run.id for journey in outcome.journeys):
        taken, returned = (figures[f"{PREFIX}{run}.energy_{kind}_kwh"] for kind in ("taken", "returned"))
        figures[f"{PREFIX}{run}.net_energy_kwh"] = taken - returned
    return figures, str(outcome.run["status"])


def _figures(journey: Journey) -> Iterator[tuple[str, float]]:
    rows, seconds = journey.rows, journey.seconds
    energies = {name: float(rows[field] @ seconds) / J_PER_KWH for name, field in ENERGIES.items()}
    yield from energies.items()
    traction = sum(energies[name] for name in ("wheel_kwh", "drive_loss_kwh", "starting_resistor_kwh"))
    yield "starting_resistor_share", energies["starting_resistor_kwh"] / traction if traction > 0.0 else 0.0
    yield "distance_m", end_of(journey)
    yield "greatest_effort_kn", float(rows["traction_n"].max()) / 1000.0
    yield "end_speed_kmh", journey.end_mps * KMH_PER_MPS
    times = np.append(rows["time_s"], journey.end_s)
    speeds = np.append(rows["v_mps"], journey.end_mps) * KMH_PER_MPS
    called = [call for call in journey.calls if np.isfinite(call.arrival_s)]
    for call in called:
        yield f"at_{call.station}_s", call.arrival_s - journey.start_s
        if call.kind == "pass":
            yield f"speed_at_{call.station}_kmh", float(np.interp(call.arrival_s, times, speeds))
    for before, after in pairwise(called):
        yield f"from_{before.station}_to_{after.station}_s", after.arrival_s - before.arrival_s
