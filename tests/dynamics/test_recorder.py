"""The recorder: rows in any pieces give the same tables; what is missing is said."""

import sys

import pytest
from fake_dynamics import fake_bins, record_fake

from tractionpower.results.store import MemoryWriter

RUNS = [(), (300, 700), (1, 2, 3, 600), (1200,)]


@pytest.fixture(scope="module")
def whole():
    writer = MemoryWriter()
    recorder, state = record_fake(writer, ())
    return writer.tables(), recorder.key_figures(state), recorder.summary(state)


@pytest.mark.parametrize("cuts", RUNS[1:])
def test_tables_do_not_depend_on_how_rows_come(whole, cuts):
    writer = MemoryWriter()
    recorder, state = record_fake(writer, cuts)
    tables, figures, summary = whole
    made = writer.tables()
    assert set(made) == set(tables)
    for name, table in made.items():
        assert table.to_pylist() == tables[name].to_pylist(), name
    assert recorder.key_figures(state) == figures
    assert recorder.summary(state) == summary


def test_closing_twice_writes_once():
    writer = MemoryWriter()
    recorder, state = record_fake(writer)
    rows = writer.tables()["coupling_extremes"].num_rows
    recorder.close(state, fake_bins())
    assert writer.tables()["coupling_extremes"].num_rows == rows == 5


def test_without_rainflow_all_else_is_there(monkeypatch):
    monkeypatch.setitem(sys.modules, "rainflow", None)
    writer = MemoryWriter()
    recorder, state = record_fake(writer)
    tables = writer.tables()
    assert "rainflow" not in tables
    assert tables["coupling_extremes"]["damage"].null_count == 5
    (note,) = recorder.summary(state)["notes"]
    assert "pip install tractionpower[dynamics]" in note


def test_the_greatest_damage_is_one(whole):
    damage = whole[0]["coupling_extremes"]["damage"].to_pylist()
    assert max(damage) == 1.0
    assert damage == sorted(damage, reverse=True)  # pulled at its head, the train swings most there
