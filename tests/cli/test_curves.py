"""``tractionpower curves``: what it writes, says and returns."""

import re

import pandas as pd
import pytest
from train_study import write_train_study

from tractionpower.cli import main


@pytest.fixture(autouse=True)
def study(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return write_train_study(tmp_path / "six")


def test_a_vehicle_from_a_file(tmp_path, capsys):
    assert main(["curves", "six/rollingstock/vehicles/railcar.yaml"]) == 0
    told = capsys.readouterr()
    folder = tmp_path / "reports" / "curves"
    assert {path.name for path in folder.iterdir()} == {"railcar.png", "railcar.csv"}
    assert (folder / "railcar.png").stat().st_size > 20_000
    assert "starting effort at 3000 V: 100.0 kN" in told.out
    assert "railcar: 100.0 t, 60.0 m, 120 km/h" in told.out
    table = pd.read_csv(folder / "railcar.csv")
    assert {2000.0, 2700.0, 3000.0, 3600.0} <= set(table["voltage_v"])
    at_nominal = table[table["voltage_v"] == 3000.0]
    most = float(re.search(r"greatest current: (\d+) A", told.out)[1])
    assert most == pytest.approx(min(600.0, table["current_a"].max()), abs=0.5)
    # 1000 kW at the wheel: v = P/F beyond 36 km/h; resistance 2000 N + 0.5 N V2 on the level
    row = at_nominal.iloc[(at_nominal["speed_kmh"] - 90.0).abs().argmin()]
    assert row["effort_kn"] == pytest.approx(1000.0 / (row["speed_kmh"] / 3.6), rel=1e-3)
    assert row["resistance_kn"] == pytest.approx((2000.0 + 0.5 * row["speed_kmh"] ** 2) / 1000.0, rel=1e-3)
    assert row["current_a"] == pytest.approx((1000.0 / 0.85 + 50.0) / 3.0, rel=1e-3)


def test_a_train_with_its_balancing_speed(tmp_path, study, capsys):
    file = study / "rollingstock" / "vehicles" / "railcar.yaml"
    text = file.read_text(encoding="utf-8").replace("max_speed_kmh: 120", "max_speed_kmh: 250")
    file.write_text(text.replace("c_n_per_kmh2: 0.5", "c_n_per_kmh2: 0.8"), encoding="utf-8")
    assert main(["curves", "six/rollingstock/trains/local.yaml", "--voltage", "3000", "--out", "here"]) == 0
    told = capsys.readouterr().out
    # 3.6e6 / V = 2000 + 0.8 V2: V = 160.2 km/h
    speed = float(re.search(r"balancing speed on the level at 3000 V: ([\d.]+) km/h", told)[1])
    assert 3.6e6 / speed == pytest.approx(2000.0 + 0.8 * speed**2, rel=2e-3)
    assert {path.name for path in (tmp_path / "here").iterdir()} == {"local.png", "local.csv"}
    assert set(pd.read_csv(tmp_path / "here" / "local.csv")["voltage_v"]) == {3000.0}


@pytest.mark.parametrize("train", ["ep09-10-coaches", "vectron-dc"])
def test_shipped_trains_and_vehicles(tmp_path, train, capsys):
    assert main(["curves", train, "--voltage", "2400", "--voltage", "3600"]) == 0
    assert (tmp_path / "reports" / "curves" / f"{train}.png").is_file()
    assert "starting effort at 3000 V" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["ep09-10-coach"], "did you mean"),
        (["en57", "--voltage", "-3"], "--voltage -3: allowed are"),
        (["en57", "--voltage", "inf"], "--voltage inf: allowed are"),
        (["en57", "--system", "dc9"], "no system 'dc9'; known: dc1500"),
    ],
)
def test_wrong_usage(tmp_path, arguments, words, capsys):
    assert main(["curves", *arguments]) == 2
    assert words in capsys.readouterr().err
    assert not (tmp_path / "reports").exists()


def test_a_broken_file_is_told_with_its_line(study, capsys):
    file = study / "rollingstock" / "vehicles" / "railcar.yaml"
    file.write_text(file.read_text(encoding="utf-8").replace("mass_t: 100", "mass_t: -1"), encoding="utf-8")
    assert main(["curves", str(file)]) == 1
    assert "railcar.yaml:4" in capsys.readouterr().err


RAILCAR = "rollingstock/vehicles/railcar.yaml"


def edit(file, *changes):
    text = file.read_text(encoding="utf-8")
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    file.write_text(text, encoding="utf-8")


def test_all_faults_of_a_train_are_told_and_nothing_is_drawn(tmp_path, study, capsys):
    maps = (
        "efficiency_map: [{speed_kmh: 0, load_percent: 50, efficiency: 0.8}, {speed_kmh: 9, load_percent: 99, efficiency: 0.8}]"
    )
    edit(study / RAILCAR, ("efficiency: 0.85", f"{maps}, fold_back_from_v: 4000"), ("a_n: 2000, c_n_per_kmh2: 0.5", ""))
    assert main(["curves", "six/rollingstock/trains/local.yaml"]) == 1
    told = capsys.readouterr().err
    assert told.count("error: ") == 3
    assert "vehicles[railcar].drive.efficiency_map: the load of 50 % has no point at 9 km/h" in told
    assert "vehicles[railcar].drive.fold_back_from_v: found a fold-back from 4000 V to 3900 V by default" in told
    assert "warning: six/rollingstock/trains/local.yaml: vehicles[railcar].resistance: " in told
    assert "3 errors, 1 warning" in told
    assert not (tmp_path / "reports").exists()


def test_doubts_are_told_and_the_curves_drawn(tmp_path, study, capsys):
    edit(study / RAILCAR, ("max_current_a: 600", "max_current_a: 15"))
    assert main(["curves", f"six/{RAILCAR}"]) == 0
    assert "the auxiliaries of the train take 17 A at 3000 V" in capsys.readouterr().err
    assert (tmp_path / "reports" / "curves" / "railcar.png").is_file()


def test_a_folder_that_cannot_be_made(tmp_path, capsys):
    (tmp_path / "reports").write_text("in the way", encoding="utf-8")
    assert main(["curves", "vectron-dc"]) == 3
    assert "curves cannot be written into" in capsys.readouterr().err


@pytest.mark.parametrize("vehicle", ["coach", "wagon-eaos"])
def test_a_vehicle_without_a_drive_has_its_resistance_only(tmp_path, vehicle, capsys):
    assert main(["curves", vehicle]) == 0
    told = capsys.readouterr().out
    assert "no drive" in told
    assert not any(word in told for word in ("balancing", "effort", "current", "gradient"))
    assert (tmp_path / "reports" / "curves" / f"{vehicle}.png").is_file()


def test_the_balancing_speed_above_the_top_speed_and_the_steepest_start(capsys):
    assert main(["curves", f"six/{RAILCAR}"]) == 0
    told = capsys.readouterr().out
    # 3.6e6 / V = 2000 + 0.5 V2: V = 186.3 km/h
    found = re.search(r"at 3000 V: ([\d.]+) km/h, above its greatest speed of 120 km/h", told)
    assert 3.6e6 / float(found[1]) == pytest.approx(2000.0 + 0.5 * float(found[1]) ** 2, rel=5e-3)
    # 100 kN - 2 kN, over the weight of 100 t
    assert "steepest gradient on which it can start at 3000 V: 99.9 ‰" in told


def test_the_curve_of_a_table_does_not_go_beyond_it(study, capsys):
    drive = "{kind: table, effort: [{speed_kmh: 0, effort_kn: 90}, {speed_kmh: %d, effort_kn: %d}], "
    drive += "current: [{speed_kmh: 0, current_a: 10}, {speed_kmh: 120, current_a: 900}]}"
    file = study / RAILCAR
    text = re.sub(r"drive:.*?(?=\n\w)", "drive: " + drive, file.read_text(encoding="utf-8"), flags=re.DOTALL)
    for (speed, effort), words in {(120, 45): "above its greatest speed\n", (200, 0): "above its greatest speed of 120"}.items():
        file.write_text(text % (speed, effort), encoding="utf-8")
        assert main(["curves", f"six/{RAILCAR}"]) == 0
        assert words in capsys.readouterr().out
