"""Where rail potentials are recorded, and what they are between the nodes of the network."""

import numpy as np
import pytest
from solved import Solved, single_line, tap

from tractionpower.model.line import ChainageBreak, Line, Track
from tractionpower.model.supply import ReturnCircuit
from tractionpower.supply.rail_places import SPACING_M, find_rail_places
from tractionpower.supply.wiring import build_topology

OHM, SIEMENS = 0.02, 0.2


def leaky(loads=(), rows=((0.0, 20.0, SIEMENS),), **changes):
    supply, line = single_line(loads)
    rails = tuple(ReturnCircuit(from_km=a, to_km=b, resistance_ohm_per_km=OHM, leakage_s_per_km=g) for a, b, g in rows)
    return supply.model_copy(update={"return_circuit": rails} | changes), line


def places_of(supply, line):
    return find_rail_places(build_topology(supply, line), supply.loads)


def test_places_are_close_and_stand_for_the_whole_length():
    places = places_of(*leaky([tap("T", 3.3, ampere=100.0)]))
    assert places[0].km == 0.0
    assert places[-1].km == 20.0
    assert any(place.km == pytest.approx(3.3) for place in places)
    assert np.diff([place.km for place in places]).max() <= SPACING_M / 1000.0 + 1e-9
    assert sum(place.length_m for place in places) == pytest.approx(20_000.0)
    assert {place.leakage_s_per_m for place in places} == {SIEMENS / 1000.0}


def test_without_earth_there_are_none():
    assert places_of(*leaky(rows=((0.0, 20.0, 0.0),))) == ()


def test_rows_that_meet_have_a_place_each():
    places = places_of(*leaky(rows=((0.0, 8.0, 0.2), (8.0, 20.0, 0.0))))
    at_the_joint = [(place.length_m, place.leakage_s_per_m) for place in places if place.km == 8.0]
    assert at_the_joint == [(pytest.approx(500.0), pytest.approx(2e-4)), (pytest.approx(500.0), 0.0)]


def test_kilometres_pass_chainage_breaks():
    supply, _ = leaky()
    tracks = (Track(id="1", from_km=0.0, to_km=20.0),)
    line = Line(tracks=tracks, chainage_breaks=(ChainageBreak(at_km=7.5, continues_as_km=9.5),))
    kms = [place.km for place in places_of(supply, line)]
    assert not any(7.5 < km < 9.5 for km in kms)
    assert sum(place.length_m for place in places_of(supply, line)) == pytest.approx(18_000.0)


def along(km, at_km, current_a, length_km=20.0):
    """Return the potential of homogeneous leaky rails, open at both ends, at `km` for a current put in at `at_km` [V]."""
    a, z = np.sqrt(OHM * SIEMENS), np.sqrt(OHM / SIEMENS)
    low, high = np.minimum(km, at_km), np.maximum(km, at_km)
    return current_a * z * np.cosh(a * low) * np.cosh(a * (length_km - high)) / np.sinh(a * length_km)


def test_potentials_between_the_nodes_are_those_of_the_telegraph_equation():
    """Spans without anything on them, with one load, and with several between two places."""
    loads = [tap(name, km, ampere=ampere) for name, km, ampere in (("a", 4.31, 700.0), ("b", 4.42, 300.0), ("c", 13.0, 900.0))]
    solved = Solved(*leaky(loads))
    found = solved.rails_everywhere
    kms = np.array([km for _, km in found])
    expected = sum(along(kms, load.km, load.current_a) for load in loads)
    for name, km in (("A", 0.0), ("B", 20.0)):
        expected = expected + along(kms, km, solved.i[name])
    np.testing.assert_allclose(list(found.values()), expected, rtol=1e-9, atol=1e-9)
    assert len(kms) > 20
