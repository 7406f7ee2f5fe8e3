"""Where cases are found: a path, the working folder, what ships; and words for a name that nobody knows."""

import pytest

from tractionpower.errors import UsageError
from tractionpower.io import case_finder
from tractionpower.io.case_finder import find_case, shipped_cases


@pytest.fixture
def put(tmp_path, monkeypatch):
    places = {name: tmp_path / name for name in ("work", "ships")}
    for folder in places.values():
        folder.mkdir()
    monkeypatch.chdir(places["work"])
    monkeypatch.setattr(case_finder, "data_folder", lambda kind: places["ships"] / kind)

    def write(place, name, file="case.yaml"):
        path = places[place] / "rollingstock" / "dynamics" / name / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("format: 1\n", encoding="utf-8")
        return path

    return write


def test_a_name_is_looked_up_in_the_working_folder_then_in_what_ships(put):
    shipped = put("ships", "hill")
    assert find_case("hill").file == shipped
    assert find_case("hill").origin == "the cases that ship with tractionpower"
    own = put("work", "hill")
    assert (find_case("hill").file, find_case("hill").name) == (own, "hill")
    put("ships", "paper", "Simulation.ini")
    put("ships", "notes", "README.md")
    assert shipped_cases() == ["hill", "paper"]
    assert find_case("paper").is_ini


def test_a_path_that_exists_wins(put, tmp_path):
    file = put("work", "a", "fast.yaml")
    assert find_case(file).name == "fast"
    assert find_case(put("work", "a")).name == "a"
    folder = put("ships", "b", "Run.INI").parent
    assert find_case(folder).file == folder / "Run.INI"
    assert find_case(folder / "Run.INI").name == "Run"
    (tmp_path / "work" / "hill").mkdir()
    put("ships", "hill")
    with pytest.raises(UsageError, match=r"no case.yaml and no configuration .ini"):
        find_case("hill")


def test_the_case_file_stands_before_configurations(put):
    put("ships", "both", "Simulation.ini")
    file = put("ships", "both")
    assert find_case("both").file == file


@pytest.mark.parametrize("name", ["hil", "../hill", "a/b", "x" * 5000, "a\0b"])
def test_an_unknown_name(put, name):
    put("ships", "hill")
    with pytest.raises(UsageError, match=r"there is no case .*cases that ship: hill"):
        find_case(name)


def test_the_nearest_name_is_given(put):
    put("ships", "hill")
    with pytest.raises(UsageError, match="did you mean hill"):
        find_case("hil")
    with pytest.raises(UsageError, match="empty"):
        find_case(" ")


def test_several_configurations_are_named(put):
    put("work", "two", "a.ini")
    folder = put("work", "two", "b.ini").parent
    with pytest.raises(UsageError, match=r"several configurations: a.ini, b.ini; name one"):
        find_case(folder)
