"""A larger headway found and verified by real runs: fewer trains at a time on a weak supply lose less."""

from coupled import vehicle
from remedy_cases import small_study
from small_trains import INVERTER

from tractionpower.model.change import apply_changes
from tractionpower.studies.feasibility import judge, lateness
from tractionpower.studies.remedies.search import search

SERVICE = {
    "id": "S",
    "train": "inverter",
    "route": [{"track": "1", "from_km": 0.0, "to_km": 20.0}],
    "headway_s": 120.0,
    "first": 60.0,
    "last": 660.0,
    "calls": [{"station": "A", "departure": 0.0}, {"station": "B", "arrival": 655.0}],
}
WEAK = [
    {"id": name, "km": km, "no_load_voltage_v": 3000.0, "internal_resistance_ohm": 0.6} for name, km in (("A", 0.0), ("B", 20.0))
]


def test_the_smallest_headway_that_holds_is_found():
    study = small_study(
        substations=WEAK,
        vehicles=[vehicle("inverter", drive=INVERTER | {"max_current_a": 1300.0})],
        end_s=2400.0,
        timetable={"services": [SERVICE], "trains": []},
        remedies={"kinds": ["headway"], "sensitivities": 0, "greatest_headway_factor": 3.0},
    )
    best = search(study, judge(study)).best
    assert (best.kind, best.subject) == ("headway", "S")
    headway = 120.0 + best.size
    assert max(lateness(apply_changes(study, [f"timetable.services[S].headway_s={headway}"])).values()) <= 1.0
    assert max(lateness(apply_changes(study, [f"timetable.services[S].headway_s={headway - 15.0}"])).values()) > 1.0
