"""The search on a small supply, against all designs that there are."""

from itertools import product

import pytest
from small_studies import STATION, load, make_scenario

from tractionpower.errors import UsageError
from tractionpower.io.library import shipped_library
from tractionpower.model.change import apply_changes
from tractionpower.studies.cases.measure import measure
from tractionpower.studies.contingency.outages import outages
from tractionpower.studies.runner.store import CaseStore
from tractionpower.studies.sizing_search.search import search

BY_UNIT = {key: value for key, value in STATION.items() if key != "internal_resistance_ohm"}
PLANT = BY_UNIT | {"unit_resistance_ohm": 0.2, "grid_resistance_ohm": 0.02, "rated_current_a": 1000.0, "duty_class": "I"}
DUTY = [{"duty_class": "I", "window_s": 0.0, "multiple": 1.0}]
MOST = 3


def study(mw, units=(1, 1), **more):
    """Return two plants of some units, and three trains as loads of so many megawatts together."""
    loads = [load(str(k), km, power_kw=1000.0 * mw / 3.0) for k, km in enumerate((4.0, 10.0, 14.0))]
    plants = [PLANT | {"id": name, "km": km, "units": n} for name, km, n in (("A", 0.0, units[0]), ("B", 20.0, units[1]))]
    scenario = make_scenario(*loads, substations=plants, clock={"end": 60.0, "step_s": 5.0}, **more)
    plain = scenario.model_dump(by_alias=True)
    plain["duty_classes"] = DUTY
    plain["sizing"]["search"] |= {"most_units": MOST}
    plain["contingency"] |= {"kinds": ("unit",), "grid_voltages": ("normal",)}
    return type(scenario).model_validate(plain)


def holds(scenario):
    rows = [measure(apply_changes(scenario, case.changes)).figures for case in outages(scenario)]
    return all(not row["overloaded"] and row["lowest_voltage_v"] >= 2000.0 for row in rows)


@pytest.mark.parametrize("mw", [2.0, 4.5, 6.5, 9.0])
@pytest.mark.parametrize("units", [(1, 1), (3, 3)])
def test_the_design_holds_and_nothing_can_be_left_out(mw, units):
    found = search(study(mw, units), shipped_library())
    good = {n: holds(study(mw, n)) for n in product(range(1, MOST + 1), repeat=2)}
    assert found.verified
    if not any(good.values()):
        assert not found.holds
        assert found.remaining
        return
    assert found.holds
    assert not found.remaining
    best = {c.item.removeprefix("units of "): int(c.found.split()[0]) for c in found.design}
    design = tuple(best.get(name, declared) for name, declared in zip("AB", units, strict=True))
    assert good[design]
    for less in ((design[0] - 1, design[1]), (design[0], design[1] - 1)):
        assert not good.get(less, False)
    assert found.cost_found == 10.0 * sum(design)
    assert found.cost_declared == 10.0 * sum(units)


def test_the_changes_make_the_design():
    base = study(6.5)
    found = search(base, shipped_library())
    assert found.changes
    assert holds(apply_changes(base, found.changes))
    assert not holds(base)


def test_without_outages_less_does():
    base = study(6.5)
    plain = base.model_copy(
        update={"sizing": base.sizing.model_copy(update={"search": base.sizing.search.model_copy(update={"outages": False})})}
    )
    assert search(plain, shipped_library()).cost_found < search(base, shipped_library()).cost_found


def test_a_search_goes_on_from_what_is_kept(tmp_path):
    first = search(study(6.5), shipped_library(), CaseStore(tmp_path))
    again = search(study(6.5), shipped_library(), CaseStore(tmp_path))
    assert first.runs > 0
    assert again.runs == 0
    assert (again.design, again.steps) == (first.design, first.steps)


def test_what_cannot_be_met_is_told():
    found = search(study(18.0), shipped_library())
    assert not found.holds
    assert found.remaining
    assert any("rating" in item.words or "V on track" in item.words for item in found.remaining)
    assert found.notes()["remaining"]


def test_nothing_to_vary_is_told():
    with pytest.raises(UsageError, match="nothing to vary"):
        search(make_scenario(load("x"), substations=[STATION | {"id": "A", "km": 0.0, "state": "open"}]), shipped_library())
