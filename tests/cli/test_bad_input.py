"""Inputs and disks that are no good: each is told once, with the words that help, and harms nothing that was there."""

import errno
import os
import re
from pathlib import Path

import pyarrow.parquet as pq
import pytest
from small_files import write_small_study
from train_study import write_train_study

from tractionpower.cli import main
from tractionpower.results.results import Results

LOADS = 'loads:\n  - {id: train, track: "1", km: 10.0, power_kw: 3000, limits: none}\n'


@pytest.fixture(autouse=True)
def working_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def study(tmp_path):
    """Return the folder of a study with loads and trains, all of its files in it."""
    write_train_study(tmp_path / "study")
    return tmp_path / "study"


def replaced(name, old, new):
    """Return what exchanges a text in a file of a study."""

    def change(folder):
        text = (folder / name).read_text(encoding="utf-8")
        assert old in text
        (folder / name).write_text(text.replace(old, new, 1), encoding="utf-8")

    return change


def added(text):
    """Return what adds lists to the supply of a study."""

    def change(folder):
        with (folder / "supply.yaml").open("a", encoding="utf-8") as stream:
            stream.write(text)

    return change


def written(name, content):
    """Return what fills a file of a study."""
    return lambda folder: (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def from_csv(content):
    """Return what puts the gradients of a study into a CSV file."""

    def change(folder):
        text = (folder / "line.yaml").read_text(encoding="utf-8")
        text = re.sub(r"gradients:\n(  - .*\n)+", "gradients: gradients.csv\n", text)
        (folder / "line.yaml").write_text(text, encoding="utf-8")
        written("gradients.csv", content)(folder)

    return change


def huge(folder):
    from_csv("")(folder)
    with (folder / "gradients.csv").open("wb") as stream:
        stream.truncate(200_000_000)  # sparse: takes no room


def bomb():
    lines = ["a: &a [x, x, x, x, x, x, x, x, x]"]
    lines += [f"{name}: &{name} [{', '.join([f'*{before}'] * 9)}]" for before, name in zip("abcdefg", "bcdefgh", strict=True)]
    return "\n".join(lines)


HEADER = "from_km,to_km,permille\n"
EMPTY = ["the file is empty", "allowed: keys and values (key: value)", "remedy: `tractionpower new DIR`"]
BAD = {
    "empty study": (written("study.yaml", ""), "study.yaml", EMPTY),
    "empty line": (written("line.yaml", ""), "line.yaml: line", EMPTY),
    "empty supply": (written("supply.yaml", "# nothing\n"), "supply.yaml: supply", EMPTY),
    "empty timetable": (written("timetable.yaml", "\n\n"), "timetable.yaml: timetable", EMPTY),
    "empty vehicle": (
        written("rollingstock/vehicles/railcar.yaml", ""), "rollingstock/vehicles/railcar.yaml: vehicles[railcar]", EMPTY,
    ),
    "empty CSV": (from_csv(""), "gradients.csv: line.gradients", ["the file is empty", "a header row with from_km, to_km"]),
    "a text for a number": (
        replaced("supply.yaml", "km: 0.0", "km: ten"), "supply.yaml:3: supply.substations[S].km",
        ["found 'ten'", "allowed: a number [km]"],
    ),
    "a decimal comma": (
        replaced("supply.yaml", "internal_resistance_ohm: 0.1", 'internal_resistance_ohm: "0,1"'),
        "supply.yaml:3: supply.substations[S].internal_resistance_ohm", ["found '0,1'", "[Ω]", "remedy: write the decimals with"],
    ),
    "a number for a list": (
        written("line.yaml", "format: 1\ntracks: 5\n"),
        "line.yaml:2: line.tracks", ["found 5", "allowed: a list, or the name of a CSV file"],
    ),
    "a list for a number": (
        replaced("supply.yaml", "no_load_voltage_v: 3300", "no_load_voltage_v: [3300, 3400]"),
        "supply.yaml:3: supply.substations[S].no_load_voltage_v", ["found a list of 2", "allowed: a number", "[V]"],
    ),
    "a tab": (
        replaced("line.yaml", "  - {id: \"2\"", "\t- {id: \"2\""), "line.yaml:4: line",
        ["a tab for indentation", "allowed: blanks", "remedy: replace the tabs by blanks"],
    ),
    "no YAML": (
        written("line.yaml", "format: 1\ntracks: [1, 2\nstations: 3\n"), "line.yaml:3: line", ["no YAML", "'stations: 3'"],
    ),
    "an archive": (
        written("line.yaml", "PK\x03\x04"), "line.yaml:1: line",
        ["a character that YAML forbids: '\\x03'", "remedy: is it the right"],
    ),
    "a picture": (
        written("supply.yaml", b"\x89PNG\r\n\x1a\n"), "supply.yaml:1: supply",
        ["0x89 is not UTF-8", "remedy: save the file as UTF-8"],
    ),
    "an alias bomb": (
        written("line.yaml", bomb()), "line.yaml:1: line",
        ["aliases (*name) add more than 100000 values", "remedy: write the values out"],
    ),
    "a CSV file of 200 MB": (
        huge, "gradients.csv: line.gradients",
        ["the file has 200.0 MB", "allowed: at most 50 MB", "remedy: is it the right file?"],
    ),
    "a formula in a CSV file": (
        from_csv(HEADER + "0,4,0\n4,6.5,=2*5\n"), "gradients.csv:3: line.gradients[1].permille",
        ["found '=2*5' in column permille", "allowed: a number", "[‰]", "remedy: formulas are not computed: write the value"],
    ),
    "a ragged CSV file": (
        from_csv(HEADER + "0,4,0\n4,6.5\n"), "gradients.csv:3: line.gradients", ["found 2 cells in the row", "allowed: 3, as in"],
    ),
    "a train on no track": (
        replaced("timetable.yaml", 'track: "2"', 'track: "9"'), "timetable.yaml:13: timetable.trains[EC 2/1].route[0].track",
        ["track: the line has no track 9", "allowed: tracks: 1, 2", "remedy: name tracks of the line"],
    ),
    "a train beyond its track": (
        replaced("timetable.yaml", "from_km: 6.0, to_km: 0.5", "from_km: 66.0, to_km: 0.5"),
        "timetable.yaml:13: timetable.trains[EC 2/1].route[0].from_km",
        ["km 66 is not on track 2", "allowed: track 2 from km 0 to km 6.5", "remedy: correct the km"],
    ),
    "a train that is not there": (
        replaced("timetable.yaml", "train: local", "train: locla"), "timetable.yaml:4: timetable.trains[11].train",
        ["locla", "remedy: did you mean local?"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("change, place, words".split(", "), BAD.values(), ids=BAD)
@pytest.mark.parametrize("command", ["check", "run"])
def test_bad_inputs_are_told_once_with_what_helps(study, tmp_path, capsys, command, change, place, words):
    change(study)
    assert main([command, "study"]) == 1
    captured = capsys.readouterr()
    told = captured.err
    assert "1 error\n" in (captured.out if command == "check" else told)
    errors = re.findall(r"^  error: (.+)", told, re.MULTILINE)
    assert len(errors) == 1 and errors[0].startswith(f"{place}: "), told
    for word in words:
        assert word in told
    assert "Traceback" not in told
    assert [path.name for path in tmp_path.iterdir()] == ["study"]


def rows(name, *items):
    """Return what adds a list to the supply of a study, one row on each line."""
    return added(f"{name}:\n" + "".join(f"  - {{{item}}}\n" for item in items))


TIE = 'id: {}, from: {{track: "1", km: 5}}, to: {{track: "2", km: 5}}'
SWITCHING = {
    "a switch that names no section": (
        rows("switches", 'id: Q, from: {track: "1", km: 9.0}, to: {busbar: S}'),
        "supply.yaml:9: supply.switches[Q].from.km", ["km 9 is not on track 1", "remedy: correct the km"],
    ),
    "a loop of no resistance": (
        rows("switches", TIE.format("Q"), TIE.format("R")),
        "supply.yaml:10: supply.switches[R]", ["a loop without resistance: switch Q, switch R", "remedy: give one of them a"],
    ),
    "events that contradict": (
        rows("switch_events", 'time: "06:30", device: S, state: bypassed', 'time: "06:30", device: S, state: rectifiers_out'),
        "supply.yaml:10: supply.switch_events[1]", ["2 events of S at 06:30:00 (bypassed, rectifiers_out)", "they contradict"],
    ),
    "an event of no device": (
        rows("switch_events", 'time: "06:30", device: S 1 high-km, state: open'),
        "supply.yaml:9: supply.switch_events[0].device", ["no device 'S 1 high-km'", "remedy: did you mean S 1 high_km?"],
    ),
    "a device without reference": (
        rows("voltage_limiting_devices", 'id: V, track: "1", km: 3.0, closes: [{above_v: 60}]'),
        "supply.yaml:9: supply.voltage_limiting_devices[V]", ["neither leakage nor earthing", "remedy: give leakage_s_per_km"],
    ),
    "a profile of two signs": (
        rows("loads", 'id: x, track: "1", km: 3, profile: [{time: "6:00", power_kw: 1}, {time: "6:30", power_kw: -1}]'),
        "supply.yaml:9: supply.loads[x]", ["a profile does not change its sign", "as two loads"],
    ),
}  # fmt: skip


@pytest.mark.parametrize("change, place, words".split(", "), SWITCHING.values(), ids=SWITCHING)
def test_faults_of_switches_and_rails_are_told_once(study, capsys, change, place, words):
    change(study)
    assert main(["run", "study"]) == 1
    told = capsys.readouterr().err
    assert told.count("  error: ") == 1, told
    assert f"  error: {place}: " in told
    for word in words:
        assert word in told


def test_a_stretch_that_dies_during_the_day_is_a_warning(study, capsys):
    rows("switch_events", 'time: "06:30", device: S 1 high_km, state: open')(study)
    assert main(["check", "study"]) == 0
    told = capsys.readouterr().err
    assert "  warning: supply.yaml:9: supply.switch_events[0]: from 06:30:00 on no substation in service reaches track 1" in told


@pytest.mark.parametrize(
    "change", [written("line.yaml", ""), written("supply.yaml", bomb()), replaced("supply.yaml", "km: 10.0", "km: =5*2")]
)
def test_bad_inputs_leave_earlier_results_alone(tmp_path, capsys, change):
    write_small_study(tmp_path / "small")
    assert main(["run", "small"]) == 0
    folder = tmp_path / "reports" / "small"
    before = contents(folder)
    change(tmp_path / "small")
    capsys.readouterr()
    assert main(["run", "small"]) == 1
    assert capsys.readouterr().err.count("error:") == 1
    assert contents(folder) == before


# --- texts that a spreadsheet takes for a formula


def test_a_text_that_begins_like_a_formula_stays_a_text(tmp_path):
    write_small_study(tmp_path / "small")
    replaced("supply.yaml", "id: train", 'id: "=cmd()"')(tmp_path / "small")
    replaced("supply.yaml", "id: A", 'id: "@A"')(tmp_path / "small")
    assert main(["run", "small", "--no-reports"]) == 0
    folder = str(Path("reports") / "small")
    assert main(["export", folder, "--to", "csv,xlsx", "--out", "out"]) == 0
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.load_workbook("out/tables.xlsx")
    cells = [cell for sheet in book for row in sheet.iter_rows() for cell in row]
    assert {cell.value for cell in cells if str(cell.value)[:1] in ("=", "@")} == {"=cmd()", "@A"}
    assert not [cell for cell in cells if cell.data_type == "f"]
    assert '"=cmd()"' in Path("out/loads.csv").read_text(encoding="utf-8")


# --- disks


def contents(folder):
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def failing(number):
    def fail(*arguments, **options):
        raise OSError(number, os.strerror(number))

    return fail


def fail_from_now_on(monkeypatch, where, number):
    owner, name = {
        "a part": (pq, "write_table"),
        "the joined table": (pq, "ParquetWriter"),
        "a text": (Path, "write_text"),
        "a folder": (Path, "mkdir"),
    }[where]
    monkeypatch.setattr(owner, name, failing(number))


@pytest.mark.parametrize("where", ["a part", "the joined table", "a text", "a folder"])
@pytest.mark.parametrize(
    ("number", "words"),
    [
        (errno.ENOSPC, "the disk is full; make room and run again"),
        (errno.EACCES, "no permission to write; choose another folder"),
    ],
    ids=["full", "forbidden"],
)
def test_a_disk_that_takes_nothing(tmp_path, capsys, monkeypatch, where, number, words):
    write_small_study(tmp_path / "small")
    assert main(["run", "small"]) == 0
    folder = tmp_path / "reports" / "small"
    before = contents(folder)
    capsys.readouterr()
    with monkeypatch.context() as patch:
        fail_from_now_on(patch, where, number)
        assert main(["run", "small", "--set", "supply.loads[train].power_kw=1000"]) == 3
    told = capsys.readouterr().err
    assert told.count("results cannot be written into") == 1
    assert str(Path("reports") / "small") in told
    assert words in told
    assert "Earlier results there are unharmed" in told
    assert "Traceback" not in told
    assert {name: data for name, data in contents(folder).items() if not name.startswith(".running")} == before
    assert not list(folder.rglob("*.tmp"))
    Results.open(folder)
    assert main(["run", "small"]) == 0
    assert not (folder / ".running").exists()
    assert contents(folder).keys() == before.keys()


def hold_open(monkeypatch, *names):
    """Let files of these names be such as another program has open on Windows."""
    replace = os.replace

    def refuse(source, target):
        if Path(target).name in names and Path(target).parent.name == "small":
            raise PermissionError(errno.EACCES, "held open by another program")
        return replace(source, target)

    monkeypatch.setattr(os, "replace", refuse)


@pytest.mark.parametrize("held", ["report.xlsx", "loads.parquet", "run.json"])
def test_a_file_that_is_open_elsewhere(tmp_path, capsys, monkeypatch, held):
    write_small_study(tmp_path / "small")
    assert main(["run", "small"]) == 0
    folder = tmp_path / "reports" / "small"
    before = (folder / held).read_bytes()
    hold_open(monkeypatch, held)
    capsys.readouterr()
    assert main(["run", "small", "--set", "supply.loads[train].power_kw=1000"]) == 0
    told = capsys.readouterr().err
    beside = f"{Path(held).stem}.new{Path(held).suffix}"
    assert told.count(f"{beside} was written beside a file that another program holds open") == 1
    assert (folder / held).read_bytes() == before
    assert (folder / beside).is_file()
    assert Results.open(folder).table("loads")["power_kw"].max() < 1500.0
