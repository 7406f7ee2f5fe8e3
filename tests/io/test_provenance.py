import pytest

from tractionpower.errors import Problem
from tractionpower.io.provenance import Mark, Provenance, list_mark, path_of, split_path
from tractionpower.io.scenario_files import load_scenario


@pytest.fixture
def provenance(write_study):
    folder = write_study(
        {"line.yaml": "gradients: g.csv\nstations:\n  - {id: a.b, km: 1, stop_km: {1 increasing: 0.9}}\n"},
        g_csv="from_km,to_km,permille\n0,1,2\n1,2,3\n",
        study_yaml="format: 1\nlimits: l.csv\nclock:\n  start: 00:00\n  end: 01:00\n",
        l_csv="system,name,value,unit\ndc3000,u_max2,3950,V\n",
    )
    return load_scenario(folder).provenance


@pytest.mark.parametrize(
    ("path", "place"),
    [
        ("clock.start", "study.yaml:4"),
        ("line", "line.yaml:1"),
        ("line.tracks[1].to_km", "line.yaml:3"),  # an id wins over an index
        ("line.tracks[0]", "line.yaml:3"),
        ("line.stations[a.b].km", "line.yaml:7"),
        ("line.stations[0].stop_km[1 increasing]", "line.yaml:7"),
        ("line.gradients[1].to_km", "g.csv:3"),
        ("line.gradients[9].to_km", "g.csv"),
        ("line.speed_limits[3]", "line.yaml:1"),
        ("supply.substations[A].km", "supply.yaml:3"),
        ("supply.substations[0].km", "supply.yaml:3"),
        ("limits[dc3000 u_max2].value", "l.csv:2"),
        ("", "study.yaml:1"),
        ("nonsense[", "study.yaml:1"),
    ],
)
def test_paths_are_located(provenance, path, place):
    assert provenance.locate(path) == place


def test_places_are_filled_in_where_they_are_missing(provenance):
    given = [Problem("gap", "line.gradients[1]", "a gap"), Problem("gap", "line", "a gap", place="x.yaml:1")]
    assert [problem.place for problem in provenance.place(given)] == ["g.csv:3", "x.yaml:1"]


def test_a_trailing_underscore_of_python_names_is_understood():
    root = Mark("a.yaml", children={"from": Mark("a.yaml", 4)})
    assert Provenance(root).locate("from_") == "a.yaml:4"


def test_paths_are_split_and_made_alike():
    data = {"rows": [{"id": "x.y", "km": 1}, 5], "free": {"1 increasing": 2}}
    path = path_of("line", ("rows", 0, "km"), data)
    assert path == "line.rows[x.y].km"
    assert split_path(path) == ["line", "rows", "x.y", "km"]
    twice = {"vehicles": [{"id": "ep09"}, {"id": "coach"}, {"id": "ep09"}]}
    assert [path_of("", ("vehicles", k), twice) for k in range(3)] == ["vehicles[0]", "vehicles[coach]", "vehicles[2]"]
    assert path_of("line", ("rows", 1), data) == "line.rows[1]"
    assert path_of("", ("free", "1 increasing"), data) == "free[1 increasing]"
    assert list_mark(Mark("a"), data["rows"]).ids == {"x.y": 0}
