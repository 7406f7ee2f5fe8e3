import pytest

TRACKS = 'format: 1\ntracks:\n  - {id: "1", from_km: 0.0, to_km: 20.0}\n'
SUBSTATION = "  - {id: A, km: 0.0, no_load_voltage_v: 3600, internal_resistance_ohm: 0.12"
PIECE = "from_km: 0, to_km: 9, resistance_ohm_per_km: 0.05"
REST = f"contact_lines: [{{{PIECE}}}]\nreturn_circuit: [{{{PIECE}}}]\n"


@pytest.mark.parametrize(
    ("added", "code", "path", "found", "told"),
    [
        ("gradiants: []", "unknown_key", "line.gradiants", "'gradiants'", "did you mean gradients?"),
        ("curves: [{from_km: 1, to_km: 2}]", "missing_key", "line.curves[0].radius_m", "radius_m", "[m]"),
        ("stations: [{id: B, km: x}]", "wrong_type", "line.stations[B].km", "'x'", "a number [km]"),
        ("stations: [{id: B, km: '0,5'}]", "wrong_type", "line.stations[B].km", "'0,5'", "point"),
        ("stations: [{id: B, km: true}]", "wrong_type", "line.stations[B].km", "true", "a number [km]"),
        ("stations: [{id: B, km: 1, name: 12}]", "wrong_type", "line.stations[B].name", "12", "quotes"),
        ("stations: [5]", "wrong_type", "line.stations[0]", "5", "mapping"),
        ("stations:", "wrong_type", "line.stations", "nothing", "[] for none"),
        ("stations: {id: B}", "wrong_type", "line.stations", "mapping", "a list"),
        ("curves: [{from_km: 1, to_km: 2, radius_m: 5}]", "out_of_bounds", "line.curves[0].radius_m", "5", "[m] above 55"),
        ("gradients: [{from_km: 1, to_km: 2, permille: 101}]", "out_of_bounds", "line.gradients[0].permille", "101", "most 100"),
        ("stations: [{id: B, km: .nan}]", "not_finite", "line.stations[B].km", "nan", "finite"),
        ("stations: [{id: B, km: -.inf}]", "not_finite", "line.stations[B].km", "-inf", "finite"),
        ("stations: [{id: B, km: 1e999}]", "not_finite", "line.stations[B].km", "inf", "finite"),
        ("stations: [{id: 'a]', km: 1}]", "bad_identifier", "line.stations[0].id", "'a]'", "no brackets"),
        ("tunnels: [{from_km: 1, to_km: 2, kind: single}]", "bad_choice", "line.tunnels[0].kind", "'single'", "single_track |"),
        ("curves: [{from_km: 3, to_km: 2, radius_m: 500}]", "stretch", "line.curves[0]", "3.0 is not below to_km 2.0", ""),
        ("curves: list.txt", "wrong_type", "line.curves", "'list.txt'", ".csv"),
        ("curves: none.csv", "missing_file", "line.curves", "none.csv", "add the file"),
    ],
)  # fmt: skip
def test_problems_of_the_line(only_problem, added, code, path, found, told):
    problem = only_problem({"line.yaml": f"source: here\n{added}\n"})
    assert (problem.code, problem.path, problem.place) == (code, path, "line.yaml:6")
    assert found in problem.found
    assert told in f"{problem.allowed}; {problem.remedy}"


@pytest.mark.parametrize(
    ("clock", "path", "found"),
    [
        ("{start: 00:00, end: 24:60}", "clock.end", "'24:60'"),
        ("{start: 7.30, end: 10:00}", "clock.start", "'7.3'"),  # as seconds it would pass unnoticed
        ("{start: 730, end: 10:00}", "clock.start", "730"),
        ("{start: noon, end: 10:00}", "clock.start", "'noon'"),
    ],
)
def test_bad_times(only_problem, clock, path, found):
    problem = only_problem(study_yaml=f"format: 1\nclock: {clock}\n")
    assert (problem.code, problem.path, problem.place, problem.found) == ("bad_time", path, "study.yaml:2", found)
    assert "HH:MM" in problem.allowed


def test_start_after_end(only_problem):
    problem = only_problem(study_yaml="format: 1\nclock: {start: 02:00, end: 01:00}\n")
    assert (problem.code, problem.path, problem.place) == ("clock", "clock", "study.yaml:2")


def test_a_bound_is_told_with_its_unit(only_problem):
    problem = only_problem(supply_yaml=f"substations:\n{SUBSTATION}, grid_voltage_pu: 9}}\n{REST}")
    assert (problem.code, problem.place) == ("out_of_bounds", "supply.yaml:2")
    assert problem.path == "supply.substations[A].grid_voltage_pu"
    assert problem.allowed == "a number [p.u.] at least 0.5 and at most 1.5"


@pytest.mark.parametrize("what", ["{id: L, track: 1, km: 1}", "{id: L, track: 1, km: 1, power_kw: 1, current_a: 1}"])
def test_the_rules_of_the_declarations_are_told(only_problem, what):
    problem = only_problem({"supply.yaml": f"loads:\n  - {what}\n"})
    assert (problem.code, problem.path, problem.place) == ("power_or_current", "supply.loads[L]", "supply.yaml:9")


def test_an_empty_list_where_one_row_is_needed(only_problem):
    problem = only_problem(line_yaml="format: 1\ntracks: []\n")
    assert (problem.code, problem.path, problem.place) == ("empty_list", "line.tracks", "line.yaml:2")


@pytest.mark.parametrize(
    ("row", "code", "path", "found"),
    [
        ("1,2,=A1,", "wrong_type", "line.gradients[1].permille", "'=A1' in column permille"),
        ("1,2,much,", "wrong_type", "line.gradients[1].permille", "'much' in column permille"),
        ("1,2,nan,", "not_finite", "line.gradients[1].permille", "nan in column permille"),
        ("1,2,500,", "out_of_bounds", "line.gradients[1].permille", "500.0 in column permille"),
        ("1,,5,", "missing_key", "line.gradients[1].to_km", "nothing in column to_km"),
        ("2,1,5,", "stretch", "line.gradients[1]", "from_km 2.0 is not below to_km 1.0"),
        ("1,2,5", "ragged_row", "line.gradients", "3 cells in the row"),
    ],
)
def test_problems_of_csv_cells(only_problem, row, code, path, found):
    table = f"from_km,to_km,permille,tracks\n0,1,2,1\n{row}\n"
    problem = only_problem({"line.yaml": "gradients: gradients.csv\n"}, gradients_csv=table)
    assert (problem.code, problem.path, problem.found) == (code, path, found)
    assert problem.place == "gradients.csv:3"


@pytest.mark.parametrize("number", ["2", "17", "1.5"])
def test_a_newer_format_is_one_clear_message(only_problem, number):
    problem = only_problem(line_yaml=f"format: {number}\nnew_things: 3\n")
    assert (problem.code, problem.path, problem.place) == ("newer_format", "line.format", "line.yaml:1")
    assert problem.found == f"format {number}"
    assert "format 1" in problem.allowed
    assert "newer tractionpower" in problem.remedy


@pytest.mark.parametrize("number", ["0", "one", "null"])
def test_a_format_that_never_was(only_problem, number):
    problem = only_problem(line_yaml=TRACKS.replace("format: 1", f"format: {number}"))
    assert (problem.code, problem.path, problem.allowed) == ("bad_choice", "line.format", "1")


def test_found_values_are_shortened_and_escaped(problems_of_study):
    long = "x" * 5000
    problems = problems_of_study({"line.yaml": f'stations: [{{id: B, km: {long}}}]\n"a\\e[31m": 1\n'})
    assert len(problems[0].found) < 80
    assert problems[1].found == "the key 'a\\x1b[31m'"
    assert all(str(problem).isprintable() for problem in problems)


def test_a_misspelt_key_is_told_once(only_problem):
    problem = only_problem({"line.yaml": "curves: [{from_km: 1, to_km: 2, radius: 400}]\n"})
    assert (problem.code, problem.path) == ("unknown_key", "line.curves[0].radius")
    assert "did you mean radius_m?" in problem.remedy
