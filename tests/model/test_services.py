"""Services become runs, days choose them, and what the day before has left runs at the start of the day."""

import pytest
from pydantic import ValidationError

from tractionpower.model.services import DAY_BEFORE, run_names, unfold
from tractionpower.model.timetable import Service, Timetable, TrainRun

ROUTE = [{"track": "1", "from_km": 0.0, "to_km": 20.0}]
CALLS = [{"station": "A", "departure": "00:00"}, {"station": "B", "arrival": "00:12:30", "departure": "00:13"}, {"station": "C"}]


def service(name="S", **more):
    plain = {"id": name, "train": "emu", "route": ROUTE, "first": "05:10", "last": "06:10", "headway_s": 1200.0, "calls": CALLS}
    return plain | more


def train(name, start, **more):
    return {"id": name, "train": "emu", "route": ROUTE, "start": {"time": start}} | more


def runs(*services, trains=(), day=None, **more):
    table = Timetable.model_validate({"services": list(services), "trains": list(trains), **more})
    return {run.id: run for run in unfold(table, day)}


def test_a_service_becomes_runs_with_the_times_of_day():
    found = runs(service(start_speed_kmh=40.0, max_current_a=900.0, category="local", end="leave"))
    assert list(found) == ["S 05:10", "S 05:30", "S 05:50", "S 06:10"]
    second = found["S 05:30"]
    assert (second.start.time, second.start.speed_kmh) == (19800.0, 40.0)
    times = [(call.arrival, call.departure) for call in second.calls]
    assert times == [(None, 19800.0), (19800.0 + 750.0, 19800.0 + 780.0), (None, None)]
    assert (second.train, second.max_current_a, second.category, second.end) == ("emu", 900.0, "local", "leave")


def test_a_run_of_a_service_equals_the_train_written_out():
    written = train("S 05:10", "05:10", calls=[CALLS[0] | {"departure": "05:10"}, {"station": "C", "arrival": "05:30"}])
    found = runs(service(calls=[CALLS[0], {"station": "C", "arrival": "00:20"}]))
    assert found["S 05:10"] == TrainRun.model_validate(written)
    assert TrainRun.model_validate(found["S 05:30"].model_dump()) == found["S 05:30"]


@pytest.mark.parametrize(
    ("last", "headway", "number"),
    [
        ("05:10", 1200.0, 1),
        ("06:09:59", 1200.0, 3),
        ("06:10", 1200.0, 4),
        ("06:10", 0.9e1, 401),
        ("06:10", 33.3, 109),
        ("25:10", 3600.0, 21),
    ],
)
def test_how_many_runs_there_are(last, headway, number):
    assert len(runs(service(last=last, headway_s=headway))) == number


def test_seconds_are_written_where_there_are_any():
    assert list(runs(service(headway_s=90.5, last="05:13:01"))) == ["S 05:10", "S 05:11:30.5", "S 05:13:01"]


def test_names_go_on_past_midnight():
    assert list(runs(service(first="23:50", last="24:20", headway_s=900.0))) == ["S 23:50", "S 24:05", "S 24:20"]


def test_a_service_that_ends_before_it_begins():
    with pytest.raises(ValidationError, match="last is before first; past midnight hours go on beyond 24"):
        Service.model_validate(service(first="23:50", last="00:20"))


@pytest.mark.parametrize(("day", "names"), [("mon", ["1", "2", "S 05:10"]), ("sat", ["1", "3"]), ("sun", ["1"]), (None, ["1"])])
def test_days_of_operation(day, names):
    trains = [train("1", "06:00"), train("2", "06:00", days="mon tue"), train("3", "06:00", days=["sat"])]
    assert sorted(runs(service(last="05:10", days=["mon"]), trains=trains, day=day)) == names


def test_names_of_all_runs_of_all_days():
    table = Timetable.model_validate(
        {"trains": [train("1", "06:00", days=["sun"])], "services": [service(last="05:30", days=["mon"])]}
    )
    assert {name: owner and owner.id for name, owner in run_names(table).items()} == {"1": None, "S 05:10": "S", "S 05:30": "S"}


# --- past midnight


LATE = train("late", "23:40", calls=[{"station": "B", "arrival": "24:10", "departure": "24:11"}])
EARLY = train("early", "22:00", calls=[{"station": "B", "arrival": "24:00"}])


def test_trains_of_the_day_before_are_carried_over_only_if_asked():
    assert list(runs(trains=[LATE, EARLY])) == ["late", "early"]
    found = runs(trains=[LATE, EARLY], carry_over=True)
    assert list(found) == ["late", "early", "late" + DAY_BEFORE]
    carried = found["late" + DAY_BEFORE]
    assert carried.start.time == -1200.0
    assert (carried.calls[0].arrival, carried.calls[0].departure) == (600.0, 660.0)


def test_what_runs_after_midnight_belongs_to_the_day_on_which_it_begins():
    friday = service("N", first="23:30", last="24:30", headway_s=1800.0, days=["fri"])
    assert list(runs(friday, day="fri", carry_over=True)) == ["N 23:30", "N 24:00", "N 24:30"]
    assert list(runs(friday, day="sat", carry_over=True)) == ["N 24:00" + DAY_BEFORE, "N 24:30" + DAY_BEFORE]
    assert list(runs(friday, day="sun", carry_over=True)) == []
    sunday = service("N", first="24:10", last="24:10", days=["sun"])
    assert list(runs(sunday, day="mon", carry_over=True)) == ["N 24:10" + DAY_BEFORE]
