import pytest
from chains import WEDGE, pulled

import tractionpower as tp

COMMANDS = [{"time_s": 0.0, "drive": 1}, {"time_s": 3.0, "drive": 0, "brake": 12}]


def small():
    return pulled(3, WEDGE, commands=COMMANDS, brake={"brake_ratio": 0.6}, run={"duration_s": 20.0, "record_every_s": 0.5})


def test_memory_and_folder_hold_the_same(tmp_path):
    memory, disk = tp.simulate_case(small()), tp.simulate_case(small(), tmp_path / "out")
    assert memory.tables == disk.tables and memory.run["input_hash"] == disk.run["input_hash"]
    for table in memory.tables:
        assert memory.table(table).astype(str).equals(disk.table(table).astype(str)), table
    assert memory.key_figure("stopping_distance_m") == disk.key_figure("stopping_distance_m") > 1.0
    assert disk.scenario == small()


def test_a_case_is_named_as_on_the_command_line(tmp_path):
    seen = []
    results = tp.simulate_case("arshad", tmp_path / "out", progress=lambda *now: seen.append(now))
    assert results.run["study"] == "arshad" and any("State vector" in warning for warning in results.run["warnings"])
    assert seen[-1] == (30_000, 30_000)
    with pytest.raises(tp.UsageError, match="another study"):
        tp.simulate_case("russian-start", tmp_path / "out")


def test_cases_of_stations_run_by_the_same_call():
    pytest.importorskip("simpy")
    results = tp.simulate_case("traindyn-three-stations")
    assert results.run["kind"] == "stations" and set(results.tables) == {"point_masses", "station_events"}


def test_a_case_with_errors_leaves_no_folder(tmp_path):
    wrong = pulled(3, WEDGE, run={"duration_s": 20.0, "step_s": 0.2, "record_every_s": 0.5})
    with pytest.raises(tp.InputError, match="at most"):
        tp.simulate_case(wrong, tmp_path / "out")
    assert not (tmp_path / "out").exists()
    with pytest.raises(tp.UsageError, match="no case"):
        tp.simulate_case("nowhere", tmp_path / "out")


def test_a_case_is_changed_by_its_keys():
    heavy = tp.change(small(), ["case.run.duration_s=5", "vehicles[wagon].mass_t=120"])
    assert heavy.case.run.duration_s == 5.0 and heavy.vehicle("wagon").mass_t == 120.0
    assert tp.simulate_case(heavy).run["end_s"] == pytest.approx(5.0)
    with pytest.raises(tp.InputError):
        tp.change(small(), ["case.run.duration=5"])
