"""What an outage is judged by: services, contracts, breakers, ended runs; and when a reserve is awaited."""

import numpy as np
import pytest
from coupled import couple, run
from random_coupling import RandomCoupling
from small_studies import load, make_scenario, run_in_memory, station

from tractionpower.io.library import shipped_library
from tractionpower.model.change import apply_changes
from tractionpower.model.contingency import Contingency
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.contingency.outages import find_outages
from tractionpower.studies.contingency.study import contingency
from tractionpower.studies.ratings.study import size

NORMAL = Contingency(grid_voltages=("normal",))
SUBSTATIONS = Contingency(kinds=("substation",), grid_voltages=("normal",))


def asking(scenario, wish):
    library = shipped_library()
    equipment = {"rectifier_units": library.rectifier_units, "duty_classes": library.duty_classes}
    return scenario.model_copy(update={"contingency": wish, **equipment})


def fails(results):
    """Return what each case fails at, by the summary."""
    told = results.run["contingency"]
    return {row["case"]: row["fails"] for row in (*told["base"], *told["worst"])}


@pytest.mark.parametrize("mode", ["open", "rectifiers_out"])
def test_an_outage_of_the_only_substation_fails(mode):
    wish = Contingency(kinds=("substation",), substation_modes=(mode,), grid_voltages=("normal",))
    results = contingency(asking(make_scenario(load("x"), substations=[station("A", 0.0)]), wish))
    assert fails(results) == {"base": [], f"A {mode}": ["loads without voltage", "nothing fed"]}
    assert results.run["contingency"]["verdict"] == "fails"
    names = {verdict["name"]: verdict for verdict in results.run["verdicts"]}
    missed = names["loads without a voltage while they should take something"]
    assert (missed["value"], missed["met"], missed["place"], missed["status"]) == (1.0, False, f"A {mode}", "user")


def test_contracts_and_settings_are_judged_in_each_case():
    """Two substations share 2500 kW; alone one of them is beyond its contract, and its feeder beyond 60 % of its setting."""
    plants = [station(name, km, contract_power_kw=2000.0, trip_current_a=1000.0) for name, km in (("A", 0.0), ("B", 20.0))]
    scenario = make_scenario(
        load("x", 10.0, power_kw=2500.0),
        substations=plants,
        section_cabins=[],
        tracks=("1",),
        clock={"end": 900.0, "step_s": 5.0},
    )
    scenario = scenario.model_copy(update={"sizing": scenario.sizing.model_copy(update={"breaker_percent": 60.0})})
    modes = {"substation_modes": ("rectifiers_out",)}
    results = contingency(asking(scenario, SUBSTATIONS.model_copy(update=modes)))
    assert fails(results) == {"base": [], **{f"{name} rectifiers_out": ["contract", "breaker"] for name in "AB"}}
    cases = results.table("cases").set_index("case")
    (whole,) = run_in_memory(apply_changes(scenario, ["supply.substations[A].state=rectifiers_out"]))[:1]
    rows = whole.table("substations").query("substation == 'B'")
    row = cases.loc["A rectifiers_out"]
    assert row["contract_share_percent"] == pytest.approx(rows["power_kw"].mean() / 2000.0 * 100.0, rel=1e-6)
    assert row["breaker_share_percent"] == pytest.approx(rows["current_a"].max() / 1000.0 * 100.0, rel=1e-6)
    assert (row["contract_point"], row["breaker_device"]) == ("B", "B 1 low_km")


def test_a_trip_fails():
    plants = [station("A", 0.0, trip_current_a=800.0), station("B", 20.0)]
    scenario = make_scenario(
        load("x", 10.0, current_a=1000.0, limits="none"), section_cabins=[], tracks=("1",), substations=plants
    )
    wish = SUBSTATIONS.model_copy(update={"substation_modes": ("rectifiers_out",), "devices": ("B",)})
    assert "tripped breakers" in fails(contingency(asking(scenario, wish)))["B rectifiers_out"]


@pytest.mark.parametrize("seed", range(4))
def test_where_size_fails_the_base_case_fails(seed):
    """With tight ratings, contracts and settings on one substation each; the words of the failing verdicts have their kind."""
    scenario = RandomCoupling(seed, steps=200).scenario
    tight = ({"contract_power_kw": 1.0}, {"rated_current_a": 1.0}, {"trip_current_a": 5.0}, {})[seed]
    plants = tuple(plant.model_copy(update=tight) for plant in scenario.supply.substations)
    clock = scenario.clock.model_copy(update={"end": scenario.clock.start + 1800.0})
    scenario = scenario.model_copy(update={"clock": clock, "supply": scenario.supply.model_copy(update={"substations": plants})})
    scenario = asking(scenario, SUBSTATIONS)
    sized, row = size(scenario).run, measure(scenario).figures
    missed = [verdict["name"] for verdict in sized["verdicts"] if not verdict["met"]]
    assert bool(row["fails"]) >= bool(missed)
    words = {
        "contract": sized["size"]["failing_contracts"], "breaker": sized["size"]["failing_breakers"],
        "overload": sized["size"]["failing"], "high voltage": [name for name in missed if name.startswith("longest spell")],
        "low voltage": [name for name in missed if name == "lowest voltage"],
        # trains that are on the line too briefly count in the verdicts of a run, and not here
        "useful voltage": [name for name in missed if "mean useful" in name and np.isfinite(row["useful_train_v"])],
    }  # fmt: skip
    for word, found in words.items():
        assert word in row["fails"].split(", ") or not found, word


def test_a_flagged_case_is_not_judged():
    scenario = make_scenario(
        load("x", 10.0, power_kw=9000.0, limits="none"), substations=[station("A", 0.0), station("B", 20.0)], section_cabins=[]
    )
    limits = tuple(row for row in scenario.limits if not row.name.startswith("u_use"))
    scenario = asking(scenario.model_copy(update={"limits": limits}), SUBSTATIONS)
    results = contingency(scenario)
    statuses = set(results.table("cases")["status"])
    assert "flagged" in statuses
    verdict = results.run["contingency"]["verdict"]
    assert verdict == ("fails" if any(fails(results).values()) else "not judged")


def test_a_train_that_only_in_the_outage_does_not_end_its_run_is_missed():
    """It has no timed call; the clock ends 2 to 3 s behind its end in the base case; a longer tolerance forgives that."""
    base = couple(run("x"), end_s=1500.0)
    ended_s = measure(base).tables["case_trains"].to_pylist()[0]["finished_s"]
    results = {}
    for tolerance_s in (1.0, 30.0):
        scenario = couple(run("x"), end_s=float(np.ceil(ended_s) + 2.0))
        judged = scenario.feasibility.model_copy(update={"tolerance_s": tolerance_s})
        found = contingency(asking(scenario.model_copy(update={"feasibility": judged}), SUBSTATIONS))
        cases = found.table("cases").set_index("case")
        assert cases.loc["base", "unfinished_trains"] == 0
        assert cases.loc["A bypassed", "stuck_trains"] == 0
        results[tolerance_s] = cases.loc["A bypassed", "unfinished_trains"], "unfinished trains" in fails(found)["A bypassed"]
    assert results == {1.0: (1, True), 30.0: (0, False)}


# -- when a reserve is awaited ---------------------------------------------------------------------------------------


def reserve(profile, clock, **more):
    plant = station("A", 0.0, units=2, unit="PD-12", reserve_units=1, reserve_after_s=600.0)
    rows = [{"time": time_s, "current_a": amps} for time_s, amps in profile]
    tap = {"id": "x", "track": "1", "km": 0.1, "profile": rows, "limits": "none"}
    scenario = make_scenario(tap, substations=[plant], tracks=("1",), section_cabins=[], clock=clock)
    return asking(scenario, Contingency(kinds=("unit",), grid_voltages=("normal",), **more))


def test_a_reserve_is_awaited_when_the_units_carry_most():
    profile = [(0.0, 100.0), (1200.0, 3000.0), (1500.0, 100.0), (2400.0, 2500.0), (2900.0, 200.0)]
    scenario = reserve(profile, {"end": 3600.0, "step_s": 5.0})
    series = np.array([next(a for t, a in reversed(profile) if t <= now) for now in np.arange(0.0, 3600.0, 5.0)])
    means = [np.mean(series[k : k + 120] ** 2) for k in range(len(series) - 119)]
    begin = 5.0 * int(np.argmax(np.round(means, 3)))
    found = find_outages(scenario)
    events = apply_changes(scenario, found.cases[1].changes).supply.switch_events
    assert [event.time for event in events] == [begin, begin + 600.0]
    assert "A unit: out from" in found.begins[0]
    assert "carry most over 600 s" in found.begins[0]
    worst = measure(apply_changes(scenario, found.cases[1].changes)).figures["utilisation_percent"]
    first = reserve(profile, {"end": 3600.0, "step_s": 5.0}, begins="00:00:00")
    quiet = find_outages(first)
    assert "as contingency.begins says" in quiet.begins[0]
    assert worst > 1.2 * measure(apply_changes(first, quiet.cases[1].changes)).figures["utilisation_percent"]


def test_the_beginning_is_told_in_run_json():
    scenario = reserve([(0.0, 100.0), (1200.0, 3000.0)], {"end": 2400.0, "step_s": 5.0})
    (told,) = contingency(scenario).run["contingency"]["begins"]
    assert told.startswith("A unit: out from 00:20:00")


def test_a_run_shorter_than_the_wait_begins_at_once():
    scenario = reserve([(0.0, 100.0)], {"end": 300.0, "step_s": 5.0, "warm_up": 50.0})
    found = find_outages(scenario)
    assert '"time": "00:00:50"' in found.cases[1].changes[0]
    results = contingency(scenario)
    assert set(results.table("cases")["status"]) == {"complete"}


# -- pairs -----------------------------------------------------------------------------------------------------------


def pairs_of(scenario, **wish):
    found = find_outages(asking(scenario, Contingency(grid_voltages=("normal",), **wish)), pairs=True)
    return {case.id: case for case in found.cases if case.kind == "pair"}, found.notes


def test_neighbouring_sections_may_both_be_dead():
    point = {"id": "p", "track": "1", "km": 5.0, "state": "closed"}
    scenario = make_scenario(load("x", 3.0), load("y", 7.0), section_points=[point])
    pairs, _ = pairs_of(scenario, kinds=("contact_line",))
    both = apply_changes(scenario, pairs["track 1 km 0-5 dead + track 1 km 5-10 dead"].changes)
    assert measure(both).figures["unserved_loads"] == 2


def test_rectifiers_and_what_is_beside_them_may_both_be_out():
    pairs, notes = pairs_of(make_scenario(load("x")), substation_modes=("rectifiers_out", "bypassed", "open"))
    assert "A rectifiers_out + track 1 km 0-10 dead" in pairs
    assert "A rectifiers_out + A 1 high_km open" in pairs
    assert "A open + track 1 km 0-10 dead" in pairs
    for name in ("A bypassed + track 1 km 0-10 dead", "A rectifiers_out + A bypassed", "A open + A 1 high_km open",
                 "A unit rectifiers_out + A open", "A 1 high_km open + track 1 km 0-10 dead"):  # fmt: skip
        assert name not in pairs
    left_out = sum(int(note.split()[0]) for note in notes if " pairs: " in note)
    singles = len(find_outages(asking(make_scenario(load("x")), NORMAL.model_copy(
        update={"substation_modes": ("rectifiers_out", "bypassed", "open")}))).cases) - 1  # fmt: skip
    assert left_out + len(pairs) == singles * (singles - 1) // 2
