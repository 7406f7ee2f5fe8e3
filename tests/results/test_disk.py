"""Files that are whole or not there."""

import errno

import pytest

from tractionpower.errors import OutputError
from tractionpower.results.disk import failures_told, reason_of, write_or_beside, write_whole


def write_half(path):
    path.write_bytes(b"half")
    raise OSError(errno.ENOSPC, "No space left on device")


@pytest.mark.parametrize("write", [write_whole, write_or_beside])
def test_a_file_is_whole_or_as_it_was(tmp_path, write):
    file = tmp_path / "file.txt"
    assert write(file, lambda path: path.write_bytes(b"whole")) == file
    with pytest.raises(OSError, match="No space left"):
        write(file, write_half)
    assert [(path.name, path.read_bytes()) for path in tmp_path.iterdir()] == [("file.txt", b"whole")]


def test_what_is_held_open_gets_its_successor_beside(tmp_path, hold_open):
    file = tmp_path / "file.txt"
    file.write_bytes(b"old")
    hold_open(file)
    assert write_or_beside(file, lambda path: path.write_bytes(b"new")) == tmp_path / "file.new.txt"
    assert file.read_bytes() == b"old"
    assert (tmp_path / "file.new.txt").read_bytes() == b"new"
    with pytest.raises(PermissionError):
        write_whole(file, lambda path: path.write_bytes(b"new"))
    assert not list(tmp_path.glob("*.tmp"))


@pytest.mark.parametrize(
    ("number", "words"),
    [
        (errno.ENOSPC, "the disk is full"),
        (errno.EROFS, "no permission to write"),
        (errno.EACCES, "choose another folder"),
        (errno.EISDIR, "directory"),
    ],
)
def test_what_hinders_is_told_in_words(tmp_path, number, words):
    assert words in reason_of(OSError(number, "x"))
    with (
        pytest.raises(OutputError, match=f"tables cannot be written into .*{words}.*Nothing is lost"),
        failures_told(tmp_path, "Nothing is lost", "tables"),
    ):
        raise OSError(number, "x")


def test_an_error_without_a_number_keeps_its_words():
    assert reason_of(OSError("something else")) == "something else"
