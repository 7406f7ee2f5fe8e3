"""Kinds of trains of a timetable."""

from types import SimpleNamespace

from tractionpower.model.vehicle import Part, Train
from tractionpower.reporting.facts.formations import kind_of, kinds_of_trains

COACHES = Train(id="coaches", vehicles=(Part(id="loco"), Part(id="coach", count=9)))


def run(name, train=None, *parts):
    return SimpleNamespace(id=name, train=train, category=None, vehicles=parts)


def test_vehicles_are_named_from_the_front():
    assert kind_of(run("1", "coaches")) == "coaches"
    assert kind_of(run("1", None, Part(id="loco"), Part(id="wagon", count=30))) == "loco + 30 x wagon"


def test_each_kind_stands_once_and_the_most_frequent_first():
    full, empty = (Part(id="wagon", count=2, load_percent=load) for load in (100.0, 0.0))
    loco = Part(id="loco")
    runs = [run("1", "coaches"), run("2", None, loco, full), run("3", None, loco, full), run("4", None, loco, empty)]
    kinds = kinds_of_trains(runs, [COACHES])
    assert next(iter(kinds)) == "loco + 2 x wagon"
    assert set(kinds) == {"loco + 2 x wagon", "loco + 2 x wagon (2)", "coaches"}
    assert kinds["coaches"] is COACHES
    assert kinds["loco + 2 x wagon"].vehicles == (loco, full)
    assert kinds["loco + 2 x wagon (2)"].vehicles == (loco, empty)
