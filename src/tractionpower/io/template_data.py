"""The study that ``tractionpower new`` writes: its values, all of them assumed, and its README."""

from __future__ import annotations

from typing import Any

from pydantic import BaseModel

from tractionpower.io.finder import STUDY_FILE
from tractionpower.model.line import Line
from tractionpower.model.report import Report
from tractionpower.model.scenario import StudyFile
from tractionpower.model.supply import Supply
from tractionpower.model.timetable import Timetable
from tractionpower.model.vehicle import Train, Vehicle

_ASSUMED = "Template of tractionpower; all values are assumed"

_STUDY: dict[str, Any] = {
    "format": 1,
    "name": "Two substations and a section cabin",
    "line": "line.yaml",
    "supply": "supply.yaml",
    "timetable": "timetable.yaml",
    "clock": {"start": "00:00:00", "end": "00:20:00", "step_s": 1.0},
    "coupling": "full",
    "seed": 1,
    "report": "report.yaml",
}

_LINE: dict[str, Any] = {
    "format": 1,
    "name": "Two substations and a section cabin",
    "source": _ASSUMED,
    "tracks": [{"id": "1", "from_km": 0.0, "to_km": 20.0}, {"id": "2", "from_km": 0.0, "to_km": 20.0}],
    "stations": [
        {"id": "A", "name": "Substation A", "km": 0.0},
        {"id": "C", "name": "Section cabin", "km": 10.0},
        {"id": "B", "name": "Substation B", "km": 20.0},
    ],
    "gradients": [],
    "speed_limits": [{"from_km": 0.0, "to_km": 20.0, "kmh": 160.0}],
}

_SUPPLY: dict[str, Any] = {
    "format": 1,
    "system": "dc3000",
    "substations": [
        {"id": "A", "km": 0.0, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12},
        {"id": "B", "km": 20.0, "no_load_voltage_v": 3600.0, "internal_resistance_ohm": 0.12},
    ],
    "section_cabins": [{"id": "C", "km": 10.0, "state": "closed"}],
    "contact_lines": [{"tracks": ["1", "2"], "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.05}],
    "return_circuit": [{"tracks": ["1", "2"], "from_km": 0.0, "to_km": 20.0, "resistance_ohm_per_km": 0.01}],
    "loads": [{"id": "depot", "track": "1", "km": 4.0, "power_kw": 400.0}],
}

_TIMETABLE: dict[str, Any] = {
    "format": 1,
    "trains": [
        {
            "id": "1001",
            "train": "express",
            "route": [{"track": "1", "from_km": 0.0, "to_km": 20.0}],
            "calls": [{"station": "A", "departure": "00:01:00"}, {"station": "B", "arrival": "00:13:00"}],
        },
        {
            "id": "2002",
            "train": "local",
            "route": [{"track": "2", "from_km": 20.0, "to_km": 0.0}],
            "calls": [
                {"station": "B", "departure": "00:02:00"},
                {"station": "C", "arrival": "00:09:00", "departure": "00:10:00", "min_dwell_s": 30.0},
                {"station": "A", "arrival": "00:17:00"},
            ],
        },
    ],
}

_LOCOMOTIVE: dict[str, Any] = {
    "format": 1,
    "id": "locomotive",
    "name": "Four-axle locomotive with inverters",
    "source": _ASSUMED,
    "kind": "locomotive",
    "mass_t": 84.0,
    "adhesive_mass_t": 84.0,
    "length_m": 19.0,
    "max_speed_kmh": 160.0,
    "axles": 4,
    "rotating_mass_factor": 1.15,
    "resistance": {"a_n": 1500.0, "b_n_per_kmh": 20.0, "c_n_per_kmh2": 0.5},
    "drive": {
        "kind": "inverter",
        "starting_effort_kn": 270.0,
        "power_kw": 5000.0,
        "efficiency": 0.87,
        "max_current_a": 2000.0,
        "knee_factor": 0.9,
    },
    "brake": {"electric_effort_kn": 150.0, "electric_power_kw": 5000.0, "service_rate_mps2": 0.5},
    "auxiliaries": {"power_kw": 80.0},
}

_COACH: dict[str, Any] = {
    "format": 1,
    "id": "coach",
    "name": "Passenger coach",
    "source": _ASSUMED,
    "kind": "coach",
    "mass_t": 42.0,
    "load_t": 6.0,
    "length_m": 26.4,
    "max_speed_kmh": 160.0,
    "axles": 4,
    "rotating_mass_factor": 1.05,
    "resistance": {"specific_a_n_per_kn": 1.4, "c_n_per_kmh2": 0.1},
    "auxiliaries": {"heating_kw": 30.0, "heating": "resistive"},
}

_UNIT: dict[str, Any] = {
    "format": 1,
    "id": "unit",
    "name": "Electric multiple unit of four cars",
    "source": _ASSUMED,
    "kind": "multiple_unit",
    "mass_t": 130.0,
    "load_t": 24.0,
    "adhesive_mass_t": 66.0,
    "length_m": 75.0,
    "max_speed_kmh": 160.0,
    "axles": 10,
    "rotating_mass_factor": 1.08,
    "resistance": {"a_n": 2000.0, "b_n_per_kmh": 20.0, "c_n_per_kmh2": 0.6},
    "drive": {
        "kind": "inverter",
        "starting_effort_kn": 150.0,
        "power_kw": 2000.0,
        "efficiency": 0.87,
        "max_current_a": 1000.0,
        "knee_factor": 0.9,
    },
    "brake": {"electric_effort_kn": 120.0, "electric_power_kw": 2000.0, "service_rate_mps2": 0.8},
    "auxiliaries": {"power_kw": 60.0, "heating_kw": 60.0, "heating": "constant_power"},
}

_EXPRESS: dict[str, Any] = {
    "format": 1,
    "id": "express",
    "name": "Locomotive with six coaches",
    "source": _ASSUMED,
    "category": "passenger",
    "vehicles": [{"id": "locomotive"}, {"id": "coach", "count": 6, "load_percent": 60.0}],
}

_LOCAL: dict[str, Any] = {
    "format": 1,
    "id": "local",
    "name": "One multiple unit",
    "source": _ASSUMED,
    "category": "passenger",
    "vehicles": [{"id": "unit", "load_percent": 40.0}],
}

_REPORT: dict[str, Any] = {"format": 1, "company": "", "language": "en", "paper": "fit"}

FILES: dict[str, tuple[type[BaseModel], dict[str, Any]]] = {
    "line.yaml": (Line, _LINE),
    "supply.yaml": (Supply, _SUPPLY),
    "timetable.yaml": (Timetable, _TIMETABLE),
    "rollingstock/vehicles/locomotive.yaml": (Vehicle, _LOCOMOTIVE),
    "rollingstock/vehicles/coach.yaml": (Vehicle, _COACH),
    "rollingstock/vehicles/unit.yaml": (Vehicle, _UNIT),
    "rollingstock/trains/express.yaml": (Train, _EXPRESS),
    "rollingstock/trains/local.yaml": (Train, _LOCAL),
    "report.yaml": (Report, _REPORT),
    STUDY_FILE: (StudyFile, _STUDY),
}

README = """\
# A study of a traction supply

Written by `tractionpower new`. Two tracks of 20 km, a substation at each end, a section cabin in the middle, one load, and
two trains: an express from A to B and a local train from B to A that stops at C.
All values are assumed: put yours in their place.

| file | holds |
|---|---|
| `study.yaml` | names the other files, sets the simulated time |
| `line.yaml` | tracks, stations, profile, speed limits |
| `supply.yaml` | substations, section cabins, contact lines, return circuit, loads; as comments feeders, switches, bonds, earth |
| `timetable.yaml` | which train runs when and where, and where it stops |
| `report.yaml` | how the reports look: company, logo, language, sheets, figures |
| `rollingstock/trains/*.yaml` | trains: which vehicles they are made of |
| `rollingstock/vehicles/*.yaml` | vehicles: mass, running resistance, drive, brakes, auxiliaries |

A comment that starts with a key, such as `#seed: 1`, shows a key that may be left out, with its default. Any list of rows may
stand in a CSV file instead, for example `gradients: gradients.csv`; its header row names the keys. The name of a file of a
train or vehicle is its `id`; what is not in this folder is looked for in `rollingstock` of the working folder, then among
what ships with tractionpower.

```
tractionpower check .      lists everything that is wrong with the files
tractionpower journey .    computes the journeys of the trains at nominal voltage
tractionpower run .        computes trains and network together and writes tables and reports
```

Say here where your data come from, what is measured and what is assumed.
"""
