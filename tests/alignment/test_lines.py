"""Which tracks share a kilometre axis."""

import pytest

from tractionpower.alignment.lines import tracks_by_line
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply

REST = {"no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.1}


def make_line(ends, connections=(), stations=()):
    return Line.model_validate(
        {
            "tracks": [{"id": name, "from_km": a, "to_km": b} for name, (a, b) in ends.items()],
            "connections": [
                {"from": {"track": one, "km": at}, "to": {"track": other, "km": there}} for one, at, other, there in connections
            ],
            "stations": [{"id": f"S{k}", "km": 5.0, "tracks": tracks} for k, tracks in enumerate(stations)],
        }
    )


def make_supply(contact=(None,), returns=(None,), **lists):
    rows = {
        "contact_lines": [{"from_km": 0.0, "to_km": 9.0, "resistance_ohm_per_km": 0.05, "tracks": tracks} for tracks in contact],
        "return_circuit": [{"from_km": 0.0, "to_km": 9.0, "resistance_ohm_per_km": 0.01, "tracks": tracks} for tracks in returns],
    }
    return Supply.model_validate(rows | lists)


DOUBLE = {"1": (0.0, 26.0), "2": (0.0, 26.0)}
JUNCTION = [("1", 12.4, "3", 14.6), ("3", 14.4, "2", 12.2)]


def test_a_double_track_line_with_crossovers_at_equal_kilometres_is_one_line():
    assert tracks_by_line(make_line(DOUBLE, [("1", 10.0, "2", 10.0), ("1", 20.0, "2", 20.001)])) == (("1", "2"),)


def test_connections_at_other_kilometres_tell_a_branch_apart():
    line = make_line(DOUBLE | {"3": (0.0, 14.6)}, JUNCTION)
    assert tracks_by_line(line) == (("1", "2"), ("3",))
    everywhere = make_supply(contact=[["1", "2", "3"]])
    assert tracks_by_line(line, everywhere) == (("1", "2"), ("3",))


def test_both_tracks_of_a_branch_go_together_whether_a_name_or_a_crossover_tells_it():
    ends = DOUBLE | {"3": (0.0, 14.6), "4": (0.0, 14.6)}
    assert tracks_by_line(make_line(ends, JUNCTION, [["3", "4"]])) == (("1", "2"), ("3", "4"))
    assert tracks_by_line(make_line(ends, [*JUNCTION, ("3", 7.0, "4", 7.0)])) == (("1", "2"), ("3", "4"))
    assert tracks_by_line(make_line(ends, JUNCTION), make_supply(contact=[["3", "4"]])) == (("1", "2"), ("3", "4"))


@pytest.mark.parametrize(
    "lists",
    [
        {"substations": [{"id": "A", "km": 3.0, "tracks": ["1", "2"], **REST}]},
        {"section_cabins": [{"id": "C", "km": 3.0, "tracks": ["1", "2"]}]},
        {"bonds": [{"from_km": 0.0, "to_km": 9.0, "every_km": 1.0, "tracks": ["1", "2"]}]},
        {"returns": [["1", "2"]]},
    ],
)
def test_a_place_named_on_both_tracks_outweighs_a_crossover_that_has_a_length(lists):
    line = make_line(DOUBLE, [("1", 10.0, "2", 10.08)])
    assert tracks_by_line(line, make_supply()) == (("1",), ("2",))
    assert tracks_by_line(line, make_supply(**lists)) == (("1", "2"),)


def test_tracks_without_evidence_go_with_those_that_they_overlap():
    ends = {"1": (0.0, 10.0), "2": (5.0, 20.0), "3": (30.0, 40.0), "4": (35.0, 36.0), "5": (20.0, 30.0)}
    assert tracks_by_line(make_line(ends)) == (("1", "2"), ("3", "4"), ("5",))


def test_the_order_of_the_input_does_not_matter():
    ends = DOUBLE | {"3": (0.0, 14.6)}
    turned = dict(reversed(ends.items()))
    assert tracks_by_line(make_line(turned, JUNCTION[::-1])) == tracks_by_line(make_line(ends, JUNCTION))
