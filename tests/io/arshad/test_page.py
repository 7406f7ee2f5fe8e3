"""The page of the paper tells every key with its default, every column and every word."""

from pathlib import Path

import pytest

from tractionpower.io.arshad import commands, consist, track
from tractionpower.io.arshad.keys import KEYS

PAGE = (Path(__file__).parents[3] / "docs" / "dynamics-arshad.md").read_text(encoding="utf-8")
ROWS = {cells[1].strip(): cells[2] for cells in (line.split("|") for line in PAGE.splitlines()) if len(cells) == 5}


@pytest.mark.parametrize("key", KEYS, ids=lambda key: key.name)
def test_every_key_with_its_default(key):
    row = next((names for names in ROWS if key.spellings[0] in names.split(", ")), None)
    assert row is not None
    for spelling in key.spellings:
        assert spelling in row.split(", ") or spelling.lower() in row.lower()
    if key.default:
        assert key.default in ROWS[row]
    for choice in key.choices:
        assert choice in PAGE


def test_every_column():
    columns = [*consist.COLUMNS, *(value for value in vars(commands).values() if isinstance(value, consist.Column))]
    columns += [value for value in vars(track).values() if isinstance(value, consist.Column)]
    assert len(columns) > 20
    for column in columns:
        assert any(spelling in PAGE for spelling in column.spellings), column
