"""Where conductors lie along tracks that share rails, and where they are cut."""

import itertools

import pytest
from nodes import line, lines, rails_of_each, supply

from tractionpower.alignment.axis import compile_axes
from tractionpower.model.supply import ContactLine, ReturnCircuit
from tractionpower.supply.bundles import HIGH, LOW, find_bundles


def bundles_of(declared, along):
    return find_bundles(declared, along, compile_axes(along), ())


def only(declared, along, kms=()):
    """Return the only bundle of a line, cut."""
    (bundle,) = bundles_of(declared, along)
    bundle.cut_at(kms)
    return bundle


def rail_row(*tracks, low=0.0, high=20.0, ohm=0.01, **more):
    return ReturnCircuit(tracks=tracks or None, from_km=low, to_km=high, resistance_ohm_per_km=ohm, **more)


def test_tracks_that_share_rails_are_one_bundle():
    assert [bundle.tracks for bundle in bundles_of(supply(), line("21"))] == [("1", "2")]
    assert [bundle.tracks for bundle in bundles_of(supply(return_circuit=rails_of_each()), line())] == [("1",), ("2",)]
    chain = (rail_row("3", "1"), rail_row("2"), rail_row("4", "3", low=8.0), rail_row("5", "6"))
    tracks = [bundle.tracks for bundle in bundles_of(supply(return_circuit=chain), line("654321"))]
    assert tracks == [("1", "3", "4"), ("2",), ("5", "6")]


def test_a_track_without_rails_is_a_bundle_of_its_own():
    assert [bundle.tracks for bundle in bundles_of(supply(return_circuit=(rail_row("2"),)), line())] == [("1",), ("2",)]


def test_cuts_are_devices_and_ends_of_rows():
    wires = (
        ContactLine(from_km=-3.0, to_km=6.0, resistance_ohm_per_km=0.05),
        ContactLine(from_km=6.0, to_km=33.0, resistance_ohm_per_km=0.08, tracks=("2",)),
    )
    bundle = only(supply(contact_lines=wires), line(), (13.0, 4.0, 4.0))
    assert bundle.cuts == [0.0, 4.0, 6.0, 13.0, 20.0]
    assert bundle.contacts == [
        {"1": pytest.approx(5e-5), "2": pytest.approx(5e-5)}, {"1": pytest.approx(5e-5), "2": pytest.approx(5e-5)},
        {"2": pytest.approx(8e-5)}, {"2": pytest.approx(8e-5)},
    ]  # fmt: skip


def test_cuts_closer_than_a_metre_are_one():
    bundle = only(supply(), line(), (10.0, 10.0009, 10.0012, 19.9995))
    assert bundle.cuts == [0.0, 10.0, 10.0012, 19.9995]
    assert [bundle.cut(km) for km in (-5.0, 0.4, 10.0007, 10.0011, 19.0, 20.0, 77.0)] == [0, 0, 1, 2, 3, 3, 3]


def test_sides_of_a_cut():
    wires = (
        ContactLine(from_km=0.0, to_km=6.0, resistance_ohm_per_km=0.05),
        ContactLine(from_km=9.0, to_km=20.0, resistance_ohm_per_km=0.05, tracks=("1",)),
    )
    bundle = only(supply(contact_lines=wires), line(), (3.0,))
    assert bundle.cuts == [0.0, 3.0, 6.0, 9.0, 20.0]
    assert [bundle.sides("1", cut) for cut in range(5)] == [[HIGH], [LOW, HIGH], [LOW], [HIGH], [LOW]]
    assert [bundle.sides("2", cut) for cut in range(5)] == [[HIGH], [LOW, HIGH], [LOW], [], []]


def test_rails_beside_a_cut():
    rows = (
        rail_row("1", "2", high=8.0, leakage_s_per_km=0.3),
        rail_row("1", low=8.0, ohm=0.02), rail_row("2", low=8.0, ohm=0.03),
    )  # fmt: skip
    bundle = only(supply(return_circuit=rows), line())
    assert [rails.number for rails in bundle.rails_at("1", 0)] == [0]
    assert [rails.number for rails in bundle.rails_at("1", 1)] == [0, 1]  # the low side first
    assert [rails.number for rails in bundle.rails_at("2", 1)] == [0, 2]
    first, second = bundle.rails_at("2", 1)
    assert (first.tracks, first.ohm_per_m, first.siemens_per_m) == (("1", "2"), pytest.approx(1e-5), pytest.approx(3e-4))
    assert (second.tracks, second.ohm_per_m, second.siemens_per_m) == (("2",), pytest.approx(3e-5), 0.0)


def test_tracks_of_different_length_share_rails_where_both_are():
    wires = (ContactLine(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05),)
    bundle = only(supply(contact_lines=wires), lines(("1", 0.0, 20.0), ("2", 4.0, 12.0)))
    assert bundle.cuts == [0.0, 4.0, 12.0, 20.0]
    assert [[*piece] for piece in bundle.contacts] == [["1"], ["1", "2"], ["1"]]
    assert [rails.tracks for piece in bundle.rails for rails in piece] == [("1",), ("1", "2"), ("1",)]


def test_many_rows_lie_where_they_are_declared():
    """Rows are found by their place and not one by one; each piece must still get the one that covers it."""
    ends = [0.25 * k for k in range(81)]
    wires = tuple(
        ContactLine(from_km=a, to_km=b, resistance_ohm_per_km=0.05 + 0.001 * k)
        for k, (a, b) in enumerate(itertools.pairwise(ends))
    )
    bundle = only(supply(contact_lines=wires[::-1]), line("1"), (3.1, 7.77, 7.78))
    for low, high, contacts in zip(bundle.cuts, bundle.cuts[1:], bundle.contacts, strict=False):
        row = next(row for row in wires if row.from_km <= low and high <= row.to_km)
        assert contacts == {"1": row.resistance_ohm_per_km / 1000.0}
    assert len(bundle.contacts) == 83
