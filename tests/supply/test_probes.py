"""Places whose voltage is recorded beside loads."""

import pytest
from nodes import line, rails_of_each, station, supply
from solved import LIMITS, tap

from tractionpower.supply.compile import compile_network
from tractionpower.supply.probes import find_probes
from tractionpower.supply.wiring import build_topology


def probes(*loads, **more):
    return find_probes(build_topology(supply(**more), line()), loads)


def test_probes_stand_beside_loads_on_the_tracks_of_the_same_rails():
    assert probes(tap("a", 4.0, kw=1.0), tap("b", 13.0, track="2", kw=1.0)) == [("1", 13.0), ("2", 4.0)]
    assert probes(tap("a", 4.0, kw=1.0), tap("b", 13.0, track="2", kw=1.0), return_circuit=rails_of_each()) == []


@pytest.mark.parametrize(("gap", "found"), [(0.0005, []), (0.0009, []), (0.002, [("1", 4.002), ("2", 4.0)])])
def test_a_load_close_by_needs_no_probe(gap, found):
    """It shares the node, so its own voltage is recorded there anyway."""
    assert probes(tap("a", 4.0, kw=1.0), tap("b", 4.0 + gap, track="2", kw=1.0)) == found


def test_many_loads_against_a_plain_search():
    kms = [round(0.0004 * k * k % 19.0, 4) for k in range(1, 300)]
    loads = [tap(str(k), km, track="12"[k % 3 == 0], kw=1.0) for k, km in enumerate(kms)]
    expected = {
        (track, load.km)
        for load in loads
        for track in "12"
        if all(abs(other.km - load.km) >= 0.001 for other in loads if other.track == track)
    }
    assert probes(*loads) == sorted(expected)


def test_probes_are_the_last_places_of_a_compiled_supply():
    declared = supply(substations=(station(),), loads=(tap("a", 4.0, kw=1.0),))
    tables = compile_network(declared, line(), LIMITS)
    assert tables.sections[-1] == ("2", 4.0)
    assert tables.section_table["port"][-1] == 2  # behind the source and the load
