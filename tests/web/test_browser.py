"""The page in a headless Chromium: real key presses, what stands there, nothing that the browser complains of."""

import asyncio

import pytest
from browser import Browser, find_browser
from fake_session import FakeSession, fake_hello
from serving import Serving

from tractionpower.web.keys import LEVEL_KEYS

pytestmark = pytest.mark.skipif(find_browser() is None, reason="no Chromium is found on the path")

BLOW_KN = 987.6

NASTY = '<img src=x onerror="document.title=1"> & "Zug"'


@pytest.fixture(scope="module")
def visit():
    """Return what was seen on a page that was driven by keys; one visit for all tests, for a browser starts slowly."""
    serving = Serving(FakeSession(blow_kn=BLOW_KN), fake_hello(name=NASTY))
    seen = asyncio.run(_visit(serving.address, serving.session, lambda: serving.is_alive))
    serving.join()
    return seen | {"session": serving.session, "ended": serving.ended}


_BUTTONS_THAT_CANNOT_BE_HIT = """[...document.querySelectorAll('button')].filter((made) => {
    const box = made.getBoundingClientRect();
    const corners = [[box.left + 3, box.top + 3], [box.right - 3, box.bottom - 3]];
    return corners.some(([x, y]) => !made.contains(document.elementFromPoint(x, y)));
}).map((made) => made.textContent)"""

_TEXTS_THAT_ARE_CUT = """[...document.querySelectorAll('#desk *, figcaption *, .chart header, #panel *, #top *, #banner')]
    .filter((made) => made.scrollWidth > made.clientWidth + 1 && made.clientWidth > 0).map((made) => made.textContent)"""


def _keys_of(wanted):
    return [(code, control, level) for code, (control, level) in LEVEL_KEYS.items() if control == wanted]


async def _pointed_at_first(page):
    """Return what is told of the first coupling when the pointer is on it."""
    box = await page.value("(({left, top}) => [left, top])(document.querySelector('#along canvas').getBoundingClientRect())")
    await page.call("Input.dispatchMouseEvent", type="mouseMoved", x=box[0] + 50, y=box[1] + 40)
    await page.until("document.querySelector('#along-value').textContent.startsWith('1|2')")
    return await page.text("#along-value")


async def _visit(address, session, serving_is_alive):
    seen = {"levels": {}}
    async with Browser() as page:
        await page.open(address)
        await page.until("document.querySelectorAll('.lever').length === 2")
        await page.until("document.querySelector('#banner').textContent.includes('Enter')")
        seen["overflow"] = await page.value("[document.documentElement.scrollWidth, document.documentElement.scrollHeight]")
        await page.press("Enter", "Enter")
        await page.until("document.querySelector('#banner').textContent === ''")
        for pair in zip(*(_keys_of(control) for control in ("drive", "brake")), strict=True):
            for code, _, _ in pair:
                await page.press(code)
            for code, control, level in pair:
                await page.until(f"document.querySelector('#lever-{control}').textContent === '{level}'")
                seen["levels"][code] = getattr(session, control)
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
        await page.until("parseFloat(document.querySelector('#speed').textContent) > 3")
        await page.press("Space", " ")
        await page.until("document.querySelector('#lever-brake').textContent === 'E'")
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
        seen["along"] = await _pointed_at_first(page)
        seen["texts"] |= {"controls": await page.text("#charts .chart b"), "banner": await page.text("#banner")}
        seen["hidden"] = await page.value(_BUTTONS_THAT_CANNOT_BE_HIT)
        seen["cut"] = await page.value(_TEXTS_THAT_ARE_CUT)
        await page.value("document.querySelector('#finish').click()")
        await asyncio.sleep(0.1)
        seen["asked"] = [await page.text("#finish"), serving_is_alive()]
        await page.value("document.querySelector('#finish').click()")
        await page.until("document.querySelector('#banner').textContent.includes('reports/hill')")
        seen["cut"] += await page.value(_TEXTS_THAT_ARE_CUT)
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


def test_the_extremes_along_the_train_are_those_of_the_program_not_of_the_frames(visit):
    greatest, least = visit["session"].extremes[:, 0]
    assert greatest == BLOW_KN
    told = [float(word) for word in visit["along"].replace("−", "-").replace(",", "").split() if word[-1].isdigit()][1:]
    assert told == pytest.approx([least, greatest], abs=0.06)


def test_emergency_has_a_name_and_no_number(visit):
    assert visit["texts"]["controls"].endswith("/ emergency")


@pytest.mark.parametrize("what", ["hidden", "cut"])
def test_every_button_can_be_hit_and_no_text_is_cut(visit, what):
    assert visit[what] == []


def test_a_long_drive_does_not_end_by_one_click(visit):
    assert visit["asked"] == ["End the drive?", True]


def test_the_drive_ends_by_its_button(visit):
    assert visit["ended"].why == "stopped"
