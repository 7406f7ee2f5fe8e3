"""Trains kept from one variant of a supply to the next change nothing."""

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling

from tractionpower.cosimulation import prepared
from tractionpower.cosimulation.prepared import prepare
from tractionpower.cosimulation.quiet import QuietRun
from tractionpower.cosimulation.tables import compile_scenario
from tractionpower.errors import InputError
from tractionpower.model.change import apply_changes
from tractionpower.movement.driving.driven import compile_driven


@pytest.fixture(autouse=True)
def fresh(monkeypatch):
    made = []
    monkeypatch.setattr(prepared, "_kept", type(prepared._kept)())
    monkeypatch.setattr(prepared, "compile_driven", lambda scenario: (made.append(scenario), compile_driven(scenario))[1])
    return made


CASES = [
    "supply.substations[A].state=rectifiers_out",
    "supply.section_cabins[C].state=bypassed",
    "supply.substations[*].grid_voltage_pu=0.95",
    "supply.substations[B].no_load_voltage_v=3400",
]


def test_of_variants_of_a_supply_the_trains_are_made_once(fresh):
    base = couple(run("x", "series_motors"), run("y", track="2", low=20.0, high=0.0))
    plain = {case: compile_scenario(apply_changes(base, [case])) for case in CASES}
    for case in CASES:
        compiled, _ = prepare(apply_changes(base, [case]))
        for name in ("base", "segments", "conductors"):
            np.testing.assert_array_equal(getattr(compiled.block.network, name), getattr(plain[case].block.network, name))
        for kept, new in zip(compiled.movement.tables, plain[case].movement.tables, strict=True):
            np.testing.assert_array_equal(kept, new)
    assert len(fresh) == 1


@pytest.mark.parametrize(
    "change",
    [
        "timetable.trains[x].start.time=00:01:00",
        "supply.contact_lines[0].resistance_ohm_per_km=0.06",
        "line.speed_limits[0].kmh=80",
        "clock.end=00:05:00",
        "vehicles[inverter].mass_t=170",
        "coast_without_voltage_s=10",
    ],
)
def test_what_trains_depend_on_makes_them_anew(fresh, change):
    base = couple(run("x"))
    prepare(base)
    prepare(apply_changes(base, [change]))
    assert len(fresh) == 2
    prepare(base)
    assert len(fresh) == 2


def test_few_are_kept(fresh):
    base = couple(run("x"))
    for seconds in range(2 * prepared.MOST_KEPT):
        prepare(apply_changes(base, [f"timetable.trains[x].start.time=00:00:{seconds:02d}"]))
    assert len(prepared._kept) == prepared.MOST_KEPT


def test_a_run_leaves_what_is_kept_as_it_was(fresh):
    scenario = RandomCoupling(2).scenario
    ends = []
    for _ in range(2):
        quiet = QuietRun(scenario)
        quiet.execute()
        ends.append(quiet.trains.movers.copy())
    for name in ends[0].dtype.names:  # as a whole, NaN would differ from NaN
        np.testing.assert_array_equal(ends[0][name], ends[1][name])
    assert len(fresh) == 1


def test_errors_of_trains_and_of_the_supply_are_told_together(fresh):
    base = couple(run("x", high=60.0))
    with pytest.raises(InputError) as caught:
        prepare(apply_changes(base, ["supply.section_cabins[C].km=60"]))
    paths = {problem.path.split(".")[0] for problem in caught.value.problems}
    assert paths == {"timetable", "supply"}
    assert not fresh
