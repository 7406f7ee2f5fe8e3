"""The files of Arshad et al. as the paper prints them, with a small consist of ours, and what reading them tells."""

from collections.abc import Mapping
from pathlib import Path

from tractionpower.errors import Problem
from tractionpower.io.dynamics_files import LoadedCase, read_case

INI = """State vector size = 20000
 Simulation time = 150.0 sec
 Step size = 0.005sec
 Coupler hard limit = 0.4 m
 First stage loading = 6000.0 n/mm
 Second stage loading = 17000.0 n/mm
 Locked stiffness = 600000.0 n/mm
 Relaxing stiffness = 600.0 n/mm
 Slack region width = 0.1 m
 Kinetic fric coff = 0.2
 Static fric coff = 0.4
 Wedge angle = 35.0 degree
 Cut of cars = 5
"""
"""Section 7.2, with the blanks of the print."""

TABLE_4 = """Time,Notch,Brake Pipe Pressure,Dynamic Brake
0.0,1,10.0,15
5.5,3,Charge,25
50.5,6,Uc (Unchanged),20
150.3,4,Full Service,18
200.0,5,Charge,25
300,6,Emergency,10
"""

TABLE_7 = """Time instant (sec),Throttle Noch,Automatic Braking (psi),Dynamic Braking Notch
0,1,Charge,0
30,2,Charge,0
60,3,Charge,0
80,3,7,0
100,0,15,0
"""

TABLE_6 = """Start Point (feet),End Point (feet),Track Element,Value
1,3000,Grade,1 %
1500,2500,Curve,1 Deg
3001,3999,Grade,1%
4000,4500,Curve,2 Deg
4600,4700,Grade,4%
"""

CONSIST = """Position,Number,Type,Lading Weight (t),Tare Weight (t),Length (m),Axles,Tractive Effort (kN),Power (kW)
1,1,Locomotive,0,110,19,6,270,1500
2,5,Car,0,25,15,4,,
"""

FILES = {"Simulation.ini": INI, "DynamicParameter.csv": TABLE_7, "TrackProfile.csv": TABLE_6, "TrainConsist.csv": CONSIST}


def write_arshad(folder: Path, changed: Mapping[str, str] | None = None, extra: str = "") -> Path:
    """Write the files into a folder, some of them replaced, the configuration with `extra` lines."""
    texts = FILES | dict(changed or {})
    texts["Simulation.ini"] += extra
    for name, text in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder


def read_arshad_files(
    folder: Path, changed: Mapping[str, str] | None = None, extra: str = ""
) -> tuple[LoadedCase | None, list[Problem]]:
    """Write the files and return the case, or None, and the problems of reading it."""
    return read_case(write_arshad(folder, changed, extra))
