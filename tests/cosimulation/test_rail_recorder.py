"""What the recorder of rails sums up, against the closed form of a leaky line."""

import json
from itertools import pairwise

import numpy as np
import pytest
from fake_rails import RAIL_OHM_PER_KM, leaky_v, make_recorder, rail_places, rows_of, train_rows
from small_studies import make_scenario, run_in_memory

from tractionpower.cli.run_summary import sentence
from tractionpower.cosimulation.events import EventLog, message
from tractionpower.cosimulation.rail_recorder import MOST_PLACES, RailRecorder
from tractionpower.cosimulation.run import Run
from tractionpower.kernels.block import advance
from tractionpower.kernels.block_tables import new_buffers
from tractionpower.model.scenario import Scenario
from tractionpower.results.results import Results
from tractionpower.results.store import MemoryWriter

LENGTH_KM = 10.0
KM = np.linspace(0.0, LENGTH_KM, 101)


def one_train(km, s_per_km, current_a=1000.0):
    """Return potentials [V] with a train at 0 km and a floating substation at the end of the line."""
    put_in, taken = (leaky_v(km, at, 1.0, LENGTH_KM, s_per_km) for at in (0.0, LENGTH_KM))
    return current_a * (put_in - taken)


def figures(recorder):
    return {(each.name, each.place): each for each in recorder.figures()}


def named(recorder, name):
    (found,) = [each for each in recorder.figures() if each.name == name]
    return found


class Tables(dict):
    """Keeps what is appended."""

    def append(self, name, table):
        self.setdefault(name, []).append(table.to_pandas())


@pytest.mark.parametrize(
    ("s_per_km", "at_train_v", "at_middle_a"), [(0.1, 27.37, 6.84), (0.5, 26.89, 33.42), (2.5, 24.73, 150.28)]
)
def test_one_train_and_one_substation(s_per_km, at_train_v, at_middle_a):
    """Published values for 10 km of 0.0055 ohm/km: I Zc tanh(alpha L/2), and I (1 - 1/cosh(alpha L/2)) past the middle."""
    volts = one_train(KM, s_per_km)
    recorder = make_recorder(rail_places("1 2", KM, s_per_km))
    recorder.add(np.arange(4.0), rows_of(np.tile(volts, (4, 1)), leaked_a=at_middle_a))
    assert named(recorder, "highest_rail_potential_v").value == pytest.approx(at_train_v, abs=0.005)
    assert named(recorder, "lowest_rail_potential_v").value == pytest.approx(-at_train_v, abs=0.005)
    assert named(recorder, "highest_rail_potential_v").place == "tracks 1 2, km 0.00"
    profile = recorder.profile().to_pandas()
    leaving = (profile["mean_leaving_a_per_km"] * profile["length_km"]).sum()
    assert leaving == pytest.approx(at_middle_a, rel=1e-3)  # what has left the rails comes back past the middle
    assert (profile["mean_leakage_a_per_km"] * profile["length_km"]).sum() == pytest.approx(0.0, abs=1e-3)
    assert profile["length_km"].sum() == pytest.approx(LENGTH_KM)
    np.testing.assert_allclose(profile["mean_potential_v"], volts, rtol=1e-5, atol=1e-4)
    np.testing.assert_allclose(profile["leakage_s_per_km"], s_per_km, rtol=1e-6)
    stray = named(recorder, "highest_mean_stray_current_ma_per_m").value
    assert stray == pytest.approx(s_per_km * at_train_v / 2.0, rel=1e-3)  # two tracks
    assert named(recorder, "leaked_charge_ah").value == pytest.approx(at_middle_a * 4.0 / 3600.0)


def test_the_closed_form_is_that_of_the_differential_equation():
    km, g = np.linspace(0.0, LENGTH_KM, 20001), 0.5
    volts = leaky_v(km, 3.0, 800.0, LENGTH_KM, g)
    step = km[1] - km[0]
    curvature = np.diff(volts, 2) / step**2
    free = np.abs(km[1:-1] - 3.0) > 2 * step
    np.testing.assert_allclose(curvature[free], RAIL_OHM_PER_KM * g * volts[1:-1][free], rtol=1e-3, atol=1e-4)
    assert np.trapezoid(g * volts, km) == pytest.approx(800.0, rel=1e-6)


def test_means_do_not_depend_on_pieces():
    rng = np.random.default_rng(3)
    volts, earth = rng.normal(0.0, 90.0, (50, 7)), rng.normal(0.0, 5.0, (50, 2))
    told = []
    for cuts in ((0, 50), (0, 1, 2, 30, 50)):
        recorder = make_recorder(rail_places("1", np.arange(7.0), 0.5), devices=("E", "D"))
        for a, b in pairwise(cuts):
            recorder.add(np.arange(a, b, dtype=float), rows_of(volts[a:b], earth[a:b], np.abs(volts[a:b, 0])))
        told.append((recorder.profile(), recorder.summary(), [each.as_dict() for each in recorder.figures()]))
    assert told[0] == told[1]


def test_the_positive_part_leaves_the_rails():
    recorder = make_recorder(rail_places("1", np.array([0.0, 1.0]), 0.4))
    recorder.add(np.arange(4.0), rows_of([[10.0, 0.0], [-10.0, 0.0], [30.0, 0.0], [-30.0, 0.0]]))
    profile = recorder.profile().to_pandas()
    assert profile["mean_leakage_a_per_km"].tolist() == [0.0, 0.0]
    assert profile["mean_leaving_a_per_km"].tolist() == pytest.approx([4.0, 0.0])
    assert named(recorder, "highest_mean_stray_current_ma_per_m").value == pytest.approx(4.0)


def test_rows_of_rails_are_single_steps_at_the_interval():
    scenario = make_scenario(clock={"end": 400.0, "step_s": 2.0}, output={"rails_every_s": 60.0})
    recorder, tables = make_recorder(rail_places("1", np.array([0.0, 1.0]), 0.4), scenario), Tables()
    number = np.arange(7, 70)
    volts = np.stack([number, -number], axis=1).astype(float)
    recorder.write(number, number * 2.0, rows_of(volts), tables.append)
    (rows,) = tables["rails"]
    assert rows["time_s"].tolist() == [60.0, 60.0, 120.0, 120.0]
    assert rows["potential_v"].tolist() == [30.0, -30.0, 60.0, -60.0]
    assert rows["leakage_a_per_km"].tolist() == pytest.approx([12.0, -12.0, 24.0, -24.0])
    recorder.write(np.arange(1, 5), np.arange(1, 5) * 2.0, rows_of(volts[:4]), tables.append)
    assert len(tables["rails"]) == 1


def test_many_places_are_thinned_and_those_of_devices_stay():
    km = np.round(np.arange(0.0, 20.05, 0.1), 1)
    device = {"id": "D", "track": "2", "km": 3.3, "closes": [{"above_v": 120.0}]}
    scenario = make_scenario(voltage_limiting_devices=[device])
    places = (*rail_places("1", km, 0.4), *rail_places("2", km, 0.4))
    assert len(places) > MOST_PLACES
    recorder = make_recorder(places, scenario)
    told = {track: [p.km for p in np.array(places, object)[recorder.told] if p.tracks == track] for track in "12"}
    assert told["1"] == [float(k) for k in range(21)]
    assert 3.3 in told["2"]
    assert {0.0, 10.0, 20.0} <= set(told["2"])  # substations and cabin
    assert np.diff(told["2"]).max() < 1.3
    assert len(recorder.profile()) == len(places)
    assert len(make_recorder(places[:100], scenario).told) == 100


def test_trains_have_the_peak():
    recorder = make_recorder(rail_places("1", np.array([0.0, 1.0]), 0.4), trains=("X", "Y"))
    recorder.add(np.arange(2.0), rows_of([[10.0, -5.0], [0.0, 0.0]]))
    recorder.add_trains(*train_rows([0.0, 0.0, 1.0], [0, 1, 1], [12.5, np.nan, 3.0], [0.25, 0.5, 0.75]))
    highest, lowest = named(recorder, "highest_rail_potential_v"), named(recorder, "lowest_rail_potential_v")
    assert (highest.value, highest.place, highest.time) == (12.5, "train X, track 1, km 0.25", "00:00:00")
    assert (lowest.value, lowest.place) == (-5.0, "track 1, km 1.00")


def test_spells_at_places_and_under_trains_are_judged():
    recorder = make_recorder(rail_places("1", np.array([0.0, 1.0]), 0.4), trains=("X",))
    time_s = np.arange(400.0)
    at = np.where(time_s < 310.0, 125.0, 0.0)
    recorder.add(time_s, rows_of(np.stack([at, 0.0 * at], axis=1)))
    verdicts = {each["limit"]: each for each in recorder.verdicts()}
    permanent = verdicts["touch_permanent"]
    assert (permanent["value"], permanent["limit_value"], permanent["met"]) == (310.0, 300.0, False)
    assert (permanent["place"], permanent["status"]) == ("track 1, km 0.00", "secondary")
    assert permanent["name"] == "longest spell of the rail potential above 120 V"
    told = "longest spell of the rail potential above 120 V"
    log = EventLog.__new__(EventLog)
    log.rows, log.start_s = [], 0.0
    log.add_violations([permanent])
    assert message(log.rows[0]) == f"{told}: 310.0 s at track 1, km 0.00, may last 300 s (touch_permanent: 120 V)"
    assert sentence(permanent) == (
        f"{told} 310.0 s at track 1, km 0.00, at 00:00:00: VIOLATED"
        " (may last 300 s, touch_permanent: 120 V, source status: secondary)"
    )
    recorder.add_trains(*train_rows(time_s, np.zeros(400, int), np.full(400, -130.0), time_s / 400.0))
    permanent = {each["limit"]: each for each in recorder.verdicts()}["touch_permanent"]
    assert (permanent["value"], permanent["place"]) == (400.0, "train X, from track 1, km 0.00")
    assert named(recorder, "longest_spell_above_touch_permanent_s").value == 400.0
    assert not [each for each in recorder.verdicts() if each["limit"].startswith("stray")]  # no day
    assert json.loads(json.dumps(recorder.summary()))["return_circuit"]["places"] == 2


def test_a_day_is_judged_for_stray_currents():
    scenario = make_scenario(clock={"end": 86400.0, "step_s": 5.0})
    recorder = make_recorder(rail_places("1", np.array([0.0, 1.0]), 0.5), scenario)
    time_s = np.arange(0.0, 86400.0, 5.0)
    recorder.add(time_s, rows_of(np.tile([6.0, -6.0], (len(time_s), 1))))
    stray = {each["limit"]: each for each in recorder.verdicts() if each["limit"].startswith("stray")}
    assert stray["stray_current"]["value"] == pytest.approx(3.0)
    assert (stray["stray_shift_open"]["value"], stray["stray_shift_open"]["met"]) == (pytest.approx(6.0), False)


def test_devices_have_currents_potentials_and_charges():
    supply = {
        "earthing": [{"id": "E", "track": "1", "km": 0.0, "resistance_ohm": 2.0}],
        "voltage_limiting_devices": [{"id": "D", "track": "1", "km": 1.0, "closes": [{"above_v": 120.0}]}],
    }
    scenario = make_scenario(**supply)
    recorder, tables = make_recorder(rail_places("1", np.array([0.0, 1.0]), 0.4), scenario, ("E", "D")), Tables()
    rows = rows_of([[20.0, 90.0], [-40.0, 5.0]], [[10.0, 0.0], [-20.0, 50.0]])
    recorder.add(np.array([0.0, 1.0]), rows)
    recorder.write_devices(np.array([0.0, 1.0]), rows, tables.append)
    (written,) = tables["earthing"]
    assert written["device"].tolist() == ["E", "D", "E", "D"]
    assert written["potential_v"].tolist() == [20.0, 90.0, -40.0, 5.0]
    assert written["current_a"].tolist() == [10.0, 0.0, -20.0, 50.0]
    found = figures(recorder)
    assert found["charge_through_earth_ah", "earthing E"].value == pytest.approx(30.0 / 3600.0)
    assert found["time_with_earth_current_s", "voltage-limiting device D"].value == 1.0
    lowest = found["lowest_current_into_earth_a", "earthing E"]
    assert (lowest.value, lowest.time) == (-20.0, "00:00:01")
    assert found["mean_current_into_earth_a", "voltage-limiting device D"].value == 25.0


def test_without_earth_nothing_is_told():
    recorder, tables = make_recorder(()), Tables()
    rows = rows_of(np.zeros((3, 0)))
    recorder.add(np.arange(3.0), rows)
    recorder.write(np.arange(3), np.arange(3.0), rows, tables.append)
    recorder.write_devices(np.arange(3.0), rows, tables.append)
    assert (recorder.verdicts(), recorder.summary(), list(recorder.figures()), tables) == ([], {}, [], {})


def test_a_place_whose_potential_is_not_defined_counts_nowhere():
    recorder, tables = make_recorder(rail_places("1", np.array([0.0, 1.0]), 0.4)), Tables()
    nothing = make_recorder(rail_places("1", np.array([0.0, 1.0]), 0.4))
    volts = np.array([[np.nan, 4.0], [np.nan, np.nan], [np.nan, 8.0]])
    rows = rows_of(volts)
    recorder.add(np.arange(3.0), rows)
    nothing.add(np.arange(3.0), rows_of(volts * np.nan))
    recorder.write(np.arange(3), np.arange(3.0), rows, tables.append)
    profile = recorder.profile().to_pandas()
    assert np.isnan(profile["mean_potential_v"][0])
    assert profile["mean_potential_v"][1] == 6.0
    assert named(recorder, "lowest_rail_potential_v").value == 4.0
    assert recorder.summary()["return_circuit"]["stray_current"][0]["place"] == "track 1, km 1.00"
    assert tables["rails"][0]["potential_v"].isna().tolist() == [True, False]
    assert not [each for each in nothing.figures() if "rail_potential_v" in each.name]
    assert nothing.summary()["return_circuit"]["stray_current"] == []


def test_a_recorder_hands_on_what_blocks_hold():
    """The recorder of a run gives its rows to that of the rails: tables, figures, verdicts, with the warm-up left out."""
    plain = make_scenario({"id": "x", "track": "1", "km": 5.0, "current_a": 500.0}, clock={"end": 130.0}).model_dump(
        by_alias=True
    )
    plain["clock"] |= {"warm_up": 30.0}
    scenario, writer = Scenario.model_validate(plain), MemoryWriter()
    run = Run(scenario, writer)
    places = rail_places("1 2", np.array([0.0, 20.0]), 0.5)
    run.recorder.rails = make_recorder(places, scenario)
    assert isinstance(run.recorder.rails, RailRecorder)
    buffers = new_buffers(run.compiled.block, 130)
    steps, _ = advance(run.compiled.block, run.state, buffers, 130)
    volts = np.where(np.arange(130)[:, None] < 30, 500.0, [[7.0, -9.0]])
    run.recorder.add(0, steps, buffers._replace(rail_v=volts, earth_a=np.zeros((130, 0))), run.compiled.supply)
    run.recorder.close()
    results = Results(run.outcome().run, run.recorder.key_figures(), writer.tables())
    assert results.key_figure("highest_rail_potential_v") == 7.0
    assert results.table("rails")["potential_v"].tolist() == [500.0, 500.0, 7.0, -9.0, 7.0, -9.0]
    assert results.table("rail_profile")["lowest_potential_v"].tolist() == [7.0, -9.0]
    assert {row["limit"] for row in results.run["return_circuit"]["touch_voltage"]} >= {"touch_permanent", "touch_1s"}
    assert {each["limit"] for each in results.run["verdicts"]} >= {"u_min2", "touch_permanent"}


@pytest.mark.parametrize("s_per_km", [0.1, 0.5, 2.5])
def test_a_run_on_leaky_rails_meets_the_closed_form(s_per_km):
    """One load at an end, one floating substation at the other: every place, the leaked current, the tables."""
    stretch = {"from_km": 0.0, "to_km": LENGTH_KM}
    rails = {"resistance_ohm_per_km": RAIL_OHM_PER_KM, "leakage_s_per_km": s_per_km}
    scenario = make_scenario(
        {"id": "x", "track": "1", "km": 0.0, "current_a": 1000.0},
        tracks=("1",),
        substations=[{"id": "S", "km": LENGTH_KM, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12}],
        contact_lines=[stretch | {"resistance_ohm_per_km": 0.05}],
        return_circuit=[stretch | rails],
        section_points=[{"id": f"p{k}", "track": "1", "km": float(k), "state": "closed"} for k in range(1, 10)],
        clock={"end": 120.0},
    )
    line = scenario.line.model_copy(
        update={"tracks": tuple(t.model_copy(update={"to_km": LENGTH_KM}) for t in scenario.line.tracks)}
    )
    results, _, _ = run_in_memory(scenario.model_copy(update={"line": line}))
    profile = results.table("rail_profile")
    expected = one_train(profile["km"].to_numpy(), s_per_km)
    np.testing.assert_allclose(profile["mean_potential_v"], expected, rtol=1e-3, atol=1e-4)
    assert profile["length_km"].sum() == pytest.approx(LENGTH_KM)
    alpha = np.sqrt(RAIL_OHM_PER_KM * s_per_km)
    leaked = 1000.0 * (1.0 - 1.0 / np.cosh(alpha * LENGTH_KM / 2.0))
    assert results.key_figure("mean_leaked_current_a") == pytest.approx(leaked, rel=1e-3)
    assert results.key_figure("leaked_charge_ah") == pytest.approx(leaked / 30.0, rel=1e-3)
    assert sorted(set(results.table("rails")["time_s"])) == [0.0, 60.0]
    assert {each["limit"]: each["met"] for each in results.run["verdicts"]}["touch_permanent"]
