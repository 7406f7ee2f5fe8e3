"""Make the picture of the driving page anew: a shipped case, driven by keys in a headless Chromium.

Part of `make images` where a Chromium is there; the drive is in real time and takes a minute.
"""

from __future__ import annotations

import asyncio
import sys
import tempfile
import threading
from pathlib import Path

from PIL import Image

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests" / "support"))

from browser import Browser, find_browser  # noqa: E402

from tractionpower.io.dynamics_files import load_case  # noqa: E402
from tractionpower.results.kept import input_hash_of  # noqa: E402
from tractionpower.results.store import RunWriter  # noqa: E402
from tractionpower.web.controls import Controls  # noqa: E402
from tractionpower.web.drive import Drive, drive  # noqa: E402
from tractionpower.web.hello import has_independent_brake, hello, highest_levels  # noqa: E402
from tractionpower.web.live import LiveRun  # noqa: E402

IMAGE = ROOT / "docs" / "images" / "driving-page.png"
CASE = "zobory-hill"

SHADES = 200
"""Colours of the file."""

DRIVEN = (
    ("KeyF", 6.0),
    ("KeyL", 8.0),
    ("KeyN", 105.0),
    ("KeyM", 3.0),
    ("Digit3", 6.0),
    ("Digit0", 12.0),
    ("KeyV", 22.0),
    ("KeyM", 1.5),
    ("KeyQ", 2.6),
)
"""Keys, and how long each holds [simulated s]."""

FASTER = 3
"""How often time is made faster at the start: 10 simulated seconds in a second."""

SLOWLY = 2
"""How many of the keys are driven in real time."""


async def take(address: str, live: LiveRun, file: Path, size: tuple[int, int], *, dark: bool) -> None:
    """Drive, and write a picture of the page."""
    async with Browser(*size, dark=dark) as page:
        await page.open(address)
        await page.until("document.querySelectorAll('.lever').length === 2")
        await page.press("Enter", "Enter")
        for _ in range(FASTER):
            await page.press("Period", ".")
        for place, (code, seconds) in enumerate(DRIVEN):
            if place == len(DRIVEN) - SLOWLY:
                for _ in range(FASTER):
                    await page.press("Comma", ",")
            await page.press(code)
            until_s = live.session.time_s + seconds
            while live.session.time_s < until_s:
                await asyncio.sleep(0.01)
        await page.picture(file)


def main(file: Path = IMAGE, size: tuple[int, int] = (1366, 700), *, dark: bool = False) -> None:
    """Make the picture."""
    if find_browser() is None:
        print("no Chromium is found: the picture of the driving page stays as it is")
        return
    scenario = load_case(CASE).scenario
    opened, address = threading.Event(), []

    def open_page(its: str) -> None:
        address.append(its)
        opened.set()

    with tempfile.TemporaryDirectory() as folder:
        writer = RunWriter(Path(folder) / "out", CASE, input_hash_of(scenario), kind="dynamics", scenario=scenario)
        live = LiveRun(scenario, writer, CASE)
        live.begin()
        compiled = live.session.compiled
        controls = Controls(highest_levels(compiled), independent=has_independent_brake(compiled))
        what = Drive(live.session, controls, live, hello(compiled, f"reports/dynamics-{CASE}-driven"))
        serving = threading.Thread(target=drive, args=(what, open_page), kwargs={"leave_s": 0.5})
        serving.start()
        opened.wait()
        asyncio.run(take(address[0], live, file, size, dark=dark))
        serving.join()
        live.abandon()
    with Image.open(file) as picture:
        small = picture.convert("RGB").quantize(SHADES, dither=Image.Dither.NONE)
    small.save(file, optimize=True)
    print(file)


if __name__ == "__main__":
    main()
