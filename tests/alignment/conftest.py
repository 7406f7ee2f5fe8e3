"""A line of two tracks with everything in order, and ways to make it faulty."""

import pytest

from tractionpower.model.line import Curve, Gradient, Line, SpeedLimit, Station, Track, Tunnel


@pytest.fixture
def parts():
    """Keyword arguments of a line in order; a test replaces some of them."""
    return {
        "tracks": (Track(id="1", from_km=0.0, to_km=20.0), Track(id="2", from_km=0.0, to_km=20.0)),
        "stations": (
            Station(id="A", km=0.0),
            Station(id="C", km=10.0, stop_km={"1 increasing": 10.1, "2": 9.9}),
            Station(id="B", km=20.0),
        ),
        "gradients": (
            Gradient(from_km=0.0, to_km=12.5, permille=3.0),
            Gradient(from_km=12.5, to_km=20.0, permille=0.0, tracks=("1",)),
            Gradient(from_km=12.5, to_km=20.0, permille=-6.0, tracks=("2",)),
        ),
        "curves": (Curve(from_km=1.0, to_km=2.0, radius_m=800), Curve(from_km=2.0, to_km=3.0, radius_m=500)),
        "tunnels": (Tunnel(from_km=4.0, to_km=5.0, kind="single_track", tracks=("1",)),),
        "speed_limits": (
            SpeedLimit(from_km=0.0, to_km=20.0, kmh=160),
            SpeedLimit(from_km=9.0, to_km=11.0, kmh=100, direction="increasing"),
            SpeedLimit(from_km=8.0, to_km=12.0, kmh=80, category="freight"),
        ),
    }


@pytest.fixture
def line(parts):
    """Return a function that builds the line with some parts replaced."""
    return lambda **changes: Line(**(parts | changes))
