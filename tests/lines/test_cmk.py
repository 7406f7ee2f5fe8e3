"""The Central Trunk Line that ships: what is real of it agrees with its sources, and nobody catches up with another train.

Rectifier units, altitudes and cables are typed here again from the works that the line's README names.
"""

import csv
import re
from collections import Counter
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from small_studies import run_in_memory

import tractionpower

FOLDER = Path(__file__).parents[2] / "lines" / "cmk"
HEADWAY_S = 180.0

# transformer [VA], short-circuit voltage, load losses [W], rated current [A] and power [W] of one unit
UNITS = {
    "PD-17": (6.4e6, 0.10, 53.5e3, 1700.0, 5.61e6),
    "PD-1.7": (6.3e6, 0.066, 38e3, 1700.0, 5.61e6),
    "PD-16": (5.85e6, 0.088, 46e3, 1600.0, 5.28e6),
}
ALTITUDES = {
    "Grodzisk": 105,
    "Korytow": 141,
    "Szeligi": 175,
    "Strzalki": 165,
    "Idzikowice": 196,
    "Opoczno": 184,
    "Zawiercie": 333,
}


def source_of(va, uk, losses_w, current_a, power_w, units, fault_va):
    """Return no-load voltage [V] and internal resistance [ohm] of a 12-pulse substation by its rated data."""
    at_rated_v = 3300.0 + losses_w / current_a * (power_w / va) ** 2 + 3 * 2.0
    no_load_v = at_rated_v / (1.0 - 0.38 * uk * power_w / va - 0.26 * units * va / fault_va)
    return no_load_v, (no_load_v - 3300.0) / (units * current_a)


@pytest.fixture(scope="module")
def cmk():
    return tractionpower.load(FOLDER)


@pytest.fixture(scope="module")
def common_return():
    return tractionpower.load(FOLDER / "study-common-return.yaml")


@pytest.fixture(scope="module")
def journeys(cmk):
    return tractionpower.journeys(cmk)


def track_of(run):
    (leg,) = run.route
    return leg.track


def test_nothing_is_wrong_or_doubtful(cmk, common_return):
    assert tractionpower.check(cmk) == []
    assert tractionpower.check(common_return) == []


def test_stations_stand_where_the_source_has_them(cmk):
    with (FOLDER / "source" / "simrail-sdk-line-4.csv").open(encoding="utf-8", newline="") as file:
        places = {row["name"]: float(row["km"]) for row in csv.DictReader(file) if row["line"] == "4"}
    assert len(places) == 20
    assert {station.name: station.km for station in cmk.line.stations}.items() <= places.items()
    assert len(cmk.line.stations) == 14
    licence = (FOLDER / "source" / "LICENSE-simrail-sdk.txt").read_text(encoding="utf-8")
    assert licence.startswith("MIT License")
    assert "simrail.express" in licence


def test_gradients_lead_to_the_known_altitudes(cmk):
    rows = cmk.line.gradients
    assert max(abs(row.permille) for row in rows) <= 6.0
    kms = [rows[0].from_km, *(row.to_km for row in rows)]
    rises = [row.permille * (row.to_km - row.from_km) for row in rows]
    altitude = 105.0 + np.concatenate([[0.0], np.cumsum(rises)])
    km_of = {station.id: station.km for station in cmk.line.stations}
    for station, metres in ALTITUDES.items():
        assert np.interp(km_of[station], kms, altitude) == pytest.approx(metres, abs=0.1), station


def test_the_formula_gives_the_published_substation():
    no_load_v, ohm = source_of(6.3e6, 0.11, 38e3, 1700.0, 5.61e6, 2, 102.088e6)
    assert no_load_v == pytest.approx(3571.255, abs=0.01)
    assert ohm == pytest.approx(0.079781, rel=1e-4)
    assert (no_load_v - 3300.0) / no_load_v == pytest.approx(0.075955, rel=1e-4)


def test_substations_have_the_characteristic_of_their_units(cmk):
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    named = re.findall(r"^\| ([\w ]+) \| ([\d.]+) \| (\d) × (PD-[\d.]+) \| (\d+) \|$", text, re.MULTILINE)
    stations = {station.id: station for station in cmk.supply.substations}
    assert [name for name, *_ in named] == list(stations)
    for name, km, units, unit, fault_mva in named:
        data, station, fault_va = UNITS[unit], stations[name], float(fault_mva) * 1e6
        no_load_v, ohm = source_of(*data, int(units), fault_va)
        assert (station.km, station.units) == (float(km), int(units))
        assert station.no_load_voltage_v == pytest.approx(no_load_v, abs=0.051), name
        assert station.unit == unit, name
        assert station.plant_resistance_ohm == pytest.approx(ohm, abs=5.1e-5), name
        heat_w = int(units) * (data[2] + 3 * 2.0 * data[3])  # at rated load
        assert station.plant_dissipative_ohm * (int(units) * data[3]) ** 2 == pytest.approx(heat_w, rel=1e-3), name
        grid_v = no_load_v * 0.26 * int(units) * data[0] / fault_va  # the grid's part of the drop at rated load
        assert station.grid_resistance_ohm * int(units) * data[3] == pytest.approx(grid_v, abs=0.05), name


def test_feeders_have_the_resistance_of_their_cables(cmk, common_return):
    rows = cmk.supply.feeders
    substations = {station.id for station in cmk.supply.substations}
    assert len(rows) == 13 * 6 + 12 * 4
    for row in rows:
        per_km = {"YAKY-500": 0.060, "YAKY-240": 0.125}[row.cable]
        ohm = per_km * row.length_m / 1000.0 / row.cables
        expected = 0.0146 if row.side == "return" else 0.0105 if row.at in substations else 0.0015
        assert ohm == pytest.approx(expected, abs=5e-5), row.id
    for station in common_return.supply.substations:
        assert station.feeder_resistance_ohm == pytest.approx(0.0105)
        assert station.return_resistance_ohm == pytest.approx(0.0146 / 2)


def test_units_have_the_rated_current_of_their_type_and_feeders_that_of_their_cables(cmk, common_return):
    for kind in cmk.rectifier_units:
        assert (kind.rated_current_a, kind.transformer_mva * 1e6) == (UNITS[kind.unit][3], UNITS[kind.unit][0])
    assert {station.unit for station in cmk.supply.substations} == {kind.unit for kind in cmk.rectifier_units}
    each = {row.name: row.rated_current_a for row in cmk.conductors if row.kind == "cable"}
    cabins = {cabin.id: cabin for cabin in common_return.supply.section_cabins}
    stations = {station.id: station for station in common_return.supply.substations}
    for row in cmk.supply.feeders:
        rated = each[row.cable] * row.cables
        if row.side == "return":
            assert stations[row.at].return_rated_current_a == 2 * rated  # of both tracks
        else:
            assert (stations | cabins)[row.at].feeder_rated_current_a == rated


def test_every_feeder_to_a_contact_line_has_a_breaker(cmk):
    settings = {(row.side == "return", row.trip_current_a, row.reclose_after_s) for row in cmk.supply.feeders}
    assert settings == {(False, 3000.0, 10.0), (False, 2500.0, 10.0), (True, None, None)}


def test_one_cabin_stands_between_two_substations(cmk):
    places = sorted(station.km for station in cmk.supply.substations)
    assert all(15.0 <= b - a <= 21.0 for a, b in pairwise(places))
    cabins = [cabin.km for cabin in cmk.supply.section_cabins]
    assert [sum(a < km < b for km in cabins) for a, b in pairwise(places)] == [1] * len(cabins)
    assert len(cabins) == len(places) - 1


def test_a_busy_day_in_both_directions(cmk):
    runs = cmk.timetable.trains
    assert all((int(run.id.split()[-1]) % 2 == 1) == (track_of(run) == "1") for run in runs)
    begins = {track: [run.start.time for run in runs if track_of(run) == track] for track in ("1", "2")}
    assert min(map(len, begins.values())) >= 60
    assert max(max(times) for times in begins.values()) < 86_400.0
    by_hour = Counter(int(time // 3600) for times in begins.values() for time in times)
    peaks = [by_hour[hour] for hour in (6, 7, 15, 16)]
    assert min(peaks) > max(by_hour[hour] for hour in (10, 11, 12, 20, 21))


def planned_places(run, km_of):
    """Return kilometre -> planned arrival and departure of a run, its start included."""
    (leg,) = run.route
    places = {leg.from_km: (run.start.time, run.start.time)}
    for call in run.calls:
        places[km_of[call.station]] = (call.arrival, call.arrival if call.departure is None else call.departure)
    return places


def assert_apart(first, second, names):
    """Assert that of two runs, given as place -> (arrival, departure), one is everywhere well behind the other."""
    shared = first.keys() & second.keys()
    if not shared:
        return
    behind = min(second[place][0] - first[place][1] for place in shared)
    before = min(first[place][0] - second[place][1] for place in shared)
    assert max(behind, before) >= HEADWAY_S, names


def pairs_on_a_track(cmk, places):
    for track in ("1", "2"):
        names = sorted(run.id for run in cmk.timetable.trains if track_of(run) == track)
        for index, name in enumerate(names):
            for other in names[index + 1 :]:
                yield places[name], places[other], (name, other)


def test_planned_times_keep_the_headway(cmk):
    km_of = {station.id: station.km for station in cmk.line.stations}
    places = {run.id: planned_places(run, km_of) for run in cmk.timetable.trains}
    for pair in pairs_on_a_track(cmk, places):
        assert_apart(*pair)


def test_theoretical_journeys_are_on_time_and_keep_the_headway(cmk, journeys):
    assert journeys.run["status"] == "complete"
    assert {note["status"] for note in journeys.run["journeys"]} == {"complete"}
    calls = journeys.table("calls")
    assert len(calls) > 400
    assert calls["late_s"].max() < 1.0
    places = {}
    for name, rows in journeys.table("trains").groupby("train", observed=True):
        km, time = rows["position_km"].to_numpy(), rows["time_s"].to_numpy()
        if km[0] > km[-1]:
            km, time = km[::-1], time[::-1]
        grid = np.arange(np.ceil(km[0]), np.floor(km[-1])) + 0.3  # no train stops there
        places[name] = {place: (moment, moment) for place, moment in zip(grid, np.interp(grid, km, time), strict=True)}
    for pair in pairs_on_a_track(cmk, places):
        assert_apart(*pair)


def test_trains_have_five_to_eight_percent_in_hand(cmk, journeys):
    figures = {(row["place"], row["name"]): row["value"] for row in journeys.key_figures}
    for run in cmk.timetable.trains:
        stood = sum(call.departure - call.arrival for call in run.calls if call.departure is not None)
        moving = max(call.departure or call.arrival for call in run.calls) - run.start.time - stood
        assert 1.05 <= moving / figures[f"train {run.id}", "running_time_s"] <= 1.08, run.id


def in_the_peak(scenario):
    """Return the results of ten minutes of the morning peak, in which EIP 1408 gains speed at Idzikowice."""
    clock = scenario.clock.model_copy(update={"start": 28_500.0, "end": 29_100.0})
    results, outcome, _ = run_in_memory(scenario.model_copy(update={"clock": clock}))
    assert outcome.run["status"] == "complete"
    return results


def test_bonded_rails_are_nearly_one_conductor(cmk, common_return):
    bonded, common = (in_the_peak(scenario) for scenario in (cmk, common_return))
    trains = [results.table("trains").set_index(["time_s", "train"])["voltage_v"] for results in (bonded, common)]
    assert len(trains[0]) > 5000
    apart = (trains[0] - trains[1]).abs()
    assert 0.1 < apart.mean() < 3.0
    assert trains[0].min() < 2950.0
    rails = bonded.table("rail_profile")
    assert set(rails["track"]) == {"1", "2"}
    assert 20.0 < rails["highest_potential_v"].max() < 120.0
    assert "rail_profile" not in common.tables or common.table("rail_profile").empty


def test_feeders_carry_what_their_substation_feeds(cmk):
    results = in_the_peak(cmk)
    feeders, stations = results.table("feeders"), results.table("substations")
    to_line = feeders[feeders["side"] != "return"].groupby(["time_s", "substation"], observed=True)["current_a"].sum()
    back = feeders[feeders["side"] == "return"].groupby(["time_s", "substation"], observed=True)["current_a"].sum()
    fed = stations.set_index(["time_s", "substation"])["current_a"]
    assert (to_line - fed).abs().max() < 0.01
    assert (back - fed).abs().max() < 0.01
    assert feeders.loc[feeders["side"] == "return", "track"].nunique() == 2


@pytest.mark.slow
def test_the_supply_carries_the_day(cmk):
    results = tractionpower.simulate(cmk)
    assert results.run["status"] == "complete"
    assert results.run["flagged_steps"] == 0
    assert results.run["overlaps"]["count"] == 0
    assert {note["status"] for note in results.run["trains"]} == {"left", "on_line"}  # some are on their way at midnight
    assert results.table("calls")["late_s"].max() < 60.0
    assert 2600.0 < results.table("trains")["voltage_v"].min() < 2950.0  # a load worth designing for, above U_min2 with ease
    assert "tripped" not in set(results.table("events")["kind"])
    assert 2000.0 < results.table("feeders")["current_a"].max() < 2500.0  # an older setting would trip, those assumed do not
