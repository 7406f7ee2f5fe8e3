"""Key figures of a train as many vehicles, held against its tables; ledger and verdicts."""

import numpy as np
import pytest
from fake_dynamics import fake_results, fake_run, fake_scenario

from tractionpower.kernels.chain_state import LINK, MOVER
from tractionpower.model.dynamics.coupling import Coupling
from tractionpower.results.dynamics_figures import force_verdicts, motion_figures, stop_figures
from tractionpower.results.export import export_tables
from tractionpower.results.kept import input_hash_of
from tractionpower.results.results import Results
from tractionpower.results.stops import Stop


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
    top = first["speed_kmh"].max()  # of the rows, 0.05 s apart; figures are those of all steps
    assert top <= results.key_figure("greatest_speed_kmh") <= top + 0.05
    run_m = first["position_m"].iloc[-1] - first["position_m"].iloc[0]
    assert results.key_figure("distance_m") == pytest.approx(run_m)
    hardest = vehicles["acceleration_mps2"].abs().max()
    assert hardest * (1.0 - 1e-6) <= abs(results.key_figure("greatest_acceleration_mps2")) <= 1.2 * hardest
    farthest = vehicles["relative_position_m"].abs().max()
    assert farthest * (1.0 - 1e-6) <= abs(results.key_figure("greatest_relative_movement_m")) <= 1.01 * farthest
    assert all(figure["definition"] for figure in results.key_figures)


def test_stop_is_that_of_the_rows(results):
    vehicles = results.table("vehicles")
    first = vehicles[vehicles["vehicle"] == "1 v43-like"].set_index("time_s")
    (stop,) = results.run["stops"]
    assert stop["braked_at_s"] == 30.0
    still = vehicles.groupby("time_s")["speed_kmh"].apply(lambda v: v.abs().max() == 0.0)
    stopped = still.index[(still.index > 30.0) & still][0]
    assert stopped - 0.05 <= stop["stopped_at_s"] <= stopped  # to the step, the rows are 0.05 s apart
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


def told(figures):
    return {figure.name: figure for figure in figures}


def test_a_train_that_rolls_backwards_is_told_in_magnitudes():
    movers = np.zeros(2, MOVER)
    movers["s_m"], movers["start_m"] = [-40.0, -54.0], [-7.0, -21.0]
    movers["greatest_mps"], movers["greatest_at_s"] = [-3.0, -3.1], [61.0, 62.0]
    movers["sharpest_mps2"], movers["sharpest_at_s"] = [-0.2, 0.5], [1.0, 63.0]
    movers["furthest_m"], movers["furthest_at_s"] = [0.0, -0.03], [0.0, 64.0]
    figures = told(motion_figures(movers, ["1 a", "2 b"]))
    top, run = figures["greatest_speed_kmh"], figures["distance_m"]
    assert (top.value, top.place, top.time) == (pytest.approx(10.8), "vehicle 1 a, backwards", "61.00 s")
    assert (run.value, run.place) == (33.0, "vehicle 1 a, backwards")
    sharpest, furthest = figures["greatest_acceleration_mps2"], figures["greatest_relative_movement_m"]
    assert (sharpest.value, sharpest.place, sharpest.time) == (0.5, "vehicle 2 b", "63.00 s")
    assert (furthest.value, furthest.place, furthest.time) == (-0.03, "vehicle 2 b", "64.00 s")


def test_a_train_that_has_not_moved_was_at_its_greatest_speed_nowhere():
    figures = told(motion_figures(np.zeros(1, MOVER), ["1 a"]))
    assert {(figure.value, figure.time) for figure in figures.values()} == {(0.0, "")}
    assert "greatest_relative_movement_m" not in figures


def test_figures_of_a_stop_share_their_place():
    figures = list(stop_figures([Stop(9.0, 1.0), Stop(30.0, -50.0, 20.0, -30.0, -4.0)]))
    assert {figure.place for figure in figures} == {"stop 2, backwards"}
    values = {figure.name: figure.value for figure in figures}
    assert values["stopping_distance_m"] == 20.0 and values["stopping_time_s"] == 10.0
    assert values["braked_from_kmh"] == pytest.approx(14.4)
    assert values["mean_deceleration_mps2"] == pytest.approx(16.0 / 40.0)


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
