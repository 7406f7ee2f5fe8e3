"""The server: who is let in, what comes through the socket, how it ends."""

import asyncio
import json
import socket
from importlib import resources

import aiohttp
import pytest
from fake_session import FakeSession
from serving import Serving

from tractionpower.errors import UsageError
from tractionpower.web.drive import listen
from tractionpower.web.server import KINDS, page_file


async def received(page, kind):
    async for message in page:
        found = json.loads(message.data)
        if found["kind"] == kind:
            return found
    raise AssertionError(f"no {kind} came")


def talk(serving, do, **more):
    """Open the socket as the page does, call `do` with it, and wait for the end of the drive."""

    async def go():
        async with aiohttp.ClientSession() as client:
            async with client.ws_connect(f"{serving.base}/socket?key={serving.key}", **more) as page:
                await do(page)

    asyncio.run(go())
    serving.join()


def answers(serving, requests):
    """Return status and text of GET requests (path, heads)."""

    async def go():
        async with aiohttp.ClientSession() as client:
            found = []
            for path, heads in requests:
                async with client.get(f"{serving.base}{path}", headers=heads) as answer:
                    found.append((answer.status, await answer.text(), answer.headers))
            return found

    return asyncio.run(go())


async def finish(page):
    await page.send_json({"do": "finish"})
    await received(page, "over")


@pytest.fixture
def serving():
    made = Serving()
    yield made
    if made.is_alive:
        talk(made, finish)


@pytest.fixture(scope="module")
def standing():
    """Return a server that nobody drives: one for all that is only asked for."""
    made = Serving()
    yield made
    talk(made, finish)


def test_it_listens_on_loopback_only():
    with listen(0) as listening:
        assert listening.getsockname()[0] == "127.0.0.1"


def test_a_port_that_is_taken_is_told():
    with listen(0) as first:
        first.listen()
        with pytest.raises(UsageError, match="--port"):
            listen(first.getsockname()[1])


def test_the_page_and_its_files_come_with_a_policy_that_lets_nothing_in_from_elsewhere(standing):
    paths = [f"/?key={standing.key}", *(f"/static/{name}" for name in KINDS)]
    for (status, _, heads), path in zip(answers(standing, [(path, {}) for path in paths]), paths, strict=True):
        assert status == 200, path
        policy = heads["Content-Security-Policy"]
        assert "default-src 'none'" in policy
        assert "unsafe" not in policy
        assert heads["X-Content-Type-Options"] == "nosniff"
        assert heads["Referrer-Policy"] == "no-referrer"


@pytest.mark.parametrize(
    "heads",
    [
        {"Host": "evil.example"},
        {"Host": "evil.example:80"},
        {"Host": "127.0.0.1"},
        {"Host": "127.0.0.1:1"},
        {"Host": ""},
        {"Origin": "http://evil.example"},
        {"Origin": "null"},
        {"Origin": "https://127.0.0.1"},
        {"Origin": "http://127.0.0.1"},
    ],
    ids=str,
)
def test_a_foreign_host_or_origin_is_refused_everywhere(standing, heads):
    key = standing.key
    found = answers(standing, [(path, heads) for path in (f"/?key={key}", "/static/drive.js", f"/socket?key={key}")])
    assert [status for status, _, _ in found] == [403] * 3
    assert all(key not in text for _, text, _ in found)


def test_its_own_origin_is_let_in_under_both_names(standing):
    port = standing.base.rsplit(":", 1)[1]
    heads = [{"Host": f"{name}:{port}", "Origin": f"http://{name}:{port}"} for name in ("127.0.0.1", "localhost")]
    assert [status for status, _, _ in answers(standing, [(f"/?key={standing.key}", head) for head in heads])] == [200, 200]


@pytest.mark.parametrize("key", ["", "?key=", "?key=wrong", "?key=%ff%fe", "?key=é"])
def test_without_the_key_there_is_no_page_and_no_socket(standing, key):
    found = answers(standing, [(f"{path}{key}", {}) for path in ("/", "/socket")])
    assert [status for status, _, _ in found] == [403, 403]
    assert "address" in found[0][1]


@pytest.mark.parametrize("name", ["nothing.js", "..%2Fserver.py", "%2e%2e%2fguard.py", "uplot-LICENSE.txt", "drive.js%00"])
def test_no_other_file_is_given(standing, name):
    ((status, text, _),) = answers(standing, [(f"/static/{name}", {})])
    assert status == 404
    assert "import" not in text


def test_a_socket_with_a_foreign_origin_is_refused(standing):
    async def go():
        async with aiohttp.ClientSession() as client:
            with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
                await client.ws_connect(f"{standing.base}/socket?key={standing.key}", origin="http://evil.example")
            return refused.value.status

    assert asyncio.run(go()) == 403


def test_a_page_is_greeted_and_drives(serving):
    async def do(page):
        greeting = await received(page, "hello")
        assert greeting["name"] == "Twenty wagons over a hill"
        assert len(greeting["keys"]["keys"]) >= 32
        await page.send_json({"set": "drive", "level": 15})
        await received(page, "statistics")
        while (frame := await received(page, "frame"))["snapshot"]["time_s"] < 0.2:
            pass
        assert frame["snapshot"]["drive"] == 15
        assert frame["snapshot"]["speed_kmh"] > 0.0
        assert frame["desk"]["longest_lag_ms"] >= frame["desk"]["lag_ms"] >= 0.0
        await page.send_json({"do": "finish"})
        assert (await received(page, "over"))["why"] == "stopped"

    talk(serving, do)
    assert serving.ended.why == "stopped"
    assert serving.keeper.notes[0][1] == {"drive": 15}
    assert serving.keeper.taken >= 1


def test_a_page_that_is_loaded_again_sees_what_was(serving):
    async def do(page):
        await page.send_json({"do": "start"})
        while (await received(page, "frame"))["snapshot"]["time_s"] < 0.3:
            pass

    async def go():
        async with aiohttp.ClientSession() as client:
            address = f"{serving.base}/socket?key={serving.key}"
            async with client.ws_connect(address) as first:
                await do(first)
            async with client.ws_connect(address) as again:
                history = await received(again, "history")
                await again.send_json({"do": "finish"})
                await received(again, "over")
        return history

    points = asyncio.run(go())["points"]
    serving.join()
    assert points[-1][0] > 0.3 - 0.04 - 1e-9
    assert [point[0] for point in points] == sorted(point[0] for point in points)


def test_the_drive_ends_when_the_page_is_closed(serving):
    async def leave(page):
        await received(page, "hello")

    talk(serving, leave)
    assert serving.ended.why == "left"


def test_what_is_no_order_ends_that_page_only(serving):
    async def go():
        async with aiohttp.ClientSession() as client:
            address = f"{serving.base}/socket?key={serving.key}"
            async with client.ws_connect(address) as good, client.ws_connect(address) as bad:
                await bad.send_str('{"set": "horn", "level": 1}')
                async for _ in bad:
                    pass
                assert bad.closed
                await received(good, "frame")
                await good.send_json({"do": "finish"})
                await received(good, "over")

    asyncio.run(go())
    serving.join()
    assert serving.failure is None


def test_a_failure_of_the_computation_reaches_the_caller_and_the_page():
    class Broken(FakeSession):
        def advance(self, until_s):
            raise ArithmeticError("no number any more")

    serving = Serving(Broken())

    async def do(page):
        await page.send_json({"do": "start"})
        assert (await received(page, "over"))["why"] == "failed"

    talk(serving, do)
    assert isinstance(serving.failure, ArithmeticError)


def test_nothing_of_the_page_comes_from_elsewhere():
    for name in KINDS:
        text = page_file(name).decode()
        assert "//cdn" not in text
        for place in ('src="http', 'href="http', "@import", "url(", "innerHTML =", "insertAdjacentHTML", "eval("):
            assert place not in text or name in {"uplot.js"}, (name, place)


def test_the_library_of_the_diagrams_keeps_its_licence():
    folder = resources.files("tractionpower.web") / "static"
    assert "Leon Sorokin" in (folder / "uplot-LICENSE.txt").read_text(encoding="utf-8")
    assert {path.name for path in folder.iterdir()} == {*KINDS, "uplot-LICENSE.txt"}


def test_the_port_is_free_again_after_the_drive(serving):
    port = int(serving.base.rsplit(":", 1)[1])

    async def leave(page):
        await received(page, "hello")

    talk(serving, leave)
    with socket.socket() as free:
        assert free.connect_ex(("127.0.0.1", port)) != 0
