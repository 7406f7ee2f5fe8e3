"""The couplings that ship: every file reads and passes the checks, and has the forces and energies that its source tells."""

from pathlib import Path

import numpy as np
import pytest

from tractionpower.dynamics.coupling_checks import check_coupling
from tractionpower.dynamics.couplings import loop
from tractionpower.io.documents import read_document
from tractionpower.model.dynamics.coupling import Coupling

FOLDER = Path(__file__).parents[2] / "rollingstock" / "couplings"
SHIPPED = sorted(path.stem for path in FOLDER.glob("*.yaml"))
KIP_KN, INCH_MM = 4.4482216, 25.4


def load(name):
    return read_document(FOLDER / f"{name}.yaml", Coupling)


@pytest.mark.parametrize("name", SHIPPED)
def test_reads_and_passes(name):
    found = load(name)
    assert found.id == name
    assert found.name
    assert found.source
    assert check_coupling(found, name) == []
    assert f"| `{name}` |" in (FOLDER / "README.md").read_text(encoding="utf-8")


def test_the_readme_lists_them_all():
    rows = [line for line in (FOLDER / "README.md").read_text(encoding="utf-8").splitlines() if line.startswith("| `")]
    assert len(rows) == len(SHIPPED) == 9


def test_the_example_of_the_page_is_sound(tmp_path):
    page = (FOLDER.parents[1] / "docs" / "couplings.md").read_text(encoding="utf-8")
    path = tmp_path / "my-gear.yaml"
    path.write_text(page.split("```yaml\n")[1].split("```")[0], encoding="utf-8")
    found = read_document(path, Coupling)
    assert check_coupling(found, "my-gear") == []
    assert found.id == path.stem


def energies(name, half_slack_mm, top_mm):
    """Return the work that pushing takes up to a deflection of the buffers, and what is lost of it on the way back [kJ]."""
    way = -np.r_[np.linspace(0.0, half_slack_mm + top_mm, 4001), half_slack_mm + top_mm - np.geomspace(1e-6, top_mm, 4001)]
    forces = loop(load(name), way, 1.0)
    parts = 0.5 * (forces[1:] + forces[:-1]) * np.diff(way) / 1e3
    return parts[:4000].sum(), parts.sum()


@pytest.mark.parametrize(
    ("name", "half_slack_mm", "least_kj", "most_kj", "damping"),
    [
        ("uic-buffers-a", 0.0, 30.0, 50.0, 0.5),
        ("uic-screw-coupling", 15.0, 30.0, 50.0, 0.5),
        ("uic-cat-c", 0.0, 70.0, np.inf, 0.8),
    ],
)
def test_energy_of_a_buffer(name, half_slack_mm, least_kj, most_kj, damping):
    # Four buffers, whose stroke is 105 mm; a loop with a locked stiffness loses somewhat less than its damping.
    taken, lost = energies(name, half_slack_mm, 2.0 * 105.0)
    assert least_kj <= taken / 4.0 <= most_kj
    assert 0.85 * damping < lost / taken < damping


def test_end_force_of_buffers_of_category_a():
    assert loop(load("uic-buffers-a"), [-210.0], 1.0)[0] == pytest.approx(-2.0 * 590.0)


@pytest.mark.parametrize(("name", "first", "second"), [("arshad", 6.0, 17.0), ("arshad-eq8-9", 10.0, 25.0)])
def test_springs_of_arshad(name, first, second):
    # Half the slack of 100 mm, then the wedge of 35 degrees with a friction of 0.2.
    factor = 0.7002075 / (0.7002075 - 0.2)
    forces = loop(load(name), [50.0, 70.0, 100.0, 130.0], 1.0)
    np.testing.assert_allclose(
        forces, factor * np.array([0.0, 20.0 * first, 50.0 * first, 50.0 * first + 30.0 * second]), rtol=1e-6
    )


def test_points_of_tps():
    found = load("tps-friction")
    inches, kips = np.array([0.75, 3.0, 4.0]), np.array([200.0, 325.0, 400.0])
    way = np.r_[2.0 * INCH_MM * inches, -2.0 * INCH_MM * inches]
    rests = loop(found, np.repeat(way, 2), 1e-9)[1::2]
    np.testing.assert_allclose(rests, np.r_[KIP_KN * kips, -KIP_KN * kips], rtol=1e-4)


def test_points_of_the_russian_gear():
    found = load("russian-elastic-friction")
    forces = loop(found, [25.0, 25.5, 115.0, 65.0, 25.0], 1.0)
    np.testing.assert_allclose(forces, [0.0, 125.0, 240.0 + 25.7 * 90.0, 50.0 + 2.85 * 40.0, 0.0], rtol=1e-9)


@pytest.mark.parametrize(("name", "mass_t"), [("zobory-linear", 80.0), ("zobory-linear", 40.0), ("rigid", 20.0)])
def test_damping_of_a_pair(name, mass_t):
    found = load(name)
    critical = 2.0 * np.sqrt(1e6 * found.draw.stiffness_kn_per_mm * 500.0 * mass_t) / 1e3  # kN s/m, reduced mass m/2
    assert 0.05 <= found.damping_kns_per_m / critical <= 0.11
