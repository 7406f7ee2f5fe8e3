"""Lengths on the ground against published degrees of the ellipsoid; stops in their order along shapes that come by twice."""

import numpy as np
import pytest

from tractionpower.io.imports.gtfs.shapes import Polyline, distance_m, place_in_order


@pytest.mark.parametrize(
    ("lat", "north_km", "east_km"), [(0.0, 110.574, 111.320), (45.0, 111.132, 78.847), (60.0, 111.412, 55.800)]
)
def test_degrees(lat, north_km, east_km):
    # lengths of a degree as tables of WGS 84 have them
    assert distance_m(lat - 0.5, 20.0, lat + 0.5, 20.0) == pytest.approx(north_km * 1000.0, abs=20.0)
    assert distance_m(lat, 20.0, lat, 21.0) == pytest.approx(east_km * 1000.0, abs=1.0)


def test_a_place_on_a_line():
    line = Polyline.through([50.0, 50.0, 50.0, 50.01], [20.0, 20.01, 20.01, 20.01])
    assert len(line.lat) == 3  # the point that comes twice counts once
    along, away = line.project(50.001, 20.005)
    assert along == pytest.approx(0.5 * distance_m(50.0, 20.0, 50.0, 20.01), abs=0.01)
    assert away == pytest.approx(distance_m(50.0, 20.0, 50.001, 20.0), abs=0.01)
    assert line.project(50.02, 20.01) == (pytest.approx(line.length_m), pytest.approx(1112.3, abs=1.0))


def test_parts():
    line = Polyline.through([50.0, 50.0, 50.01], [20.0, 20.01, 20.01])
    part = line.part(200.0, 1000.0)
    assert part.length_m == pytest.approx(800.0, abs=0.01)
    assert line.part(1000.0, 200.0).lat == pytest.approx(part.lat[::-1])
    assert line.reversed().length_m == pytest.approx(line.length_m)


def test_stops_of_a_line_that_turns_back():
    # out to the east and back on the same way, then to the north: a stop on the way is passed twice
    line = Polyline.through([50.0, 50.0, 50.0, 50.05], [20.0, 20.1, 20.0, 20.0])
    lat, lon = np.array([50.0, 50.0, 50.0, 50.03]), np.array([20.05, 20.1, 20.05, 20.0])
    along, away = place_in_order(line, lat, lon)
    whole = distance_m(50.0, 20.0, 50.0, 20.1)
    assert along[:3] == pytest.approx(np.array([0.5, 1.0, 1.5]) * whole, abs=0.1)
    assert along[3] > 2.0 * whole
    assert away == pytest.approx(np.zeros(4), abs=1e-6)
