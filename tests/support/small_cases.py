"""Small cases of train dynamics as files."""

from __future__ import annotations

from pathlib import Path

CASE = """\
format: 1
name: A locomotive and three wagons
vehicles:
  - {id: v43}
  - {id: wagon-zobory, count: 3}
coupling: zobory-linear
traction: {starting_effort_kn: 270, power_kw: 2220}
brake: {brake_ratio: 0.6}
run: {duration_s: 60, step_s: 0.01, record_every_s: 0.1}
"""


def write_small_case(folder: Path) -> Path:
    """Write a case of shipped vehicles into a folder, and return the folder."""
    folder.mkdir(parents=True)
    (folder / "case.yaml").write_text(CASE, encoding="utf-8")
    return folder
