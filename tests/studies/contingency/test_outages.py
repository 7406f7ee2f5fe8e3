"""Which outages there are, what they switch, and that each equals the inputs with that state set."""

import json
from itertools import combinations

import numpy as np
import pytest
from coupled import couple, run
from small_studies import load, make_scenario, run_in_memory, station

from tractionpower.errors import InputError
from tractionpower.io.scenario_files import load_scenario
from tractionpower.model.change import apply_changes
from tractionpower.model.contingency import Contingency
from tractionpower.model.scenario import Scenario
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.contingency.line_sections import find_line_sections
from tractionpower.studies.contingency.outages import find_outages, outages
from tractionpower.supply.compile import compile_network

TWO_UNITS = station("A", 0.0, units=2)
OPEN_ROWS = [{"at": at, "track": "1", "side": side, "state": "open"} for at, side in (("A", "high_km"), ("C", "low_km"))]


def small(**more) -> Scenario:
    """Return two substations, one with two units, a cabin between them, and loads on both tracks."""
    parts = {"substations": [TWO_UNITS, station("B", 20.0)]}
    loads = load("x", 7.0), load("y", 15.0, "2")
    return make_scenario(*loads, **parts | more)


def wishing(scenario: Scenario, **wish) -> Scenario:
    return scenario.model_copy(update={"contingency": Contingency.model_validate(wish)})


def normal(scenario: Scenario) -> Scenario:
    return wishing(scenario, grid_voltages=["normal"])


def by_id(scenario: Scenario, **how):
    return {case.id: case for case in find_outages(scenario, **how).cases}


def compiled(scenario: Scenario):
    return compile_network(scenario.supply, scenario.line, scenario.limits, conductors=scenario.conductors)


def lowest_v(scenario: Scenario) -> float:
    """Return the lowest voltage by the table of the whole run."""
    return float(run_in_memory(scenario)[0].table("profile")["lowest_voltage_v"].min())


def test_every_device_is_out_once():
    cases = find_outages(normal(small())).cases
    assert [case.id for case in cases if case.kind in ("base", "unit", "substation", "section_cabin")] == [
        "base", "A unit 1 of 2 in service", "B unit rectifiers_out", "A bypassed", "B bypassed", "C bypassed",
    ]  # fmt: skip
    feeders = [f"{name} open" for name in ("A 1 high_km", "A 2 high_km", "B 1 low_km", "B 2 low_km")]
    assert [case.id for case in cases if case.kind == "feeder"] == feeders
    lines = [f"track {track} km {ends} dead" for track in "12" for ends in ("0-10", "10-20")]
    assert [case.id for case in cases if case.kind == "contact_line"] == lines
    assert [case.base for case in cases] == [True] + [False] * (len(cases) - 1)


@pytest.mark.parametrize(
    ("case", "changed"),
    [
        ("A unit 1 of 2 in service", {"substations": [TWO_UNITS | {"units_in_service": 1}, station("B", 20.0)]}),
        ("B unit rectifiers_out", {"substations": [TWO_UNITS, station("B", 20.0, state="rectifiers_out")]}),
        ("A bypassed", {"substations": [TWO_UNITS | {"state": "bypassed"}, station("B", 20.0)]}),
        ("C bypassed", {"section_cabins": [{"id": "C", "km": 10.0, "state": "bypassed"}]}),
        ("A 1 high_km open", {"feeders": [{"at": "A", "track": "1", "side": "high_km", "state": "open"}]}),
        ("track 1 km 0-10 dead", {"feeders": OPEN_ROWS}),
    ],
)  # fmt: skip
def test_an_outage_equals_the_file_with_that_state_set(case, changed):
    base = normal(small())
    out = apply_changes(base, by_id(base)[case].changes)
    assert out.supply == small(**changed).supply
    figures = measure(out).figures
    assert figures["lowest_voltage_v"] == pytest.approx(lowest_v(small(**changed)), abs=1e-3)  # the table holds float32
    assert figures["lowest_voltage_v"] == pytest.approx(measure(small(**changed)).figures["lowest_voltage_v"], abs=1e-6)
    assert abs(figures["lowest_voltage_v"] - measure(base).figures["lowest_voltage_v"]) > 0.01


def test_a_feeder_that_has_a_row_is_opened_there():
    rows = [{"at": "B", "track": "1", "side": "low_km", "resistance_ohm": 0.01},
            {"at": "A", "track": "1", "side": "high_km", "resistance_ohm": 0.02}]  # fmt: skip
    assert by_id(normal(small(feeders=rows)))["A 1 high_km open"].changes == ("supply.feeders[1].state=open",)


def test_the_no_load_voltage_stays_and_the_slope_changes_as_the_units_share_it():
    """R(k) = R_unit/k + R_grid: of 0.12 ohm with two units 0.02 is the grid's, so one unit alone makes 0.22 ohm."""

    def busbar(current_a: float, changes: tuple[str, ...]) -> float:
        plant = station("A", 0.0, units=2, grid_resistance_ohm=0.02)
        scenario = make_scenario(load("x", 7.0, current_a=current_a, limits="none"), substations=[plant])
        rows = run_in_memory(apply_changes(scenario, changes))[0].table("substations")
        np.testing.assert_allclose(rows["current_a"], current_a, rtol=1e-6)
        return float(rows["voltage_v"].iloc[0])

    out = by_id(normal(small()))["A unit 1 of 2 in service"].changes
    for changes, ohm in (((), 0.12), (out, 0.22)):
        volts = busbar(500.0, changes), busbar(1500.0, changes)
        assert (volts[0] - volts[1]) / 1000.0 == pytest.approx(ohm, rel=1e-6)
        assert volts[0] + 500.0 * ohm == pytest.approx(3600.0, abs=1e-3)


@pytest.mark.parametrize("line", ["cmk", "y-junction"])
def test_exactly_the_section_is_dead(line):
    """Every section of the shipped lines, of which one has junctions, section points, switches and several lines."""
    scenario = load_scenario(line).scenario
    start = compiled(scenario)
    dead_before = {(each.track, each.ends_km) for each in start.stretches if each.no_load_v == 0.0}
    cases = [case for case in outages(normal(scenario)) if case.kind == "contact_line"]
    assert len(cases) > 5
    sections = {section.name: section for section in find_line_sections(scenario)}
    for case in cases[:14]:
        out = apply_changes(scenario, case.changes)
        tables = compiled(out)
        dead = {(each.track, each.ends_km) for each in tables.stretches if each.no_load_v == 0.0} - dead_before
        pieces = [piece.removeprefix("track ").split(" km ") for piece in sections[case.subject].name.split(", ")]
        told = {(track, *map(float, ends.split("-"))) for track, ends in pieces}
        meant = {
            (each.track, each.ends_km)
            for each in tables.stretches
            if any(each.track == track and low - 0.01 < sum(each.ends_km) / 2 < high + 0.01 for track, low, high in told)
        }
        assert dead == meant - dead_before, case.id


def test_trains_on_a_dead_section_stand():
    base = normal(couple(run("x"), end_s=900.0))
    case = by_id(base)["track 1 km 10-20 dead"]
    assert measure(base).figures["stuck_trains"] == 0
    assert measure(apply_changes(base, case.changes)).figures["stuck_trains"] == 1


def test_a_breaker_that_trips_in_an_outage_is_told():
    """Of two substations each feeds half of 1000 A; alone one of them feeds all of it, above its 800 A."""
    base = normal(make_scenario(
        load("x", 10.0, current_a=1000.0, limits="none"), section_cabins=[], tracks=("1",),
        substations=[station("A", 0.0, trip_current_a=800.0), station("B", 20.0)],
    ))  # fmt: skip
    assert measure(base).figures["trips"] == 0
    assert measure(apply_changes(base, by_id(base)["B unit rectifiers_out"].changes)).figures["trips"] == 1


# -- grid voltages and pairs ----------------------------------------------------------------------------------------


def test_base_cases_come_first_and_each_outage_at_each_grid_voltage():
    scenario = wishing(small(), kinds=["substation"], low_grid_voltage_pu=0.95, high_grid_voltage_pu=1.05)
    cases = find_outages(scenario).cases
    assert [(case.id, case.grid) for case in cases] == [
        ("base", "normal"), ("base, grid low", "low"), ("base, grid high", "high"),
        ("A bypassed", "normal"), ("B bypassed", "normal"), ("A bypassed, grid low", "low"), ("B bypassed, grid low", "low"),
        ("A bypassed, grid high", "high"), ("B bypassed, grid high", "high"),
    ]  # fmt: skip
    low = apply_changes(scenario, cases[5].changes)
    assert [plant.grid_voltage_pu for plant in low.supply.substations] == [0.95, 0.95]
    assert low.supply.substations[0].state == "bypassed"


def test_grid_voltages_multiply_what_is_declared():
    plants = [TWO_UNITS | {"grid_voltage_pu": 1.02}, station("B", 20.0)]
    scenario = wishing(small(substations=plants), kinds=["unit"], low_grid_voltage_pu=0.9, grid_voltages=["low"])
    out = apply_changes(scenario, by_id(scenario)["base, grid low"].changes)
    assert [plant.grid_voltage_pu for plant in out.supply.substations] == [0.918, 0.9]


def test_without_a_value_the_limits_table_gives_them():
    scenario = wishing(small(), kinds=["unit"], grid_voltages=["low"])
    assert "supply.substations[*].grid_voltage_pu=0.9" in by_id(scenario)["base, grid low"].changes
    bare = scenario.model_copy(update={"limits": tuple(row for row in scenario.limits if row.name != "grid_low")})
    found = find_outages(bare)
    assert [case.id for case in found.cases] == ["base"]
    assert "grid_low" in found.notes[0]


def test_pairs_are_those_of_devices_of_which_none_is_part_of_the_other():
    scenario = wishing(small(), kinds=["unit", "substation", "section_cabin"])
    singles = [case.id for case in find_outages(normal(scenario)).cases if case.kind in ("unit", "substation", "section_cabin")]
    wanted = [" + ".join(pair) for pair in combinations(singles, 2) if pair[0][0] != pair[1][0]]
    pairs = [case for case in find_outages(scenario, pairs=True).cases if case.kind == "pair"]
    assert [case.id for case in pairs] == wanted
    assert {case.grid for case in pairs} == {"normal"}
    asked = [case for case in find_outages(scenario, pairs=True, grids=["low"]).cases if case.kind == "pair"]
    assert len(asked) == len(pairs)
    assert {case.grid for case in asked} == {"low"}


def test_both_of_a_pair_are_out():
    scenario = small(section_cabins=[{"id": "C", "km": 10.0}, {"id": "D", "km": 15.0}])
    pair = by_id(normal(scenario), pairs=True)["C bypassed + D bypassed"]
    assert [cabin.state for cabin in apply_changes(scenario, pair.changes).supply.section_cabins] == ["bypassed"] * 2
    sections = by_id(normal(scenario), pairs=True)["track 1 km 0-10 dead + track 2 km 15-20 dead"]
    assert {row.id for row in apply_changes(scenario, sections.changes).supply.feeders} == {
        "A 1 high_km", "C 1 low_km", "B 2 low_km", "D 2 high_km",
    }  # fmt: skip


# -- what is chosen -------------------------------------------------------------------------------------------------


def test_devices_are_chosen_by_their_names_and_those_of_their_stations():
    def chosen(*devices: str) -> list[str]:
        cases = find_outages(wishing(small(), grid_voltages=["normal"], devices=devices)).cases
        return [case.id for case in cases if not case.base]

    assert chosen("A 1 high_km") == ["A 1 high_km open"]
    assert chosen("B") == ["B unit rectifiers_out", "B bypassed", "B 1 low_km open", "B 2 low_km open"]
    assert chosen("C", "track 2 km 0-10") == ["C bypassed", "track 2 km 0-10 dead"]


def test_other_kinds_are_found_where_a_reserve_waits():
    plants = [TWO_UNITS | {"reserve_units": 1, "reserve_after_s": 60.0}, station("B", 20.0)]
    scenario = make_scenario(load("x", 5.0), substations=plants)
    kinds = {case.kind for case in find_outages(wishing(scenario, kinds=["substation"])).cases}
    assert kinds == {"base", "substation"}


def test_an_unknown_device_is_told_with_the_nearest_one():
    with pytest.raises(InputError) as error:
        find_outages(wishing(small(), devices=["A 1 hihg_km", "C", "Z"]))
    problems = error.value.problems
    assert [problem.path for problem in problems] == ["contingency.devices[0]", "contingency.devices[2]"]
    assert "A 1 high_km" in problems[0].remedy


@pytest.mark.parametrize(
    ("changed", "missing", "note"),
    [
        ({"substations": [TWO_UNITS | {"state": "bypassed"}, station("B", 20.0)]}, "A bypassed", "it is bypassed already"),
        ({"substations": [TWO_UNITS | {"units_in_service": 0}, station("B", 20.0)]}, "A unit", "none is in service"),
        ({"section_cabins": [{"id": "C", "km": 10.0, "state": "open"}]}, "C bypassed", "it is open already"),
        ({"feeders": OPEN_ROWS[:1]}, "A 1 high_km", "it is open already"),
    ],
)
def test_what_is_out_already_is_told_and_left_out(changed, missing, note):
    found = find_outages(normal(small(**changed)))
    assert not [case.id for case in found.cases if case.id.startswith(missing)]
    assert f"{missing}: {note}" in found.notes


def test_a_section_that_nothing_feeds_is_left_out():
    found = find_outages(normal(small(feeders=OPEN_ROWS)))
    assert "track 1 km 0-10: nothing feeds it" in found.notes


# -- time -----------------------------------------------------------------------------------------------------------


def test_outages_may_begin_later():
    scenario = wishing(small(clock={"end": 100.0}), begins="00:00:40", grid_voltages=["normal"])
    case = by_id(scenario)["A bypassed"]
    event = {"time": "00:00:40", "device": "A", "state": "bypassed"}
    assert [json.loads(change.partition("=")[2]) for change in case.changes] == [event]
    rows = run_in_memory(apply_changes(scenario, case.changes))[0].table("substations")
    before, after = (rows[(rows["substation"] == "A") & (rows["time_s"].between(*ends))] for ends in ((0, 39.5), (39.5, 100)))
    assert (before["current_a"] > 100.0).all()
    assert (after["current_a"] == 0.0).all()


def test_outages_must_begin_before_the_end():
    with pytest.raises(InputError, match="after the end of the run"):
        find_outages(wishing(small(), begins="10:00"))


def test_an_outage_lasts_whatever_else_would_be_switched():
    events = [{"time": 3.0, "device": "A", "state": "in_service"}, {"time": 5.0, "device": "C", "state": "open"}]
    scenario = normal(small(switch_events=events))
    out = apply_changes(scenario, by_id(scenario)["A bypassed"].changes)
    assert [(event.device, event.state) for event in out.supply.switch_events] == [("C", "open")]
    assert (run_in_memory(out)[0].table("substations").query("substation == 'A'")["current_a"] == 0.0).all()


def test_a_reserve_unit_comes_in_and_the_overload_until_then_is_permitted():
    """2000 A on two units: 1000 A each; 300 s on one with 20 % permitted: 2000/1.2; then 1000 A again with the reserve."""
    plant = station("A", 0.0, units=2, reserve_units=1, reserve_after_s=300.0, reserve_overload_percent=20.0,
                    rated_current_a=1300.0, duty_class="own")  # fmt: skip
    scenario = make_scenario(
        load("x", 5.0, current_a=2000.0, limits="none"), substations=[plant], tracks=("1",), clock={"end": 900.0, "step_s": 5.0},
    )  # fmt: skip
    duty = [{"duty_class": "own", "window_s": 900.0, "multiple": 1.0}, {"duty_class": "own", "window_s": 300.0, "multiple": 1.5}]
    plain = scenario.model_dump(mode="python", by_alias=True) | {"duty_classes": duty}
    scenario = normal(Scenario.model_validate(plain))
    case = by_id(scenario)["A unit 1 of 2 in service, reserve after 300 s"]
    found = measure(apply_changes(scenario, case.changes))
    rms = np.sqrt((300.0 * (2000.0 / 1.2) ** 2 + 600.0 * 1000.0**2) / 900.0)
    unit = next(row for row in found.tables["case_devices"].to_pylist() if row["device"] == "A unit")
    flowed = np.sqrt((300.0 * 2000.0**2 + 600.0 * 1000.0**2) / 900.0)  # loads are told as they flow
    assert unit["rms_a"] == pytest.approx(flowed, rel=1e-6)
    assert 100.0 * unit["load_a"] / unit["permitted_a"] == pytest.approx(unit["utilisation_percent"], rel=1e-6)
    assert unit["peak_a"] == pytest.approx(2000.0, rel=1e-6)
    by_900_s, by_300_s = rms / 1300.0, (2000.0 / 1.2) / 1950.0
    assert unit["utilisation_percent"] == pytest.approx(100.0 * max(by_900_s, by_300_s), rel=1e-6)
    assert found.figures["overloaded"] == 0
    plain["supply"]["substations"][0]["reserve_overload_percent"] = 0.0
    harder = measure(apply_changes(normal(Scenario.model_validate(plain)), case.changes))
    assert harder.figures["utilisation_percent"] == pytest.approx(
        100.0 * max(2000.0 / 1950.0, np.sqrt((300 * 2000.0**2 + 600 * 1000.0**2) / 900) / 1300.0), rel=1e-6
    )
    over = {row["device"] for row in harder.tables["case_devices"].to_pylist() if row["met"] == "no"}
    assert over == {"A unit", "A"}  # a substation is held to its units in service, so it is used as much as they are


def test_a_reserve_is_not_awaited_within_the_warm_up():
    plant = station("A", 0.0, units=2, reserve_units=1, reserve_after_s=20.0)
    scenario = normal(small(substations=[plant, station("B", 20.0)], clock={"end": 100.0, "warm_up": 30.0}))
    case = by_id(scenario)["A unit 1 of 2 in service, reserve after 20 s"]
    events = apply_changes(scenario, case.changes).supply.switch_events
    assert [(event.time, event.units_in_service) for event in events] == [(30.0, 1), (50.0, 2)]


def test_a_reserve_that_feeds_at_once_changes_nothing():
    plant = station("A", 0.0, reserve_units=1, reserve_after_s=0.0)
    found = find_outages(normal(small(substations=[plant, station("B", 20.0)])))
    assert "A unit: its reserve feeds at once, so nothing changes" in found.notes
