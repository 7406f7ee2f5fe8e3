"""A small network study as files, and its folder of results."""

from pathlib import Path

STUDY = {
    "study.yaml": 'format: 1\nname: Small\nclock: {start: "00:00:00", end: "00:01:00"}\n',
    "line.yaml": 'format: 1\ntracks:\n  - {id: "1", from_km: 0.0, to_km: 20.0}\n',
    "supply.yaml": (
        "format: 1\n"
        "substations:\n"
        "  - {id: A, km: 0.0, no_load_voltage_v: 3600, internal_resistance_ohm: 0.12}\n"
        "  - {id: Łódź, km: 20.0, no_load_voltage_v: 3600, internal_resistance_ohm: 0.12}\n"
        "contact_lines:\n"
        "  - {from_km: 0.0, to_km: 20.0, resistance_ohm_per_km: 0.05}\n"
        "return_circuit:\n"
        "  - {from_km: 0.0, to_km: 20.0, resistance_ohm_per_km: 0.01}\n"
        "loads:\n"
        '  - {id: train, track: "1", km: 10.0, power_kw: 3000, limits: none}\n'
    ),
}


def write_small_study(folder: Path) -> Path:
    """Write the study into `folder`."""
    folder.mkdir(parents=True)
    for name, text in STUDY.items():
        (folder / name).write_text(text, encoding="utf-8")
    return folder
