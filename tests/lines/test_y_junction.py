"""The shipped junction: currents of the branch flow as the switches lead them, trains pass from line to line and obey."""

from pathlib import Path

import numpy as np
import pytest
from small_studies import run_in_memory

import tractionpower

FOLDER = Path(__file__).parents[2] / "lines" / "y-junction"
WORK_S = (6 * 3600 + 31 * 60 + 10, 7 * 3600 + 2 * 60)  # the feeders of the branch are out
LIMIT_A = 600.0
NEUTRAL_KM = (14.35, 14.41)


@pytest.fixture(scope="module")
def study():
    return tractionpower.load(FOLDER)


@pytest.fixture(scope="module")
def run(study):
    results, outcome, _ = run_in_memory(study)
    return results, outcome


@pytest.fixture(scope="module")
def currents(run):
    """Return the currents of feeders and switches by name, each over the time [A]."""
    feeders, switches = (run[0].table(name) for name in ("feeders", "switches"))
    names = feeders["substation"].astype(str) + " " + feeders["track"].astype(str) + " " + feeders["side"].astype(str)
    found = {name: rows.set_index("time_s")["current_a"] for name, rows in feeders.groupby(names)}
    return found | {name: rows.set_index("time_s")["current_a"] for name, rows in switches.groupby("switch", observed=True)}


def branch_current(results, below_km):
    """Return what trains and loads take on the branch, up to a kilometre of it, in each step [A]."""
    trains, loads = results.table("trains"), results.table("loads")
    total = loads.set_index("time_s")["current_a"].astype(float)
    here = trains[(trains["track"] == "3") & (trains["position_km"] < below_km)]
    return total.add(here.groupby("time_s")["current_a"].sum(), fill_value=0.0)


def at_work(table):
    return (table.index >= WORK_S[0]) & (table.index < WORK_S[1])


def test_nothing_is_wrong_or_doubtful(study):
    assert tractionpower.check(study) == []


def test_the_day_is_run_on_time(run):
    results, outcome = run
    assert outcome.run["status"] == "complete"
    assert {note["status"] for note in outcome.run["trains"]} == {"left"}
    assert outcome.run["overlaps"]["count"] == 0
    assert results.table("calls")["late_s"].max() < 1.0
    assert set(results.table("events")["kind"]).isdisjoint({"line_dead", "voltage_lost", "tripped", "limit_violated"})
    assert results.table("trains")["voltage_v"].min() > 2700.0
    assert all(ledger["closes"] for ledger in outcome.run["ledgers"].values())


def test_the_substation_of_the_main_line_feeds_the_branch(run, currents):
    low = currents["Rozjazd 3 low_km"]
    beyond = branch_current(run[0], 14.0)
    normal = ~at_work(low)
    normal &= ~((low.index >= WORK_S[0] - 10) & (low.index < WORK_S[0]))  # the by-pass lies beside the feeders then
    normal &= ~((low.index >= WORK_S[1]) & (low.index < WORK_S[1] + 10))
    assert low[normal].to_numpy() == pytest.approx(beyond[normal].to_numpy(), abs=1e-3)
    assert low.max() > 500.0


def test_the_branch_is_fed_through_the_junction_while_its_feeders_are_out(run, currents):
    by_pass = currents["by-pass Rozjazd"]
    out = at_work(by_pass)
    assert currents["Rozjazd 3 low_km"][out].eq(0.0).all()
    assert currents["Rozjazd 3 high_km"][out].eq(0.0).all()
    beyond = branch_current(run[0], 14.0)[out].to_numpy()
    assert -by_pass[out].to_numpy() == pytest.approx(beyond, abs=1e-3)  # from the junction to the branch: second side to first
    assert beyond.max() > 300.0
    wired = {name: rows for name, rows in currents.items() if name.split()[-1] in ("low_km", "high_km")}
    main = sum(rows[out].to_numpy() for name, rows in wired.items() if " 3 " not in name)
    trains = run[0].table("trains").groupby("time_s")["current_a"].sum()
    loads = run[0].table("loads").set_index("time_s")["current_a"]
    taken = trains.reindex(by_pass.index, fill_value=0.0)[out].to_numpy() + loads[out].to_numpy()
    assert main == pytest.approx(taken, abs=0.05)  # the main line's feeders carry all of it


def test_rails_of_the_branch_return_through_the_junction(currents):
    own, others = currents["Rozjazd 3 return"], currents["Rozjazd 1 return"] + currents["Rozjazd 2 return"]
    busbar = sum(rows for name, rows in currents.items() if name.startswith("Rozjazd") and not name.endswith("return"))
    assert (own + others).to_numpy() == pytest.approx(busbar.to_numpy(), abs=1e-2)
    assert own.max() > 100.0


def test_trains_pass_from_line_to_line(study, run):
    trains = run[0].table("trains")
    for train, tracks in (("R 101", ["1", "3"]), ("R 102", ["3", "2"]), ("T 23", ["1", "3"])):
        rows = trains[trains["train"] == train]
        assert list(dict.fromkeys(rows["track"])) == tracks
        way = np.diff(rows["distance_m"])
        assert way == pytest.approx(0.5 * (rows["speed_kmh"][:-1].to_numpy() + rows["speed_kmh"][1:].to_numpy()) / 3.6, abs=0.3)
    connections = [sorted((item.from_.track, item.to.track)) for item in study.line.connections]
    assert connections == [["1", "3"], ["2", "3"]]


def test_trains_on_the_branch_obey_its_limit(run):
    trains = run[0].table("trains")
    held = trains[(trains["track"] == "3") & (trains["position_km"] < NEUTRAL_KM[0]) & (trains["limited_by"] == "line_current")]
    assert set(held["train"]) >= {"R 101", "T 23"}
    assert held["current_a"].max() <= LIMIT_A + 1e-3
    elsewhere = trains[(trains["train"] == "R 101") & (trains["track"] == "1")]
    assert elsewhere["current_a"].max() > 1.2 * LIMIT_A


def test_trains_pass_the_section_point_without_current(run):
    trains = run[0].table("trains")
    inside = trains[(trains["track"] == "3") & trains["position_km"].between(*NEUTRAL_KM)]
    assert set(inside["train"]) == {"R 101", "R 102", "T 23"}
    within = inside[inside.duplicated("train", keep="last")]  # in the last step of each it comes out
    assert len(within) >= 6
    assert within["tractive_force_kn"].eq(0.0).all()
    assert within["current_a"].abs().max() < 0.1 * LIMIT_A


def test_rail_potentials_follow_the_earth_of_the_branch(run):
    results, _ = run
    profile = results.table("rail_profile")
    depot = profile[(profile["track"] == "3") & (profile["km"] == 0.1)].iloc[0]
    earthed = results.table("earthing")
    own = earthed[earthed["device"] == "depot Gory"]
    assert (own["current_a"] * 2.0).to_numpy() == pytest.approx(own["potential_v"].to_numpy(), abs=1e-3)  # 2 ohm
    assert own["potential_v"].max() == pytest.approx(depot["highest_potential_v"], abs=1e-3)
    assert depot["highest_potential_v"] > 20.0
    assert profile["lowest_potential_v"].min() < -10.0  # at the substations: the current comes back there
