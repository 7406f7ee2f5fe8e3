"""Rotations, joins and splits as links, and as rows of the tables."""

from coupled import couple, run, vehicle

from tractionpower.kernels.train_tables import LEAVE, STAY, STOP_THERE
from tractionpower.model.services import DAY_BEFORE
from tractionpower.model.timetable import Timetable
from tractionpower.movement.compile import compile_trains
from tractionpower.movement.turns import links_of, together

TURNS = Timetable.model_validate(
    {
        "rotations": [{"runs": ["a", "b", "c"], "turn_round_s": 60.0}],
        "joins": [{"portions": ["c", "d"], "into": "e", "coupling_s": 90.0}],
        "splits": [{"run": "e", "portions": ["g", "f"]}],
    }
)


def pairs(names):
    return [(link.first, link.then, link.turn_s) for link in links_of(TURNS, names)]


def test_links_are_those_between_runs_of_the_day():
    assert pairs("abcdefg") == [
        ("a", "b", 60.0), ("b", "c", 60.0), ("c", "e", 90.0), ("d", "e", 90.0), ("e", "f", 0.0), ("e", "g", 0.0),
    ]  # fmt: skip
    assert pairs("acde") == [("c", "e", 90.0), ("d", "e", 90.0)]
    night = ["a", "a" + DAY_BEFORE, "b" + DAY_BEFORE]
    assert pairs(night) == [("a" + DAY_BEFORE, "b" + DAY_BEFORE, 60.0)]


def test_portions_stand_together():
    assert together(TURNS, list("abcdefg")) == {(2, 3), (5, 6)}


def movement_of(*runs, **turns):
    scenario = couple(*runs, vehicles=[vehicle("inverter")])
    table = Timetable.model_validate({"trains": list(runs), **turns})
    return compile_trains(scenario.model_copy(update={"timetable": table}))


def test_the_tables_say_who_waits_and_who_stays():
    at_p = [{"station": "P", "departure": 900.0}, {"station": "B"}]
    runs = (
        run("a", high=6.0, calls=[{"station": "P"}]),
        run("b", high=6.0),  # leaves the line at its end
        run("c", low=6.0, time=900.0, calls=at_p),
        run("d", low=6.0, time=900.0, speed_kmh=50.0),
    )
    trains = movement_of(*runs, rotations=[{"runs": ["a", "c"]}, {"runs": ["b", "d"]}]).tables.trains
    assert trains["end"].tolist() == [STAY, LEAVE, STOP_THERE, LEAVE]
    assert trains["waits"].tolist() == [0, 0, 1, 1]
    assert trains["takes_over"].tolist() == [False, False, True, False]
    tables = movement_of(*runs, splits=[{"run": "a", "portions": ["c", "d"]}]).tables
    assert [tables.turns["then"].tolist(), tables.trains["turns"].tolist()] == [[2, 3], [2, 0, 0, 0]]
    assert len(movement_of(*runs).tables.turns) == 0
