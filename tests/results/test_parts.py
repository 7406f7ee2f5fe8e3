"""Parts and the file that they become."""

import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from tractionpower.results.parts import count_rows, join_parts, read_groups, read_joined, write_part
from tractionpower.results.tables import make_table


@pytest.fixture
def parts(tmp_path, rows):
    """Return the files of three parts with 2, 6 and 12 rows of table ``loads``."""
    files = []
    for first, end in ((0, 1), (1, 4), (4, 10)):
        files.append(tmp_path / f"loads-{first:06d}.parquet")
        write_part(rows(first, end), files[-1])
    return files


@pytest.fixture
def joined(parts, tmp_path, monkeypatch):
    monkeypatch.setattr("tractionpower.results.parts.GROUP_ROWS", 8)
    join_parts("loads", parts, tmp_path / "loads.parquet")
    return tmp_path / "loads.parquet"


def test_every_number_comes_through_as_it_was(parts, joined, rows):
    whole = rows(0, 10)
    for files in (parts, [joined]):
        assert read_joined(files).to_pylist() == whole.to_pylist()
        assert [row for group in read_groups(files) for row in group.to_pylist()] == whole.to_pylist()
        assert count_rows(files) == 20
    assert read_joined([joined]).schema.field("voltage_v").type == pa.float32()


def test_a_joined_file_has_groups_of_one_size(joined):
    file = pq.ParquetFile(joined)
    assert [file.metadata.row_group(number).num_rows for number in range(file.num_row_groups)] == [8, 8, 4]
    assert [group.num_rows for group in read_groups([joined])] == [8, 8, 4]


def test_only_names_are_kept_in_dictionaries(joined):
    group = pq.ParquetFile(joined).metadata.row_group(0)
    kept = {}
    for number in range(group.num_columns):
        column = group.column(number)
        kept[column.path_in_schema] = column.has_dictionary_page
        assert column.compression == "ZSTD"
    assert kept == {"time_s": False, "load": True, "voltage_v": False, "current_a": False, "power_kw": False}


def test_parts_that_know_different_names(tmp_path):
    def events(*kinds):
        empty = {name: np.zeros(len(kinds)) for name in ("time_s", "position_km", "value", "limit")}
        words = {name: ([0] * len(kinds), ["x"]) for name in ("subject", "track", "message")}
        known = sorted(set(kinds))
        return make_table("events", empty | words | {"kind": ([known.index(kind) for kind in kinds], known)})

    files = [tmp_path / "a.parquet", tmp_path / "b.parquet"]
    write_part(events("stop", "departure"), files[0])
    write_part(events("tripped", "stop"), files[1])
    join_parts("events", files, tmp_path / "events.parquet")
    for read in ([tmp_path / "events.parquet"], files):
        assert read_joined(read).to_pandas()["kind"].tolist() == ["stop", "departure", "tripped", "stop"]


def test_a_table_without_rows(tmp_path, rows):
    write_part(rows(0, 0), tmp_path / "loads-000001.parquet")
    join_parts("loads", [tmp_path / "loads-000001.parquet"], tmp_path / "loads.parquet")
    assert read_joined([tmp_path / "loads.parquet"]).num_rows == 0
    assert sum(group.num_rows for group in read_groups([tmp_path / "loads.parquet"])) == 0
