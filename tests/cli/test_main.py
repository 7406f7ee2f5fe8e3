import os
import subprocess
import sys
from pathlib import Path

import pytest
from train_study import write_train_study

from tractionpower.cli import check, main
from tractionpower.errors import OutputError

SOURCES = str(Path(__file__).parents[2] / "src")


def run(*arguments: str, **options) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "PYTHONPATH": SOURCES}
    return subprocess.run(
        [sys.executable, "-m", "tractionpower", *arguments],
        capture_output=True,
        text=True,
        env=environment,
        check=False,
        **options,
    )


def test_help_needs_no_heavy_modules():
    code = "import sys; from tractionpower.cli import main; main(['--help']); print([m for m in sys.modules], file=sys.stderr)"
    result = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": SOURCES}, check=True
    )
    for name in ("check", "schema", "new"):
        assert name in result.stdout
    for name in ("numpy", "numba", "pandas", "pyarrow", "pydantic", "ruamel.yaml"):
        assert f"'{name}'" not in result.stderr


@pytest.mark.parametrize(
    "arguments", [["frobnicate"], ["check"], ["check", "--frob", "x"], ["check", "/no/such/study"], ["schema", "x"]]
)
def test_wrong_usage_is_2_without_a_traceback(arguments, capsys):
    assert main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.err
    assert "Traceback" not in captured.err


def test_the_version_is_told(capsys):
    assert main(["--version"]) == 0
    assert capsys.readouterr().out.startswith("tractionpower ")


def test_interruption_is_3_without_a_traceback(monkeypatch, capsys):
    def interrupt(study: str) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(check, "find_problems", interrupt)
    assert main(["check", "x"]) == 3
    assert "interrupted" in capsys.readouterr().err


def test_an_output_error_is_3(monkeypatch, capsys):
    def fail(study: str) -> None:
        raise OutputError("the disk is full")

    monkeypatch.setattr(check, "find_problems", fail)
    assert main(["check", "x"]) == 3
    assert "the disk is full" in capsys.readouterr().err


def test_a_defect_of_the_program_is_not_hidden(monkeypatch):
    def fail(study: str) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr(check, "find_problems", fail)
    with pytest.raises(ZeroDivisionError):
        main(["check", "x"])


def test_the_whole_way_in_a_process(tmp_path):
    folder = tmp_path / "study"
    assert run("new", str(folder)).returncode == 0
    assert run("check", str(folder)).returncode == 0
    (folder / "line.yaml").write_text("format: 1\ntracks: 5\n")
    result = run("check", str(folder))
    assert result.returncode == 1
    assert "line.yaml:2: line.tracks: found 5" in result.stderr
    assert "Traceback" not in result.stderr


def test_a_reader_of_a_pipe_that_leaves_gets_no_traceback():
    command = f'"{sys.executable}" -m tractionpower schema | head -1'
    result = subprocess.run(
        command, shell=True, capture_output=True, text=True, env={**os.environ, "PYTHONPATH": SOURCES}, check=False
    )
    assert "Traceback" not in result.stderr
    assert "BrokenPipe" not in result.stderr


@pytest.mark.skipif(os.name != "posix", reason="a closed pipe is another error elsewhere")
@pytest.mark.parametrize("closed", ["stdout", "stderr"])
@pytest.mark.parametrize("command", ["journey", "run"])
def test_a_closed_pipe_does_not_keep_results_from_being_written(tmp_path, command, closed):
    study = "two-substations"
    if command == "journey":
        study = str(write_train_study(tmp_path / "six"))
    reader, writer = os.pipe()
    os.close(reader)
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, closed: writer}
    ran = subprocess.run(
        [sys.executable, "-m", "tractionpower", command, study, "--out", str(tmp_path / "out")],
        text=True, env={**os.environ, "PYTHONPATH": SOURCES}, check=False, **streams,
    )  # fmt: skip
    os.close(writer)
    assert ran.returncode == 0, ran.stderr
    assert list((tmp_path / "out" / "figures").glob("*.png"))
    if closed == "stdout":
        assert f"results: {tmp_path / 'out'}" in ran.stderr
        assert "BrokenPipe" not in ran.stderr
    else:
        assert "ledger closes" in ran.stdout if command == "run" else "theoretical journeys" in ran.stdout
