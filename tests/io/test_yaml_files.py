from pathlib import Path

import pytest

from tractionpower.errors import InputError
from tractionpower.io.text_files import Source
from tractionpower.io.yaml_files import plain_value, read_yaml


def source(tmp_path: Path, text: str | bytes) -> Source:
    file = tmp_path / "line.yaml"
    file.write_bytes(text.encode() if isinstance(text, str) else text)
    return Source(file, "line.yaml", "line", "study.yaml:3")


def failure(given: Source):
    with pytest.raises(InputError) as caught:
        read_yaml(given)
    (problem,) = caught.value.problems
    return problem


def bomb() -> str:
    levels = "\n".join(f"l{n}: &l{n} [{', '.join([f'*l{n - 1}'] * 10)}]" for n in range(1, 9))
    return f"l0: &l0 [lol]\n{levels}\n"


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12:30", "12:30"), ("n", "n"), ("on", "on"), ("yes", "yes"), ("2020-01-01", "2020-01-01"), ("010", "010"),
        ("1", 1), ("-1.5", -1.5), ("1e3", 1000.0), ("0o17", 15), ("0x1F", 31), ("true", True), ("FALSE", False), ("tRUE", "tRUE"),
        ("null", None), ("~", None), ("", None), ("1_000", "1_000"), (".inf", float("inf")), ("9" * 5000, float("inf")),
    ],
)  # fmt: skip
def test_plain_scalars_follow_yaml_1_2(text, value):
    assert plain_value(text) == value
    assert type(plain_value(text)) is type(value)


def test_lines_of_keys_and_items(tmp_path):
    document = read_yaml(source(tmp_path, "# head\nformat: 1\ntracks:\n  - {id: A,\n     km: 1}\n  - id: B\n    km: 2\n"))
    assert document.data["tracks"] == [{"id": "A", "km": 1}, {"id": "B", "km": 2}]
    assert document.mark.find(("tracks",)).line == 3
    assert document.mark.find(("tracks", "A", "km")).line == 5
    assert document.mark.find(("tracks", 1, "km")).line == 7


def test_the_version_directive_of_yaml_1_1_changes_nothing(tmp_path):
    assert read_yaml(source(tmp_path, "%YAML 1.1\n---\na: n\nb: 12:30\n")).data == {"a": "n", "b": "12:30"}


@pytest.mark.parametrize("text", ["\ufeffa: 1\n", "a: 1\r\n", "a: &x 1\nb: &x 2\n"])
def test_mark_order_line_ends_and_reused_anchors_are_read(tmp_path, text):
    assert read_yaml(source(tmp_path, text)).data["a"] == 1


def test_quoted_and_tagged_texts_stay_text(tmp_path):
    assert read_yaml(source(tmp_path, "a: '12'\nb: !!str 12\n")).data == {"a": "12", "b": "12"}


def test_small_aliases_are_expanded(tmp_path):
    assert read_yaml(source(tmp_path, "a: &x {km: 1}\nb: [*x, *x]\n")).data["b"] == [{"km": 1}, {"km": 1}]


@pytest.mark.parametrize(
    ("text", "code", "place", "found"),
    [
        ("", "empty_file", "line.yaml", "empty"),
        ("# nothing\n", "empty_file", "line.yaml", "empty"),
        ("a: 1\nb:\n\tc: 2\n", "tab", "line.yaml:3", "tab"),
        ("a: 1\nb: [1, 2\nc: 3\n", "syntax_error", "line.yaml:3", "no YAML"),
        ("a: 'b\n", "syntax_error", "line.yaml:2", "no YAML"),
        ("a: 1\n---\nb: 2\n", "syntax_error", "line.yaml:2", "another document"),
        ("a: *nobody\n", "syntax_error", "line.yaml:1", "nobody"),
        ("a: 1\nb: \x00\n", "syntax_error", "line.yaml:2", "\\x00"),
        ("hello\n", "not_a_mapping", "line.yaml:1", "'hello'"),
        ("\n- 1\n- 2\n", "not_a_mapping", "line.yaml:2", "list"),
        (b"a: 1\nb: \xe9\n", "not_utf8", "line.yaml:2", "0xe9"),
        ("a: 1\n".encode("utf-16"), "not_utf8", "line.yaml:1", "UTF-8"),
        ("[" * 3000, "too_deep", "line.yaml", "deep"),
        ("a: " + "[" * 60 + "]" * 60, "too_deep", "line.yaml:1", "deep"),
        (bomb(), "alias", "line.yaml:2", "100000"),
    ],
)
def test_files_that_cannot_be_read(tmp_path, text, code, place, found):
    problem = failure(source(tmp_path, text))
    assert (problem.code, problem.place, problem.path) == (code, place, "line")
    assert found in problem.found


def test_a_missing_file_blames_the_place_that_names_it(tmp_path):
    problem = failure(Source(tmp_path / "none.yaml", "none.yaml", "line", "study.yaml:3"))
    assert (problem.code, problem.place) == ("missing_file", "study.yaml:3")
    assert "none.yaml" in problem.found


def test_a_folder_is_no_file(tmp_path):
    assert failure(Source(tmp_path, "line.yaml", "line")).code == "not_a_file"


def test_a_name_that_no_system_can_open(tmp_path):
    assert failure(Source(tmp_path / "a\0b", "a", "line")).code == "unreadable_file"


def test_an_unreadable_file(tmp_path, monkeypatch):
    given = source(tmp_path, "a: 1\n")
    monkeypatch.setattr(Path, "read_bytes", lambda _: (_ for _ in ()).throw(PermissionError(13, "Permission denied")))
    problem = failure(given)
    assert (problem.code, problem.place) == ("unreadable_file", "line.yaml")
    assert "Permission denied" in problem.found


def test_a_large_file_is_refused_with_its_size(tmp_path):
    given = source(tmp_path, "")
    with given.file.open("wb") as stream:
        stream.truncate(21_000_000)
    problem = failure(given)
    assert (problem.code, problem.found, problem.allowed) == ("file_too_large", "the file has 21.0 MB", "at most 20 MB")


def test_duplicate_keys_are_told_each_with_its_line(tmp_path):
    problems = read_yaml(source(tmp_path, "a: 1\nb:\n  - {id: X, c: 1, c: 2}\na: 3\na: 4\n")).problems
    assert [(problem.code, problem.path, problem.place) for problem in problems] == [
        ("duplicate_key", "line.b[X].c", "line.yaml:3"),
        ("duplicate_key", "line.a", "line.yaml:4"),
        ("duplicate_key", "line.a", "line.yaml:5"),
    ]
    assert "first in line 1" in problems[1].found


def test_keys_that_are_lists_and_unknown_tags_are_problems(tmp_path):
    problems = read_yaml(source(tmp_path, "a: !python/object:os.system x\n? [b, c]\n: 1\n")).problems
    assert [(problem.code, problem.place) for problem in problems] == [("unknown_tag", "line.yaml:1"), ("bad_key", "line.yaml:2")]
