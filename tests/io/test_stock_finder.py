"""Where trains and vehicles are found: the study's folder, the working folder, what ships, in this order."""

import pytest

from tractionpower.errors import InputError
from tractionpower.io.rolling_stock import shipped_trains, shipped_vehicles
from tractionpower.io.stock_finder import find_rolling_stock, known_rolling_stock, not_found, unknown_stock


@pytest.fixture
def put(tmp_path, stock_places):
    places = stock_places | {"study": tmp_path / "study"}

    def write(place, name, kind="vehicles"):
        file = places[place] / "rollingstock" / kind / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text("format: 1\n", encoding="utf-8")
        return file

    return write


def test_the_first_that_exists_wins(put, tmp_path):
    study = tmp_path / "study"
    assert find_rolling_stock("vehicles", "a", study) is None
    for place in ("ships", "work", "study"):
        file = put(place, "a.yaml")
        assert find_rolling_stock("vehicles", "a", study) == file
    assert find_rolling_stock("trains", "a", study) is None
    assert find_rolling_stock("vehicles", "a", None) == tmp_path / "places/work/rollingstock/vehicles/a.yaml"


@pytest.mark.parametrize("name", ["a/b", "../x", "..", "a\\b", "C:", "krak\u00f3w", "x" * 290])
def test_no_identifier_leaves_the_folder(put, tmp_path, name):
    put("work", "x.yaml", "trains")
    assert find_rolling_stock("vehicles", name, tmp_path) is None


def test_names_in_bytes_and_with_other_accents_are_found(put):
    file = put("work", "a%2Fb.yaml")
    assert find_rolling_stock("vehicles", "a/b", None) == file
    file = put("work", "krako\u0301w.yaml")
    assert find_rolling_stock("vehicles", "krak\u00f3w", None) == file


def test_capitals_are_kept_apart(put):
    put("work", "EN57.yaml")
    assert find_rolling_stock("vehicles", "en57", None) is None


def test_two_files_for_one_id_are_a_problem(put):
    put("work", "a%2Fb.yaml")
    put("work", "a%2fb.yaml")
    with pytest.raises(InputError) as caught:
        find_rolling_stock("vehicles", "a/b", None)
    (problem,) = caught.value.problems
    assert (problem.code, problem.path) == ("two_files", "vehicles[a/b]")
    assert "a%2Fb.yaml, a%2fb.yaml" in problem.found


def test_known_and_shipped_ids_are_sorted_and_unique(put, tmp_path):
    for place, name in (("ships", "b.yaml"), ("ships", "a%2Fb.yaml"), ("work", "c.yaml"), ("study", "b.yaml")):
        put(place, name)
    put("ships", "readme.md")
    put("ships", "ic.yaml", "trains")
    assert known_rolling_stock("vehicles", tmp_path / "study") == ["a/b", "b", "c"]
    assert known_rolling_stock("vehicles", None) == ["a/b", "b", "c"]
    assert (shipped_trains(), shipped_vehicles()) == (["ic"], ["a/b", "b"])


def test_what_is_not_found_is_told_with_the_nearest_or_all(put):
    put("work", "ep09.yaml")
    problem = not_found("vehicles", "ep9", None, "trains[x].vehicles[0].id", "x.yaml:3")
    assert (problem.code, problem.path, problem.place) == ("unknown_vehicle", "trains[x].vehicles[0].id", "x.yaml:3")
    assert problem.found == "there is no vehicle 'ep9'"
    assert problem.allowed == "a file in rollingstock/vehicles of the working folder or the data that ship"
    assert problem.remedy == "did you mean ep09?"
    assert not_found("vehicles", "zzz", None, "", "").remedy == "add the file; known vehicles: ep09"
    assert not_found("trains", "zzz", None, "", "").remedy == "add the file; no trains are known"
    words = unknown_stock("ep9", ("trains", "vehicles"))
    assert "there is no train 'ep9'" in words
    assert "did you mean ep09?" in words
    assert "no trains are known; known vehicles: ep09" in words


def test_many_known_ids_are_shortened(put):
    for number in range(40):
        put("work", f"v{number:02}.yaml")
    assert "... (40 in all)" in not_found("vehicles", "zzz", None, "", "").remedy


def test_couplings_are_found_and_told_like_vehicles(put):
    file = put("work", "hook.yaml", "couplings")
    assert find_rolling_stock("couplings", "hook", None) == file
    assert known_rolling_stock("couplings", None) == ["hook"]
    told = not_found("couplings", "hok", None, "case.coupling", "case.yaml:3")
    assert (told.code, told.remedy) == ("unknown_coupling", "did you mean hook?")
    assert told.found == "there is no coupling 'hok'"
