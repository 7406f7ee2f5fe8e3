"""``tractionpower dynamics drive``: from the command to results, by a client that does what the page does."""

import asyncio
import importlib.util
import json
import re
import signal
import subprocess
import sys
import threading

import aiohttp
import pytest
from small_cases import write_small_case

from tractionpower.cli import drive, main
from tractionpower.results.results import Results
from tractionpower.web.drive import listen


@pytest.fixture
def case(tmp_path):
    return write_small_case(tmp_path / "case")


def drive_by_page(address, *orders, moving=None):
    """Send orders as the page does, each after a little driving, until the drive is over."""

    async def go():
        base, key = address.split("/?key=")
        async with aiohttp.ClientSession() as client, client.ws_connect(f"{base}/socket?key={key}") as page:
            frames = 0
            waiting = list(orders)
            async for message in page:
                found = json.loads(message.data)
                frames += found["kind"] == "frame"
                if moving is not None and found["kind"] == "frame" and found["snapshot"]["time_s"] > 0.1:
                    moving.set()
                if frames >= 3 and waiting:
                    frames = 0
                    await page.send_json(waiting.pop(0))
                if found["kind"] == "over":
                    return found
        return None

    return asyncio.run(go())


@pytest.fixture
def call(monkeypatch):
    """Return what calls the command and drives by orders; it returns the exit code."""

    def run(arguments, *orders):
        opened = threading.Event()
        addresses = []

        def tell_address(address, *, no_browser):
            assert no_browser
            addresses.append(address)
            opened.set()

        monkeypatch.setattr(drive, "_tell_address", tell_address)
        codes = []
        thread = threading.Thread(target=lambda: codes.append(main(["dynamics", "drive", *map(str, arguments), "--no-browser"])))
        thread.start()
        while thread.is_alive() and not opened.wait(0.1):  # the kernels may have to be compiled
            pass
        assert addresses, codes
        over = drive_by_page(addresses[0], *orders)
        thread.join(60)
        return codes[0], over

    return run


def test_a_drive_becomes_results_and_a_case_that_runs(call, case, tmp_path, capsys):
    out = tmp_path / "out"
    code, over = call([case, "--out", out, "--no-reports"], {"set": "drive", "level": 15}, {"factor": 10}, {"do": "finish"})
    assert code == 0
    assert over["why"] == "stopped"
    said = capsys.readouterr()
    assert "longest lag behind the clock" in said.err
    assert "dynamics run" in said.err
    assert "greatest tension" in said.out
    results = Results.open(out)
    assert results.run["status"] == "complete"
    assert results.run["kind"] == "dynamics"
    assert [row.drive for row in results.scenario.case.commands] == [15]
    assert "drive" in (out / "driven" / "commands.csv").read_text(encoding="utf-8")
    assert main(["dynamics", "run", str(out / "driven"), "--out", str(tmp_path / "again"), "--no-reports"]) == 0
    again = Results.open(tmp_path / "again")
    assert again.run["input_hash"] == results.run["input_hash"]
    assert again.table("vehicles").equals(results.table("vehicles"))


def test_a_page_that_was_only_looked_at_leaves_nothing(call, case, tmp_path, capsys):
    code, _ = call([case, "--out", tmp_path / "out", "--no-reports"], {"do": "finish"})
    assert code == 0
    assert "nothing was driven" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="Windows sends no Ctrl-C to one process")
def test_ctrl_c_ends_the_drive_and_keeps_it(case, tmp_path):
    out = tmp_path / "out"
    arguments = ["dynamics", "drive", str(case), "--out", str(out), "--no-browser", "--no-reports", "--stay"]
    with subprocess.Popen([sys.executable, "-m", "tractionpower", *arguments], stderr=subprocess.PIPE, text=True) as ran:
        lines = []
        for line in ran.stderr:
            lines.append(line)
            if found := re.search(r"http://127\.0\.0\.1:\d+/\?key=\S+", line):
                break
        moving = threading.Event()
        orders = ({"set": "drive", "level": 10}, {"factor": 10})
        thread = threading.Thread(target=drive_by_page, args=(found[0], *orders), kwargs={"moving": moving})
        thread.start()
        assert moving.wait(20)
        ran.send_signal(signal.SIGINT)
        rest = ran.stderr.read()
        thread.join(10)
    assert ran.returncode == 0, "".join(lines) + rest
    assert "Traceback" not in rest
    assert Results.open(out).run["status"] == "complete"


def test_without_aiohttp_it_says_what_to_install(monkeypatch, case, capsys):
    found = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *more: None if name == "aiohttp" else found(name, *more))
    assert main(["dynamics", "drive", str(case)]) == 2
    assert "pip install tractionpower[drive]" in capsys.readouterr().err


def test_a_case_of_stations_cannot_be_driven(capsys):
    assert main(["dynamics", "drive", "traindyn-three-stations"]) == 2
    assert "can be driven" in capsys.readouterr().err


def test_an_unknown_case_and_a_bad_port_are_wrong_usage(capsys):
    assert main(["dynamics", "drive", "no-such-case"]) == 2
    assert main(["dynamics", "drive", "zobory-hill", "--port", "70000"]) == 2
    assert "Traceback" not in capsys.readouterr().err


def test_a_port_that_is_taken_leaves_no_folder(case, tmp_path, capsys):
    with listen(0) as taken:
        taken.listen()
        port = str(taken.getsockname()[1])
        assert main(["dynamics", "drive", str(case), "--out", str(tmp_path / "out"), "--port", port, "--no-browser"]) == 2
    assert f"port {port}" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_case_with_errors_is_refused_with_all_of_them(case, tmp_path, capsys):
    file = case / "case.yaml"
    text = file.read_text(encoding="utf-8")
    file.write_text(text + "commands: [{time_s: 0, drive: 99}, {time_s: 1, brake: 99}]\n", encoding="utf-8")
    assert main(["dynamics", "drive", str(case), "--out", str(tmp_path / "out"), "--no-browser"]) == 1
    said = capsys.readouterr().err
    assert "commands[0]" in said
    assert "commands[1]" in said
    assert not (tmp_path / "out").exists()


def test_the_help_says_in_which_language_the_page_is(capsys):
    assert main(["dynamics", "drive", "--help"]) == 0
    assert "driving page is in English" in " ".join(re.sub(r"[│|]", " ", capsys.readouterr().out).split())
