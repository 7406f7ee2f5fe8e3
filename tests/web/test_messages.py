"""Messages to the page."""

import json
import math

import numpy as np
import pytest
from fake_session import FakeSession, fake_hello

from tractionpower.web.messages import chart_point, frame_message, message, statistics_message
from tractionpower.web.quantities import CHARTS, PANEL


def driven(seconds=30.0):
    session = FakeSession()
    session.set(drive=12)
    session.advance(seconds)
    session.set(drive=0, brake=6)
    session.advance(seconds + 10.0)
    return session


def test_a_frame_holds_every_number_of_the_panel_and_of_the_diagrams():
    snapshot = json.loads(frame_message({"snapshot": driven().snapshot(), "desk": {}}))["snapshot"]
    assert {shown.name for shown in PANEL} <= {*snapshot}
    peaks = {"first_coupling_least_kn", "first_coupling_greatest_kn"}  # of the time between two points of a diagram
    assert {name for chart in CHARTS for name in chart} - peaks <= {*snapshot}
    assert len(snapshot["forces_kn"]) == 20
    assert all(isinstance(snapshot[shown.name], int | float) for shown in PANEL)


def test_numbers_that_json_does_not_know_become_null():
    text = message("frame", {"a": math.inf, "b": [math.nan, 1.0], "c": np.float64(2.5), "d": np.arange(3)})
    assert json.loads(text) == {"kind": "frame", "a": None, "b": [None, 1.0], "c": 2.5, "d": [0, 1, 2]}


def test_texts_of_users_stay_texts():
    name = 'a</script><b onclick="x">"é\u2028'
    assert json.loads(message("hello", fake_hello(name=name)))["name"] == name


def test_a_chart_point_has_the_time_and_all_diagrams():
    session = driven()
    point = chart_point(session.snapshot(), (-1.0, 2.0))
    assert point[0] == pytest.approx(session.time_s)
    assert point[1:3] == [0, 6]
    assert point[6:8] == [-1.0, 2.0]
    assert len(point) == 1 + sum(map(len, CHARTS))


def test_frequencies_of_each_distribution_add_up_to_one():
    found = json.loads(statistics_message(driven().statistics()))
    for name in ("drive_speed", "brake_speed"):
        assert sum(map(sum, found[name]["rows"])) == pytest.approx(1.0, abs=1e-4)
    for name in ("force", "acceleration"):
        assert sum(found[name]["bars"]) == pytest.approx(1.0, abs=1e-4)


def statistics_of(**more):
    edges = {
        "speed_edges_kmh": [0.0, 10.0, 20.0],
        "force_edges_kn": [-10.0, 0.0, 10.0],
        "acceleration_edges_mps2": [-1.0, 0.0, 1.0],
    }
    empty = {"drive_speed": np.zeros((2, 4)), "brake_speed": np.zeros((2, 4)), "force": np.zeros(4), "acceleration": np.zeros(4)}
    return {**empty, **edges, "rainflow": [], **more}


def test_time_beyond_the_bins_is_shown_in_the_outer_ones():
    found = json.loads(statistics_message(statistics_of(force=np.array([0.1, 0.2, 0.3, 0.4]))))
    assert found["force"] == {"lowest": -10.0, "width": 10.0, "bars": [0.3, 0.7]}


def test_empty_bins_at_the_ends_are_left_out():
    found = json.loads(statistics_message(statistics_of(force=np.array([0.0, 0.0, 1.0, 0.0]))))
    assert found["force"] == {"lowest": 0.0, "width": 10.0, "bars": [1.0]}


def test_nothing_has_happened_yet():
    found = json.loads(statistics_message(statistics_of()))
    assert all(found[name]["bars"] == [] for name in ("force", "acceleration", "rainflow"))


def test_cycles_are_counted_by_range_and_none_is_lost():
    cycles = [(100.0, 0.0, 1.0), (240.0, 5.0, 0.5), (99.0, -3.0, 2.0)]
    found = json.loads(statistics_message(statistics_of(rainflow=cycles)))["rainflow"]
    assert sum(found["bars"]) == 3.5
    assert found["width"] * len(found["bars"]) == pytest.approx(240.0)
    assert found["bars"][int(100.0 / found["width"])] == 1.0
    assert found["bars"][-1] == 0.5
