"""Results in hand."""

import json

import pandas as pd
import pytest

from tractionpower.errors import UsageError
from tractionpower.results.results import Results


def test_tables_and_figures_of_a_folder(folder, write_run, rows):
    write_run()
    results = Results.open(str(folder))
    assert results.tables == ["loads"]
    pd.testing.assert_frame_equal(results.table("loads"), rows(0, 10).to_pandas())
    assert results.run["status"] == "complete"
    assert results.key_figure("lowest_voltage_v") == 3000.0
    assert results.key_figure("energy_kwh", "substation B") == 2.0


def test_memory_and_disk_hold_the_same(folder, write_run, rows):
    write_run(cuts=(0, 3, 10))
    memory = Results({}, [], {"loads": rows(0, 10)})
    assert memory.tables == ["loads"]
    pd.testing.assert_frame_equal(memory.table("loads"), Results.open(folder).table("loads"))


@pytest.mark.parametrize(
    ("name", "place", "words"),
    [("energy_kwh", "", "2 key figures"), ("energy_kwh", "substation C", "0 key figures"), ("nothing", "", "energy_kwh, lowest")],
)
def test_a_key_figure_is_one(folder, write_run, name, place, words):
    write_run()
    with pytest.raises(UsageError, match=words):
        Results.open(folder).key_figure(name, place)


def test_a_table_that_is_not_there_is_told_with_those_that_are(folder, write_run):
    write_run()
    with pytest.raises(UsageError, match="no table 'trains'; this run has loads"):
        Results.open(folder).table("trains")


def test_a_folder_without_results(tmp_path):
    for folder in (tmp_path, tmp_path / "nowhere"):
        with pytest.raises(UsageError, match="no results of a run are there"):
            Results.open(folder)


@pytest.mark.parametrize("name", ["loads.parquet", "key_figures.json"])
@pytest.mark.parametrize("damage", ["cut", "changed", "gone"])
def test_a_damaged_file_is_noticed(folder, write_run, name, damage):
    write_run()
    file = folder / name
    data = file.read_bytes()
    if damage == "gone":
        file.unlink()
    else:
        file.write_bytes(data[:-1] if damage == "cut" else data[:-1] + bytes([data[-1] ^ 1]))
    with pytest.raises(UsageError, match=f"{name}: not the file that the run wrote"):
        Results.open(folder)


@pytest.mark.parametrize("text", ["{", "", "[]", '{"status": "interrupted"}', json.dumps({"files": 3})])
def test_a_run_json_that_is_none(folder, write_run, text):
    write_run()
    (folder / "run.json").write_text(text, encoding="utf-8")
    with pytest.raises(UsageError, match="not what a complete run writes"):
        Results.open(folder)


def test_results_tell_in_a_line_what_they_are(folder, write_run, rows):
    write_run()
    told = Results.open(folder)
    count = len(told.table("loads"))
    assert repr(told) == f"<Results of study {told.run['study']!r}, complete; tables: loads ({count} rows)>"
    assert repr(Results({}, [], {"loads": rows(0, 10)})) == f"<Results of study '', unknown; tables: loads ({count} rows)>"
    (folder / "loads.parquet").unlink()
    assert "loads (? rows)" in repr(told)
