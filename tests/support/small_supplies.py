"""A supply of two tracks to put one fault into, and what its checks say."""

from tractionpower.model.limits import VOLTAGE_NAMES, Limit
from tractionpower.model.line import Line
from tractionpower.model.supply import Supply
from tractionpower.supply.checks import check_supply

LIMITS = tuple(
    Limit(system="dc3000", name=name, value=value, unit="V")
    for name, value in zip(VOLTAGE_NAMES, (2000.0, 2000.0, 3000.0, 3600.0, 3900.0), strict=True)
)
WHOLE = {"from_km": 0.0, "to_km": 20.0}
CONTACT = WHOLE | {"resistance_ohm_per_km": 0.05}
RAILS = WHOLE | {"resistance_ohm_per_km": 0.01}
OWN_RAILS = [RAILS | {"tracks": [track]} for track in "12"]
"""Rails of each track by themselves."""


def station(name, km, **more):
    return {"id": name, "km": km, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12, **more}


def end(track="1", km=5.0, side=None):
    return {"track": track, "km": km} | ({"side": side} if side else {})


def small_supply(**changes):
    """Return substations at km 0, 8 and 20 and a section cabin at km 12, with some lists replaced."""
    parts = {
        "substations": [station("A", 0.0), station("M", 8.0, units=2, grid_resistance_ohm=0.01), station("B", 20.0)],
        "section_cabins": [{"id": "C", "km": 12.0}],
        "contact_lines": [CONTACT],
        "return_circuit": [RAILS],
    }
    return Supply.model_validate(parts | changes)


def small_line(**changes):
    return Line.model_validate({"tracks": [WHOLE | {"id": track} for track in "12"]} | changes)


def problems_of(line=None, **changes):
    """Return what the checks say of the small supply with some lists replaced."""
    return check_supply(small_supply(**changes), line or small_line(), LIMITS)


def assert_only(problems, code, path, *words, severity="error"):
    """Assert that there is one problem and that this is it."""
    assert len(problems) == 1, [str(problem) for problem in problems]
    assert (problems[0].code, problems[0].path, problems[0].severity) == (code, path, severity)
    for word in words:
        assert word in str(problems[0]), str(problems[0])
