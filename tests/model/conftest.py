"""A small scenario with everything that a change can touch."""

import pytest

from tractionpower.model.limits import Limit
from tractionpower.model.line import Line, Station, Track
from tractionpower.model.loads import Load
from tractionpower.model.scenario import Clock, Scenario
from tractionpower.model.supply import ContactLine, ReturnCircuit, SectionCabin, Substation, Supply


@pytest.fixture
def scenario() -> Scenario:
    line = Line(
        name="Two substations",
        tracks=(Track(id="1", from_km=0.0, to_km=20.0), Track(id="2", from_km=0.0, to_km=20.0)),
        stations=(Station(id="A", km=0.0, stop_km={"1": 0.1}), Station(id="B.2=x", km=20.0)),
    )
    supply = Supply(
        substations=tuple(
            Substation(id=i, km=km, no_load_voltage_v=3600, internal_resistance_ohm=0.12) for i, km in (("A", 0), ("B", 20))
        ),
        section_cabins=(SectionCabin(id="C", km=10.0, tracks=("1", "2")),),
        contact_lines=(ContactLine(tracks=("1", "2"), from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.05),),
        return_circuit=(ReturnCircuit(from_km=0.0, to_km=20.0, resistance_ohm_per_km=0.01),),
        loads=(
            Load(id="train", track="1", km=4.0, power_kw=1 / 3, from_="00:01:00", to="00:03:30.25"),
            Load(id="x", track="2", km=6.0, current_a=1000.0),
        ),
    )
    limits = (Limit(system="dc3000", name="u_n", value=3000.0, unit="V", source="a 'quoted' \"source\""),)
    return Scenario(name="base", line=line, supply=supply, clock=Clock(start=0.1 + 0.2, end="00:15:00"), limits=limits)
