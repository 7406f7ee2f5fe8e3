"""Currents at the ends of sections: against hand-worked networks, and against the feeders that they come from."""

import numpy as np
import pytest
from random_coupling import RandomCoupling
from small_studies import load, make_scenario

from tractionpower.cosimulation.quiet import QuietRun

SHARED_KM = 1.5e-3


def watched(scenario):
    """Return the compiled supply, and currents of gauges and links of all steps."""
    run = QuietRun(scenario)
    gauges, links = [], []
    run.watches.append(lambda time_s, rows, supply: (gauges.append(rows.gauge_a.copy()), links.append(rows.link_a.copy())))
    run.execute()
    return run.compiled.supply, np.concatenate(gauges), np.concatenate(links)


def by_name(supply, gauges):
    row = gauges[0]
    return {
        (s.kind, s.tracks, s.from_km, s.to_km): tuple(row[2 * k : 2 * k + 2]) for k, s in enumerate(supply.conductor_sections)
    }


def test_a_cabin_shares_the_current_of_one_train():
    # 1500 A on track 1 at km 10: each track brings half of what each substation feeds, 750 A.
    scenario = make_scenario(load("train", 10.0, current_a=1500.0, limits="none"))
    supply, gauges, _ = watched(scenario)
    found = by_name(supply, gauges)
    assert found["contact_line", "1", 0.0, 10.0] == pytest.approx((375.0, 1125.0), abs=1e-6)  # at a cut, on its low side
    assert found["contact_line", "2", 0.0, 10.0] == pytest.approx((375.0, -375.0), abs=1e-6)
    for track in "12":
        assert found["contact_line", track, 10.0, 20.0] == pytest.approx((-375.0, 375.0), abs=1e-6)
    assert found["rails", "1 2", 0.0, 20.0] == pytest.approx((-750.0, -750.0), abs=1e-6)


def test_what_a_section_takes_flows_in_from_its_ends():
    scenario = make_scenario(
        load("x", 4.0, current_a=600.0, limits="none"), load("y", 16.0, track="2", current_a=-200.0, limits="none")
    )
    supply, gauges, _ = watched(scenario)
    found = by_name(supply, gauges)
    assert sum(found["contact_line", "1", 0.0, 10.0]) == pytest.approx(600.0, abs=1e-6)
    assert sum(found["contact_line", "2", 10.0, 20.0]) == pytest.approx(-200.0, abs=1e-6)
    assert sum(found["contact_line", "2", 0.0, 10.0]) == pytest.approx(0.0, abs=1e-6)
    assert sum(found["rails", "1 2", 0.0, 20.0]) == pytest.approx(-400.0, abs=1e-6)


def test_sections_end_where_something_is_or_changes():
    whole = {"from_km": 0.0, "to_km": 20.0}
    wires = [{"from_km": 0.0, "to_km": 7.0, "resistance_ohm_per_km": 0.05}]
    wires.append({"from_km": 7.0, "to_km": 20.0, "resistance_ohm_per_km": 0.06})
    scenario = make_scenario(
        load("x"),
        contact_lines=wires,
        section_points=[{"id": "p", "track": "2", "km": 13.0, "state": "closed"}],
        return_circuit=[whole | {"resistance_ohm_per_km": 0.02, "tracks": [track]} for track in "12"],
        bonds=[{"from_km": 2.0, "to_km": 18.0, "every_km": 4.0}],
    )
    supply, _, _ = watched(scenario)
    ends = {(kind, track): [] for kind in ("contact_line", "rails") for track in "12"}
    for section in supply.conductor_sections:
        ends[section.kind, section.tracks].append((section.from_km, section.to_km))
    assert ends["contact_line", "1"] == [(0.0, 7.0), (7.0, 10.0), (10.0, 20.0)]
    assert ends["contact_line", "2"] == [(0.0, 7.0), (7.0, 10.0), (10.0, 13.0), (13.0, 20.0)]
    assert ends["rails", "1"] == ends["rails", "2"] == [(0.0, 20.0)]


def test_the_sections_are_those_of_the_declared_devices_whatever_their_states():
    plain = make_scenario(load("x"))
    out = plain.model_copy(
        update={
            "supply": plain.supply.model_copy(
                update={
                    "section_cabins": tuple(c.model_copy(update={"state": "bypassed"}) for c in plain.supply.section_cabins),
                    "substations": tuple(
                        s.model_copy(update={"state": "open"}) if s.id == "B" else s for s in plain.supply.substations
                    ),
                }
            )
        }
    )
    places = [[(s.kind, s.tracks, s.from_km, s.to_km) for s in watched(each)[0].conductor_sections] for each in (plain, out)]
    assert places[0] == places[1]


@pytest.mark.parametrize("seed", range(12))
def test_a_section_carries_what_the_feeder_at_its_end_feeds(seed):
    scenario = RandomCoupling(seed).scenario
    supply, gauges, links = watched(scenario)
    compared = 0
    for k, section in enumerate(supply.conductor_sections):
        for n, (km, side) in enumerate(((section.from_km, "high_km"), (section.to_km, "low_km"))):
            here = [
                j
                for j, link in enumerate(supply.links)
                if section.kind == "contact_line" and link.kind in ("feeder", "cabin") and link.closed
                and (link.track, link.side) == (section.tracks, side) and abs(link.km - km) < SHARED_KM
            ]  # fmt: skip
            if len(here) == 1:
                np.testing.assert_allclose(gauges[:, 2 * k + n], links[:, here[0]], atol=1e-5)
                compared += 1
    assert compared
