"""The search on plants whose needs are known: each device needs so many units in each case."""

import math

import pytest

from tractionpower.studies.sizing_search.climb import Climb, StoppedError
from tractionpower.studies.sizing_search.items import Item, Rung
from tractionpower.studies.sizing_search.shortfalls import CaseFacts, Shortfall


def units(name, declared, most=6):
    rungs = tuple(Rung(f"{n} units", (f"{name}.units={n}",), 10.0 * n) for n in range(1, most + 1))
    return Item(f"units of {name}", "units", name, (), 0.0, 0.0, rungs, declared - 1)


class Plants:
    """Loads of each plant in each case, in units; a plant is used by its load over its units."""

    def __init__(self, items, loads, most=200):
        self.items, self.loads, self.most, self.runs, self.whole = items, loads, most, 0, 0

    def evaluate(self, design, only=None):
        self.whole += only is None
        found = {}
        for case, loads in self.loads.items():
            if only is None or case in only:
                self.runs += 1
                used = {}
                for name, load in loads.items():
                    item = self.items[f"units of {name}"]
                    used[f"{name} unit"] = 100.0 * load / (design.get(item.name, item.declared) + 1)
                short = [Shortfall(case, "device", d, "", math.nan, p / 100 - 1, d) for d, p in used.items() if p > 100.0]
                found[case] = CaseFacts(tuple(short), used)
        return found

    def helps(self, shortfall):
        return [f"units of {shortfall.subject.removesuffix(' unit')}"]

    @property
    def spent(self):
        return self.runs >= self.most


def climbed(declared, loads, **more):
    items = {item.name: item for item in (units(name, n) for name, n in declared.items())}
    climb = Climb(items, Plants(items, loads, **more))
    climb.run()
    return climb, {name: climb.design.get(f"units of {name}", items[f"units of {name}"].declared) + 1 for name in declared}


def test_what_is_short_is_built_and_what_is_spare_is_left_out():
    loads = {"base": {"A": 1.5, "B": 0.6, "C": 3.9}, "A out": {"B": 2.6, "C": 3.0}, "C out": {"A": 0.4, "B": 1.1}}
    climb, found = climbed({"A": 2, "B": 2, "C": 6}, loads)
    assert found == {"A": 2, "B": 3, "C": 4}
    assert climb.verified
    assert not climb.shortfalls
    assert climb.cost == 90.0
    assert [step.item for step in climb.steps].count("units of C") == 2


def test_one_leap_does_where_much_is_missing():
    climb, found = climbed({"A": 1}, {"base": {"A": 4.5}})
    assert found == {"A": 5}
    assert len(climb.steps) == 1


def test_what_cannot_be_met_is_told_and_the_rest_is_mended():
    climb, found = climbed({"A": 1, "B": 1}, {"base": {"A": 9.0, "B": 1.5}})
    assert found["A"] == 6
    assert found["B"] == 2
    assert [item.subject for item in climb.stuck] == ["A unit"]


def test_a_case_that_was_not_looked_at_counts_in_the_end():
    # In "far" nothing is near its limit until A is lessened, so only the last verification sees it.
    class Hidden(Plants):
        def evaluate(self, design, only=None):
            found = super().evaluate(design, only)
            if design.get("units of A", 2) < 2 and "far" in found:
                short = Shortfall("far", "device", "A unit", "", math.nan, 0.1, "hidden")
                found["far"] = CaseFacts((short,), {"A unit": 110.0})
            return found

    items = {"units of A": units("A", 3)}
    loads = {"base": {"A": 1.2}, "near": {"A": 1.1}, "nearer": {"A": 1.15}, "far": {"A": 0.1}}
    climb = Climb(items, Hidden(items, loads))
    climb.run()
    assert climb.verified
    assert not climb.shortfalls
    assert climb.design["units of A"] == 2


@pytest.mark.parametrize("most", [0, 3, 7])
def test_it_ends_when_nothing_more_may_be_tried(most):
    climb, _ = climbed({"A": 1, "B": 6}, {"base": {"A": 2.5, "B": 0.5}, "x": {"A": 0.2}}, most=most)
    assert climb.evaluator.runs <= most + 4


class Neighbours:
    """A and B share a load of four units, and a case that is not looked at first needs three of B where C has one."""

    def __init__(self, stop_after=10**9):
        self.calls, self.stop_after = 0, stop_after

    spent = False

    def helps(self, shortfall):
        return ["units of B"]

    def evaluate(self, design, only=None):
        self.calls += 1
        if self.calls > self.stop_after:
            raise StoppedError
        a, b, c = (design.get(f"units of {name}", 1) + 1 for name in "ABC")
        short = {"base": a + b < 4 or b < 2, "hidden": c < 2 and b < 3}
        used = {"base": {"A unit": 90.0, "B unit": 95.0, "C unit": 91.0}, "hidden": {"A unit": 1.0, "B unit": 1.0, "C unit": 1.0}}
        found = {}
        for case, missed in short.items():
            items = (Shortfall(case, "device", "B unit", "", math.nan, 0.5, "x"),) if missed else ()
            if only is None or case in only:
                found[case] = CaseFacts(items, used[case])
        return found


def neighbours(**more):
    items = {item.name: item for item in (units(name, 2, most=4) for name in "ABC")}
    return Climb(items, Neighbours(**more)), items


def test_what_was_refused_is_tried_again_when_more_was_built():
    climb, items = neighbours()
    climb.run()
    assert climb.verified
    assert not climb.shortfalls
    for name, item in items.items():
        rung = climb.design.get(name, item.declared)
        if rung:
            facts = Neighbours().evaluate({**climb.design, name: rung - 1})
            assert any(found.shortfalls for found in facts.values()), name


@pytest.mark.parametrize("calls", range(12))
def test_what_was_stopped_is_no_success(calls):
    climb, _ = neighbours(stop_after=calls)
    climb.run()
    whole, _ = neighbours()
    whole.run()
    if calls < whole.evaluator.calls:
        assert not climb.verified
        assert [step.item for step in climb.steps] == [step.item for step in whole.steps[: len(climb.steps)]]
