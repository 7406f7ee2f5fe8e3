"""Measured files as loggers write them: decimal signs, times, units below headings; what is wrong is told with its line."""

import numpy as np
import pytest
from measured_files import MAP, START, write_pair

from tractionpower.errors import InputError
from tractionpower.io.measured_files import read_map
from tractionpower.studies.measured.reading import read_measurement


def read(tmp_path, rows, text=MAP):
    file, map_file = write_pair(tmp_path, rows, text)
    return read_measurement(file, read_map(map_file), {"substations"})


def refused(tmp_path, rows, text=MAP):
    with pytest.raises(InputError) as caught:
        read(tmp_path, rows, text)
    return caught.value.problems


def rows(*lines, separator=";"):
    return "\n".join(separator.join(line) for line in lines) + "\n"


SIX = [f"{t}" for t in range(21600, 21606)]


def table(voltages, separator=";", times=SIX, currents=None):
    currents = currents or ["100"] * len(voltages)
    return rows(("t", "U", "I"), *zip(times, voltages, currents, strict=False), separator=separator)


@pytest.mark.parametrize(
    ("cells", "separator", "values"),
    [
        (["3312.5", "3300"], ",", [3312.5, 3300.0]),
        (["3312,5", "3300,25"], ";", [3312.5, 3300.25]),
        (['"3312,5"', '"3300,25"'], ",", [3312.5, 3300.25]),
        (["3.312,5", "3.300,25"], ";", [3312.5, 3300.25]),
        (["3,312.5", "3,300.25"], ";", [3312.5, 3300.25]),
        (["3 312,5", "3\u00a0300,25"], ";", [3312.5, 3300.25]),
        (["3312.5", "\u22123e2"], "\t", [3312.5, -300.0]),
    ],
)
def test_ways_of_writing_numbers(tmp_path, cells, separator, values):
    assert read(tmp_path, table(cells, separator)).series[0].values.tolist() == values


def test_a_sign_that_separates_thousands_everywhere_is_told(tmp_path):
    found = read(tmp_path, table(["3,312", "3,300", "3,290"], currents=["10.5", "20.25", "30.5"]))
    assert found.series[0].values.tolist() == [3312.0, 3300.0, 3290.0]
    assert [(p.code, p.place, p.severity) for p in found.problems] == [("thousands_sign", "m.csv:2", "warning")]


def test_two_decimal_signs_are_refused_with_both_lines(tmp_path):
    (problem,) = refused(tmp_path, table(["3312.5", "3300,5", "3290.5"]))
    assert (problem.code, problem.place) == ("mixed_decimals", "m.csv:2")
    assert "'3312.5' in line 2, '3300,5' in line 3" in problem.found


def test_the_wrong_decimal_sign_of_the_map_is_named(tmp_path):
    problems = refused(tmp_path, table(["3312.55", "3300.55", "3290.55"]), MAP + "decimal: comma\n")
    assert problems[0].code == "no_number"
    assert problems[0].place == "m.csv:2"
    assert problems[0].path == "series[0].column"
    assert "say decimal: point" in problems[0].remedy


def test_decimal_commas_between_commas(tmp_path):
    (problem,) = refused(tmp_path, "t,U,I\n21600,3312,5,10,5\n21601,3300,5,11,5\n")
    assert problem.code == "ragged_row"
    assert "decimal commas in a file whose cells are separated by commas" in problem.remedy


def test_words_in_single_cells_are_left_out_and_in_many_refused(tmp_path):
    cells = ["3300"] * 30
    times = [str(21600 + k) for k in range(30)]
    cells[4], cells[7], cells[9] = "ERR", "", "nan"
    found = read(tmp_path, table(cells, times=times))
    assert len(found.series[0].values) == 27
    assert [(p.code, p.place, p.severity) for p in found.problems] == [("no_number", "m.csv:6", "warning")]
    (problem,) = refused(tmp_path, table(["ERR"] * 3 + ["3300"] * 3))
    assert problem.severity == "error"
    assert "3 cells of 6 in column 'U' no number, the first 'ERR'" in problem.found


def test_headings_below_other_lines_and_units_below_headings(tmp_path):
    text = "Recorder; 17\n\nt ;U;x;I\ns;V;-;A\n21600;3300;9;100\n\n21601;3310;9;110\n"
    found = read(tmp_path, text)
    assert found.series[1].values.tolist() == [100.0, 110.0]
    assert found.series[1].time_s.tolist() == [START, START + 1.0]


def test_headings_that_are_missing_or_doubled_are_told_at_once(tmp_path):
    problems = refused(tmp_path, "t;U [V];I;I\n1;2;3;4\n")
    assert [p.code for p in problems] == ["missing_column", "duplicate_column"]
    assert problems[0].place == "m.csv:1"
    (problem,) = refused(tmp_path, "time;U;I\n1;2;3\n")
    assert "no column 't'" in problem.found


@pytest.mark.parametrize(("text", "code"), [("", "empty_file"), ("t;U;I\n", "no_rows"), ("PK\x03\x04abc", "not_text")])
def test_files_that_are_none(tmp_path, text, code):
    assert refused(tmp_path, text)[0].code == code


def test_a_missing_file_and_another_encoding(tmp_path):
    _, map_file = write_pair(tmp_path, "")
    with pytest.raises(InputError, match=r"no file none\.csv"):
        read_measurement(tmp_path / "none.csv", read_map(map_file), set())
    (tmp_path / "m.csv").write_bytes("t;U;I;°C\n1;2;3;4\n2;2;3;4\n".encode("cp1252"))
    with pytest.raises(InputError, match="not UTF-8"):
        read_measurement(tmp_path / "m.csv", read_map(map_file), set())
    map_file.write_text(MAP + "encoding: cp1252\n", encoding="utf-8")
    assert len(read_measurement(tmp_path / "m.csv", read_map(map_file), set()).series) == 2


@pytest.mark.parametrize(
    ("times", "more", "first"),
    [
        (["21600.5", "21601"], "", 21600.5),
        (["0", "1"], ', start: "06:00"', 21600.0),
        (["06:00:00,5", "06:00:01,5"], "", 21600.5),
        (["6:00", "6:01"], "", 21600.0),
        (["2026-03-17 06:00:00.5", "2026-03-17 06:00:01"], "", 21600.5),
        (["2026-03-17T05:00:00Z", "2026-03-17T05:00:01Z"], ", utc_offset_h: 1", 21600.0),
        (["2026-03-17T06:00:00+01:00", "2026-03-17T06:00:01+01:00"], "", 21600.0),
        (["2026-03-17T05:00:00", "2026-03-17T05:00:01"], ", utc_offset_h: 1", 21600.0),
        (["2026-03-18 00:30:00", "2026-03-18 00:30:01"], ', date: "2026-03-17"', 88200.0),
        (["17.03.2026 06:00:00", "17.03.2026 06:00:01"], ', format: "%d.%m.%Y %H:%M:%S"', 21600.0),
        (["06h00m00", "06h00m01"], ', format: "%Hh%Mm%S"', 21600.0),
        (["46098.25", "46098.250011574"], ", format: excel", 21600.0),
        (["1773727200", "1773727201"], ", format: unix", 21600.0),
    ],
)
def test_ways_of_writing_times(tmp_path, times, more, first):
    text = MAP.replace("{column: t}", f"{{column: t{more}}}")
    found = read(tmp_path, table(["3300", "3310"], times=times), text)
    assert found.series[0].time_s[0] == pytest.approx(first, abs=1e-3)
    assert 0.4 < np.diff(found.series[0].time_s)[0] < 61.0


def test_times_go_on_after_midnight(tmp_path):
    found = read(tmp_path, table(["1", "2", "3"], times=["23:59:59", "00:00:00", "00:00:01"]))
    assert found.series[0].time_s.tolist() == [86399.0, 86400.0, 86401.0]


def test_a_wrong_time_moves_nothing_but_itself(tmp_path):
    times = [f"06:00:{k:02d}" for k in range(20)]
    times[7] = "96:00:07"
    found = read(tmp_path, table(["3300"] * 20, times=times))
    assert found.series[0].time_s[:-1].tolist() == [21600.0 + k for k in range(20) if k != 7]
    assert [p.code for p in found.problems] == ["unsorted_times", "gap"]


def test_times_in_utc_are_told(tmp_path):
    found = read(tmp_path, table(["1", "2"], times=["2026-03-17T05:00:00Z", "2026-03-17T05:00:01Z"]))
    assert found.problems[0].code == "utc"


@pytest.mark.parametrize(
    ("times", "words"),
    [
        (["17.03.2026 06:00", "17.03.2026 06:01"], "times such as '17.03.2026 06:00'"),
        (["45733.25", "45733.250012", "45733.250023"], "look like days of a spreadsheet"),
        (["1742191200", "1742191201"], "look like seconds since 1970"),
        (["21600", "x", "y"], "times such as '21600'"),
        (["", ""], "no times"),
    ],
)
def test_times_that_cannot_be_read(tmp_path, times, words):
    (problem,) = refused(tmp_path, table(["1", "2", "3"][: len(times)], times=times))
    assert words in problem.found
    assert problem.place == "m.csv:2"


def test_order_and_gaps_are_told_once(tmp_path):
    times = [*range(0, 30), 29, 28, *range(90, 120)]
    found = read(tmp_path, table(["3300"] * 62, times=[str(t) for t in times]))
    told = {p.code: p for p in found.problems}
    assert set(told) == {"unsorted_times", "duplicate_times", "gap"}
    assert "1 time earlier" in told["unsorted_times"].found
    assert told["unsorted_times"].place == "m.csv:33"
    assert "2 rows with a time that another row has" in told["duplicate_times"].found
    assert "1 gap in U, I: 51.3 % of the time, the longest 61.0 s from 00:00:29" in told["gap"].found
    assert all(p.severity == "warning" for p in found.problems)


def test_power_is_made_of_voltage_and_current_row_by_row(tmp_path):
    found = read(tmp_path, table(["3000", "3100", "", "3200"], currents=["1000", "-500", "700", "2000"]))
    power = found.series[2]
    assert power.series.id == "substation A power_kw"
    assert power.values.tolist() == [3000.0, -1550.0, 6400.0]


def test_units_signs_and_offsets(tmp_path):
    text = MAP.replace("quantity: voltage_v", "quantity: voltage_v, unit: kV, offset: 5").replace(
        "current_a", "current_a, unit: kA, sign: -1"
    )
    found = read(tmp_path, table(["3.3", "3.2"], currents=["1.5", "-0.5"]), text)
    assert found.series[0].values.tolist() == pytest.approx([3305.0, 3205.0])
    assert found.series[1].values.tolist() == pytest.approx([-1500.0, 500.0])


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("substation A, quantity: voltage_v", "pantograph 2, quantity: voltage_v"), "train, substation"),
        (("voltage_v}", "voltage_v, unit: A}"), "V, kV"),
        (("quantity: voltage_v", "quantity: phase"), "has V, A, kW"),
        (("quantity: current_a", "quantity: voltage_v"), "two columns are"),
        (("column: t}", "column: t, format: fast}"), "a pattern with %"),
        (("column: t}", "column: t, date: 17.3.2026}"), "YYYY-MM-DD"),
        (("format: 1", "format: 1\non: X"), "none of the columns"),
        (("format: 1", "format: 1\nalign: distance"), "for trains"),
        (("format: 1", "format: 1\nshift_s: perhaps"), "perhaps"),
        (("format: 1", "format: 1\ngap: 3"), "did you mean gap_s"),
    ],
)
def test_maps_with_faults_are_told_with_their_lines(tmp_path, change, words):
    _, map_file = write_pair(tmp_path, "", MAP.replace(*change))
    with pytest.raises(InputError) as caught:
        read_map(map_file)
    assert words in str(caught.value)
    assert all(problem.place.startswith("map.yaml:") for problem in caught.value.problems), caught.value.problems
