"""Events of trains against the rows, scanned one after the other."""

import pytest
from coupled import couple, run
from small_studies import run_in_memory

NAMES = ("E1", "E2", "E3", "M1", "M2", "S1", "S2", "T1")
LIMITED = ("line_current", "train_current", "voltage")


def events(results, kind, subject=None):
    table = results.table("events")
    found = table[table["kind"] == kind]
    return found if subject is None else found[found["subject"] == subject]


def spells(rows, inside):
    """Return (start, end, worst of the lowest, place) of each unbroken spell, found row by row."""
    found, now = [], None
    for row, is_inside in zip(rows.itertuples(), inside, strict=True):
        if is_inside and now is None:
            now = [row.time_s, row.time_s, [], row.position_km]
            found.append(now)
        if is_inside:
            now[1] = row.time_s + 1.0
            now[2].append(row.voltage_v)
        else:
            now = None
    return found


@pytest.mark.parametrize(
    ("kind", "inside", "pick"),
    [
        ("low_voltage", lambda rows: rows["voltage_v"] < 1999.9, min),
        ("high_voltage", lambda rows: rows["voltage_v"] > 3900.1, max),
        (
            "current_limited",
            lambda rows: rows["limited_by"].isin(LIMITED) & (rows["tractive_force_kn"] < rows["wished_force_kn"]),
            min,
        ),
    ],
)
def test_spells_are_those_of_the_rows(busy, kind, inside, pick):
    count = 0
    for name in NAMES:
        rows = busy.rows(name)
        expected = spells(rows, inside(rows))
        found = events(busy.results, kind, name).sort_values("time_s")
        assert list(found["time_s"]) == [spell[0] for spell in expected]
        for (_, event), (start, end, volts, km) in zip(found.iterrows(), expected, strict=True):
            assert event["value"] == pytest.approx(pick(volts), rel=1e-6)
            assert event["position_km"] == pytest.approx(km)
            assert event["track"] == rows["track"].iloc[0]
            clock = [f"{int(t) // 3600:02}:{int(t) % 3600 // 60:02}:{int(t) % 60:02}" for t in (start, end)]
            assert event["message"].startswith(f"{clock[0]} to {clock[1]}: ")
        count += len(found)
    assert count == len(events(busy.results, kind)) > 0


def test_limits_are_named(busy):
    low, high = events(busy.results, "low_voltage"), events(busy.results, "high_voltage")
    assert set(low["limit"]) == {2000.0}
    assert set(high["limit"]) == {3900.0}
    assert "limited by train current" in events(busy.results, "current_limited", "E1")["message"].iloc[0]
    assert "limited by voltage" in events(busy.results, "current_limited", "E2")["message"].iloc[0]


def test_every_train_enters_once_and_those_that_leave_do_so_once(busy):
    starts = {planned.id: planned.start.time for planned in busy.scenario.timetable.trains}
    entered = events(busy.results, "train_entered").set_index("subject")["time_s"]
    assert entered.to_dict() == starts
    said = {each["train"]: each for each in busy.results.run["trains"]}
    left = events(busy.results, "train_left").set_index("subject")
    assert left["time_s"].to_dict() == {name: said[name]["finished_s"] for name in NAMES if name != "E2"}
    assert left["position_km"].to_dict() == {"E1": 20, "E3": 0, "M1": 20, "M2": 0, "S1": 20, "S2": 20, "T1": 4}


def test_stops_and_departures_are_those_of_the_calls(busy):
    calls = busy.results.table("calls")
    for kind, row_kind in (("stop", "arrival"), ("departure", "departure")):
        rows = calls[calls["kind"] == row_kind]
        expected = sorted(zip(rows["train"], rows["actual_s"], rows["station"], strict=True))
        found = sorted(
            (event["subject"], event["time_s"], event["message"].split()[-1])
            for _, event in events(busy.results, kind).iterrows()
        )
        assert found == expected


def test_a_train_that_stays_does_not_depart(busy):
    assert len(events(busy.results, "stop", "E2")) == 2
    assert list(events(busy.results, "departure", "E2")["position_km"]) == [13.0]
    assert events(busy.results, "train_left", "E2").empty


def test_what_happens_at_the_same_time_is_told_in_its_order(busy):
    table = busy.results.table("events")
    assert table["time_s"].is_monotonic_increasing
    at_p = table[(table["subject"] == "M1") & (table["position_km"] == 6.0)]
    assert at_p["time_s"].nunique() == 1  # it has no dwell there
    assert list(at_p["kind"]) == ["stop", "departure"]
    at_end = table[(table["subject"] == "M1") & (table["position_km"] == 20.0)]
    assert list(at_end["kind"]) == ["stop", "train_left"]


def test_motors_regroup_in_steps_of_the_groupings(busy):
    for name in ("M1", "M2"):
        found = events(busy.results, "regrouped", name)
        assert len(found) >= 1
        assert set(found["value"]) | set(found["limit"]) == {2.0, 4.0}
        assert (found["value"] != found["limit"]).all()
        assert (found["limit"].iloc[1:].to_numpy() == found["value"].iloc[:-1].to_numpy()).all()
    assert events(busy.results, "regrouped", "E1").empty


def test_a_train_of_before_the_clock_does_not_enter():
    scenario = couple(run("E", time=10.0, high=3.0), run("F", time=120.0), end_s=400.0)
    later = scenario.model_copy(update={"clock": scenario.clock.model_copy(update={"start": 60.0})})
    results, _, _ = run_in_memory(later)
    assert list(events(results, "train_entered")["subject"]) == ["F"]
    assert list(events(results, "train_left")["subject"]) == ["E"]
