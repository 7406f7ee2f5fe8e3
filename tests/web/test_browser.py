"""The page in a headless Chromium: real key presses, what stands there, nothing that the browser complains of."""

import asyncio

import pytest
from browser import Browser, find_browser
from fake_session import FakeSession, fake_hello
from serving import Serving

from tractionpower.web.keys import LEVEL_KEYS

pytestmark = pytest.mark.skipif(find_browser() is None, reason="no Chromium is found on the path")

NASTY = '<img src=x onerror="document.title=1"> & "Zug"'


@pytest.fixture(scope="module")
def visit():
    """Return what was seen on a page that was driven by keys; one visit for all tests, for a browser starts slowly."""
    serving = Serving(FakeSession(), fake_hello(name=NASTY))
    seen = asyncio.run(_visit(serving.address, serving.session))
    serving.join()
    return seen | {"session": serving.session, "ended": serving.ended}


async def _visit(address, session):
    seen = {"levels": {}}
    async with Browser() as page:
        await page.open(address)
        await page.until("document.querySelectorAll('.lever').length === 2")
        await page.until("document.querySelector('#banner').textContent.includes('Enter')")
        seen["overflow"] = await page.value("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
        await page.press("Enter", "Enter")
        await page.until("document.querySelector('#banner').hidden")
        for code, (control, level) in LEVEL_KEYS.items():
            await page.press(code)
            await page.until(f"document.querySelector('#lever-{control}').textContent === '{level}'")
            seen["levels"][code] = session.drive if control == "drive" else session.brake
        await page.press("Digit0")
        await page.press("ArrowUp", "ArrowUp", hold=3)
        await page.press("ArrowUp", "ArrowUp")
        await page.press("ArrowDown", "ArrowDown")
        await page.until("document.querySelector('#lever-drive').textContent === '3'")
        await page.press("ArrowRight", "ArrowRight")
        await page.until("document.querySelector('#lever-brake').textContent === '1'")
        await page.press("ArrowLeft", "ArrowLeft")
        await page.value("document.querySelector('.lever.drive [data-level=\"15\"]').click()")
        await page.until("document.querySelector('#lever-drive').textContent === '15'")
        await page.value("document.querySelector('[data-factor=\"10\"]').click()")
        await page.until("parseFloat(document.querySelector('#speed').textContent) > 10")
        await page.press("Space", " ")
        await page.until("document.querySelector('#lever-brake').textContent === 'EM'")
        await page.until("parseFloat(document.querySelector('#value-cylinder_first_bar').textContent) > 1")
        await page.press("KeyP")
        await page.until("document.querySelector('#pause').textContent === 'Go on'")
        seen["time"] = [await page.text("#clock"), await asyncio.sleep(0.3) or await page.text("#clock")]
        seen["texts"] = {
            name: await page.text(f"#{name}") for name in ("name", "steps", "frames", "longest", "value-damage_index")
        }
        seen["title"] = await page.value("document.title")
        seen["images"] = await page.value("document.images.length")
        inks = "[...document.querySelectorAll('canvas')].map((c) => c.getContext('2d').getImageData(0, 0, c.width, c.height)"
        seen["inked"] = await page.value(f"{inks}.data.some((v) => v > 0))")
        await page.value("document.querySelector('#finish').click()")
        await page.until("document.querySelector('#banner').textContent.includes('reports/hill')")
        await asyncio.sleep(0.2)
        seen["complaints"] = page.complaints
    return seen


def test_each_of_the_32_keys_sets_its_level(visit):
    assert visit["levels"] == {code: level for code, (_, level) in LEVEL_KEYS.items()}


def test_emergency_reaches_the_train(visit):
    assert {"brake": "emergency"} in [setting for _, setting in visit["session"].settings]
    assert visit["session"].emergency


def test_the_browser_has_nothing_to_complain_of(visit):
    assert visit["complaints"] == []


def test_the_page_fits_a_small_screen_without_scrolling(visit):
    width, height = visit["overflow"]
    assert width <= 1366
    assert height <= 700


def test_a_pause_stops_the_clock(visit):
    before, after = visit["time"]
    assert before == after != "0:00.0"


def test_a_name_of_a_user_is_shown_as_text(visit):
    assert visit["texts"]["name"] == NASTY
    assert visit["title"].startswith(NASTY)
    assert visit["images"] == 0


def test_the_pace_is_shown(visit):
    assert float(visit["texts"]["frames"]) > 10
    assert float(visit["texts"]["longest"]) >= 0


def test_every_diagram_is_drawn(visit):
    assert len(visit["inked"]) == 6 + 2 + 5
    assert all(visit["inked"])


def test_the_drive_ends_by_its_button(visit):
    assert visit["ended"].why == "stopped"
