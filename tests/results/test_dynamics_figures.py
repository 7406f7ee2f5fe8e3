"""Key figures of a train as many vehicles, held against its tables; ledger and verdicts."""

import json

import numpy as np
import pytest
from fake_dynamics import fake_results, fake_run, fake_scenario

from tractionpower.kernels.chain_state import LINK
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.results.dynamics_figures import EnergyLedger, force_verdicts
from tractionpower.results.export import export_tables
from tractionpower.results.kept import input_hash_of
from tractionpower.results.results import Results


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    return fake_results(tmp_path_factory.mktemp("dynamics") / "fake")


def test_figures_are_those_of_the_tables(results):
    vehicles, extremes = results.table("vehicles"), results.table("coupling_extremes")
    first = vehicles[vehicles["vehicle"] == "1 v43-like"]
    most = extremes.loc[extremes["greatest_tension_kn"].idxmax()]
    figure = next(f for f in results.key_figures if f["name"] == "greatest_tension_kn")
    assert figure["value"] == pytest.approx(most["greatest_tension_kn"])
    assert figure["place"] == f"coupling {most['coupling']}"
    assert figure["time"] == f"{most['tension_at_s']:.2f} s"
    assert figure["unit"] == "kN"
    assert results.key_figure("greatest_compression_kn") == pytest.approx(extremes["greatest_compression_kn"].max())
    assert results.key_figure("greatest_speed_kmh") == pytest.approx(first["speed_kmh"].max())
    run_m = first["position_m"].iloc[-1] - first["position_m"].iloc[0]
    assert results.key_figure("distance_m") == pytest.approx(run_m)
    hardest = vehicles["acceleration_mps2"].abs().max()
    assert abs(results.key_figure("greatest_acceleration_mps2")) == pytest.approx(hardest, rel=1e-6)
    farthest = vehicles["relative_position_m"].abs().max()
    assert abs(results.key_figure("greatest_relative_movement_m")) == pytest.approx(farthest)
    assert all(figure["definition"] for figure in results.key_figures)


def test_stop_is_that_of_the_rows(results):
    vehicles = results.table("vehicles")
    first = vehicles[vehicles["vehicle"] == "1 v43-like"].set_index("time_s")
    (stop,) = results.run["stops"]
    assert stop["braked_at_s"] == 30.0
    still = vehicles.groupby("time_s")["speed_kmh"].apply(lambda v: v.abs().max() == 0.0)
    stopped = still.index[(still.index > 30.0) & still][0]
    assert stop["stopped_at_s"] == pytest.approx(stopped)
    way = first["position_m"].loc[stopped] - first["position_m"].loc[30.0]
    assert results.key_figure("stopping_distance_m") == pytest.approx(way, abs=1e-6)
    assert results.key_figure("mean_deceleration_mps2") == pytest.approx((stop["braked_from_kmh"] / 3.6) ** 2 / 2 / way)


def test_energies_add_up(results):
    ledger = results.run["ledgers"]["energy"]
    taken = sum(ledger[f"{name}_kwh"] for name in ("electric", "brake", "resistance", "gravity", "coupling", "kinetic_end"))
    assert ledger["traction_kwh"] + ledger["kinetic_start_kwh"] - taken == pytest.approx(ledger["gap_kwh"], abs=1e-12)
    assert ledger["closes"] and ledger["gap_share"] < 1e-9
    last = results.table("controls").iloc[-1]
    assert results.key_figure("traction_energy_kwh") == pytest.approx(last["traction_kwh"], rel=1e-9)
    assert results.key_figure("air_brake_energy_kwh") == pytest.approx(last["brake_kwh"], rel=1e-9)
    extremes = results.table("coupling_extremes")
    assert results.key_figure("coupling_energy_kwh") * 3600 == pytest.approx(extremes["absorbed_kj"].sum(), rel=1e-5)


def test_a_ledger_with_a_hole_is_told():
    ledger = EnergyLedger(3.6e6, 0.0, 1.8e6, 0.9e6, 0.0, 0.0, 0.0, 0.0)
    assert ledger.gap == pytest.approx(0.9e6)
    told = ledger.as_dict()
    assert not told["closes"] and told["gap_share"] == pytest.approx(0.25)
    downhill = EnergyLedger(0.0, 0.0, 3.6e6, 0.0, -3.6e6, 0.0, 0.0, 0.0)
    assert downhill.as_dict()["closes"] and downhill.put_in == pytest.approx(3.6e6)
    broken = EnergyLedger(float("nan"), 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).as_dict()
    assert not broken["closes"] and broken["gap_kwh"] is None
    json.dumps(broken, allow_nan=False)
    from_nothing = EnergyLedger(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0).as_dict()
    assert not from_nothing["closes"] and EnergyLedger(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0).as_dict()["closes"]


def coupling(name, tension, compression):
    return Coupling.model_validate(
        {
            "id": name, "source": f"source of {name}", "status": "secondary", "draw": {"stiffness_kn_per_mm": 1.0},
            "endurable_tension_kn": tension, "endurable_compression_kn": compression,
        }
    )  # fmt: skip


def test_each_kind_of_coupling_is_judged_at_its_worst_place():
    links = np.zeros(3, LINK)
    links["greatest_n"], links["greatest_at_s"] = [1e5, 9e5, 3e5], [1.0, 2.0, 3.0]
    links["least_n"], links["least_at_s"] = [-5e4, -1e4, -2e5], [4.0, 5.0, 6.0]
    weak, strong = coupling("weak", 250.0, 240.0), coupling("strong", 850.0, None)
    verdicts = list(force_verdicts(["1-2", "2-3", "3-4"], [weak, strong, weak], links))
    told = [(v["limit"], v["value"], v["place"], v["time"], v["met"]) for v in verdicts]
    assert told == [
        ("endurable_tension of strong", 900.0, "coupling 2-3", "2.00 s", False),
        ("endurable_tension of weak", 300.0, "coupling 3-4", "3.00 s", False),
        ("endurable_compression of weak", 200.0, "coupling 3-4", "6.00 s", True),
    ]
    assert {v["source"] for v in verdicts} == {"source of weak", "source of strong"}
    assert {v["status"] for v in verdicts} == {"secondary"}


def test_a_force_that_never_was_is_met():
    links = np.zeros(1, LINK)
    links["greatest_n"] = -1e3
    (tension, compression) = force_verdicts(["1-2"], [coupling("a", 10.0, 10.0)], links)
    assert (tension["value"], tension["time"], tension["met"]) == (0.0, "", True)
    assert compression["met"]


def test_the_scenario_is_kept_with_the_results(results, tmp_path):
    assert results.scenario == fake_scenario()
    assert results.run["input_hash"] == input_hash_of(fake_scenario())
    other = fake_scenario(grade="train")
    assert input_hash_of(other) != input_hash_of(fake_scenario())
    assert Results.open(fake_folder(tmp_path, grade="train")).scenario == other


def fake_folder(tmp_path, **case):
    folder = tmp_path / "other"
    fake_results(folder, **case)
    return folder


def test_tables_go_to_other_programs(results, tmp_path):
    names = {
        path.name for path in export_tables(results, tmp_path, ["csv", "xlsx"], ["controls", "coupling_extremes", "rainflow"])
    }
    assert names == {"controls.csv", "coupling_extremes.csv", "rainflow.csv", "tables.xlsx"}
    lines = (tmp_path / "coupling_extremes.csv").read_text(encoding="utf-8").splitlines()
    assert len(lines) == 6 and lines[1].startswith('"1-2",')


def test_the_fake_is_a_train_that_obeys_newton():
    """What readers are tested with has to be plausible itself: forces in the couplings move what is behind them."""
    made = fake_run()
    state = made.vehicles
    k = np.flatnonzero(made.chain["time_s"] == 10.0)[0]
    assert made.chain["drive"][k] == 9
    behind = state["a_mps2"][k - 20 : k + 20, 1:].mean()  # mean over its oscillations
    masses = 5 * 40e3 * 1.04
    pulled = made.links["force_n"][k - 20 : k + 20, 0].mean()
    resisted = (state["resistance_n"] + state["grade_n"])[k - 20 : k + 20, 1:].sum(axis=1).mean()
    assert pulled - resisted == pytest.approx(masses * behind, rel=0.05)
