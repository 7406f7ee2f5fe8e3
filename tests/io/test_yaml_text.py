import pytest

from tractionpower.io.text_files import Source
from tractionpower.io.yaml_files import read_yaml
from tractionpower.io.yaml_text import document

VALUES = [
    "no", "y", "on", "12:30", "1", "1e3", "0x1", "~", "", " a", "a ", "a: b", "a #b", "- a", "a\nb\tc\r", "'", '"', "\\", "{",
    "[x]", "*x", "&x", "!x", "%x", "@x", "`", "=", "<<", "null", "True", ".inf", "2020-01-01", "\ufeff", "Section cabin",
    "é\u2028\x85\x7f\x00\ud7ff\U0001f600",
]  # fmt: skip


@pytest.mark.parametrize("value", [*VALUES, 1, -1.5, 1e-7, 1e300, -0.0, True, None, [], {}, [[1, 2], ["a"]]])
def test_written_values_are_read_again(tmp_path, value):
    data = {"key": value, "rows": [{"id": "A", "value": value}, {}]}
    file = tmp_path / "a.yaml"
    file.write_text(document(data), encoding="utf-8", newline="\n")
    read = read_yaml(Source(file, "a.yaml", ""))
    assert read.data == data
    assert read.problems == []


@pytest.mark.parametrize("key", ["a b", "1 increasing", "no", "a: b"])
def test_written_keys_are_read_again(tmp_path, key):
    file = tmp_path / "a.yaml"
    file.write_text(document({"free": {key: 1}}), encoding="utf-8")
    assert read_yaml(Source(file, "a.yaml", "")).data == {"free": {key: 1}}
