import pytest

from tractionpower.errors import UsageError
from tractionpower.io import finder
from tractionpower.io.finder import data_folder, find_study, shipped_names


@pytest.fixture
def places(tmp_path, monkeypatch):
    """A working folder with lines/cmk and a package with cmk and e65."""
    for name in ("work/lines/cmk", "package/lines/cmk", "package/lines/e65"):
        (tmp_path / name).mkdir(parents=True)
        (tmp_path / name / "study.yaml").write_text("format: 1\n")
    monkeypatch.chdir(tmp_path / "work")
    monkeypatch.setattr(finder, "data_folder", lambda kind: tmp_path / "package" / kind)
    return tmp_path


def test_a_folder_and_a_file(places):
    folder = places / "package/lines/e65"
    for study in (folder, folder / "study.yaml", str(folder)):
        found = find_study(study)
        assert (found.file, found.folder, found.origin) == (folder / "study.yaml", folder, str(study))


def test_the_working_folder_comes_before_the_package(places):
    assert find_study("cmk").folder == places / "work/lines/cmk"
    assert "working folder" in find_study("cmk").origin
    assert find_study("e65").folder == places / "package/lines/e65"
    assert "ship" in find_study("e65").origin


def test_a_path_that_exists_wins(places):
    (places / "work/e65").mkdir()
    (places / "work/e65/study.yaml").write_text("format: 1\n")
    assert find_study("e65").folder == places / "work/e65"


def test_an_unknown_name_lists_the_known_ones(places):
    with pytest.raises(UsageError, match=r"did you mean cmk.*cmk, e65"):
        find_study("cmj")


@pytest.mark.parametrize("name", ["", " ", "a\0b", "x" * 5000, "../nowhere", "lines/none", "..\\x"])
def test_names_that_are_no_study(places, name):
    with pytest.raises(UsageError):
        find_study(name)


def test_a_folder_without_a_study(places):
    with pytest.raises(UsageError, match=r"no study\.yaml"):
        find_study(places)


def test_shipped_names_are_sorted_and_unique(places):
    assert shipped_names() == ["cmk", "e65"]


def test_data_of_a_checkout_lie_beside_the_sources():
    assert data_folder("lines").name == "lines"
    assert data_folder("lines").is_absolute()


def test_a_shipped_line_is_named_with_one_of_its_study_files(places):
    (places / "package/lines/e65/trains.yaml").write_text("format: 1\n")
    found = find_study("e65/trains.yaml")
    assert (found.file, found.folder) == (places / "package/lines/e65/trains.yaml", places / "package/lines/e65")
    assert "ship" in found.origin
    for name in ("e65/none.yaml", "../e65/trains.yaml", "trains.yaml", "e65/trains"):
        with pytest.raises(UsageError):
            find_study(name)
