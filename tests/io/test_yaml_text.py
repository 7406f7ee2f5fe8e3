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


def test_rows_that_hold_rows_are_written_key_by_key():
    rows = [{"id": "7", "calls": [{"station": "A"}, {"station": "B"}]}, {"id": "8", "calls": []}]
    assert document({"trains": rows}) == (
        'trains:\n  - id: "7"\n    calls:\n      - {station: A}\n      - {station: B}\n  - {id: "8", calls: []}\n'
    )
    assert document({"drive": {"kind": "table", "effort": [{"v": 1}]}, "brake": {"rate": 0.5}}) == (
        "drive:\n  kind: table\n  effort:\n    - {v: 1}\nbrake: {rate: 0.5}\n"
    )


def test_a_mapping_that_is_too_long_for_a_line():
    text = document({"drive": {f"key_{number}": 1.25 for number in range(20)}})
    assert text.count("\n") == 21
    assert text.startswith("drive:\n  key_0: 1.25\n")


@pytest.mark.parametrize("depth", [{"rows": [{"rows": [{"no": 1, "a: b": []}, {}]}, {}, 5]}, {"long": {"x" * 200: {"y": [{}]}}}])
def test_what_is_nested_is_read_again(tmp_path, depth):
    file = tmp_path / "a.yaml"
    file.write_text(document({"key": depth, "list": [depth, depth]}), encoding="utf-8")
    assert read_yaml(Source(file, "a.yaml", "")).data == {"key": depth, "list": [depth, depth]}


@pytest.mark.parametrize("key", ["a b", "1 increasing", "no", "a: b"])
def test_written_keys_are_read_again(tmp_path, key):
    file = tmp_path / "a.yaml"
    file.write_text(document({"free": {key: 1}}), encoding="utf-8")
    assert read_yaml(Source(file, "a.yaml", "")).data == {"free": {key: 1}}
