"""A small study with two trains of its own on six kilometres, as files."""

from pathlib import Path

FILES = {
    "study.yaml": (
        'format: 1\nname: Six kilometres\nclock: {start: "06:00:00", end: "07:00:00", step_s: 1.0}\ntimetable: timetable.yaml\n'
    ),
    "line.yaml": (
        "format: 1\n"
        "tracks:\n"
        '  - {id: "1", from_km: 0.0, to_km: 6.5}\n'
        '  - {id: "2", from_km: 0.0, to_km: 6.5}\n'
        "stations:\n"
        "  - {id: A, name: Alfa, km: 0.5}\n"
        "  - {id: B, name: Łódź Bravo, km: 3.0}\n"
        "  - {id: P, name: Papa, km: 4.0}\n"
        "  - {id: C, name: Charlie, km: 6.0}\n"
        "gradients:\n"
        "  - {from_km: 0.0, to_km: 4.0, permille: 0.0}\n"
        "  - {from_km: 4.0, to_km: 6.5, permille: 10.0}\n"
        "speed_limits:\n"
        "  - {from_km: 0.0, to_km: 6.5, kmh: 100.0}\n"
    ),
    "supply.yaml": (
        "format: 1\n"
        "substations:\n"
        "  - {id: S, km: 0.0, no_load_voltage_v: 3300, internal_resistance_ohm: 0.1}\n"
        "contact_lines:\n"
        "  - {from_km: 0.0, to_km: 6.5, resistance_ohm_per_km: 0.05}\n"
        "return_circuit:\n"
        "  - {from_km: 0.0, to_km: 6.5, resistance_ohm_per_km: 0.01}\n"
    ),
    "timetable.yaml": (
        "format: 1\n"
        "trains:\n"
        '  - id: "11"\n'
        "    train: local\n"
        '    route: [{track: "1", from_km: 0.5, to_km: 6.0}]\n'
        "    calls:\n"
        '      - {station: A, departure: "06:00:00"}\n'
        '      - {station: B, arrival: "06:03:00", departure: "06:03:20", min_dwell_s: 20}\n'
        '      - {station: P, arrival: "06:05:00", stops: false}\n'
        '      - {station: C, arrival: "06:06:00"}\n'
        "  - id: EC 2/1\n"
        "    train: local\n"
        '    route: [{track: "2", from_km: 6.0, to_km: 0.5}]\n'
        '    start: {time: "06:01:00", speed_kmh: 60}\n'
    ),
    "rollingstock/vehicles/railcar.yaml": (
        "format: 1\n"
        "id: railcar\n"
        "kind: multiple_unit\n"
        "mass_t: 100\n"
        "length_m: 60\n"
        "max_speed_kmh: 120\n"
        "rotating_mass_factor: 1.1\n"
        "resistance: {a_n: 2000, c_n_per_kmh2: 0.5}\n"
        "drive: {kind: inverter, starting_effort_kn: 100, power_kw: 1000, efficiency: 0.85, max_current_a: 600}\n"
        "brake: {electric_effort_kn: 60, electric_power_kw: 900, service_rate_mps2: 0.6}\n"
        "auxiliaries: {power_kw: 50}\n"
    ),
    "rollingstock/trains/local.yaml": "format: 1\nid: local\nvehicles: [{id: railcar}]\n",
}


def write_train_study(folder: Path, **changed: str) -> Path:
    """Write the study into `folder`; `changed` are texts of files without their ending."""
    for name, text in FILES.items():
        file = folder / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(changed.get(Path(name).stem, text), encoding="utf-8")
    return folder
