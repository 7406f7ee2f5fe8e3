"""The server of the driving page: its files, its socket, and who is looking."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
from importlib import resources
from typing import Any

from aiohttp import WSMsgType, web

from tractionpower.web.guard import Guard, guarded
from tractionpower.web.messages import frame_message, message, statistics_message
from tractionpower.web.orders import LONGEST, Order, read_order

KINDS = {
    "index.html": "text/html",
    "drive.css": "text/css",
    "uplot.css": "text/css",
    "icon.svg": "image/svg+xml",
    "canvas.js": "text/javascript",
    "keys.js": "text/javascript",
    "charts.js": "text/javascript",
    "page.js": "text/javascript",
    "levers.js": "text/javascript",
    "numbers.js": "text/javascript",
    "forces.js": "text/javascript",
    "drive.js": "text/javascript",
    "uplot.js": "text/javascript",
}
"""Files of the page, and what they are."""

MOST_FRAMES = 50
"""Frames that wait for a slow page; those beyond are left out for it."""

MOST_MESSAGES = 500
"""Messages that wait for a page; one that lets more wait is gone."""

HISTORY = 3000
"""Points of the diagrams that a page gets when it is opened anew."""

NO_KEY = "open the address that the command has printed: its key is missing here, or of an earlier run\n"


def page_file(name: str) -> bytes:
    """Return a file of the page, from the package."""
    return resources.files("tractionpower.web").joinpath("static", name).read_bytes()


class Hub:
    """Sends messages to all pages that are open.

    Parameters
    ----------
    hello
        What a page is told first.
    """

    def __init__(self, hello: Mapping[str, Any]) -> None:
        self._hello = message("hello", hello)
        self._pages: set[asyncio.Queue[str | None]] = set()
        self._history: deque[list[Any]] = deque(maxlen=HISTORY)
        self._statistics: str | None = None
        self.changed = asyncio.Event()
        self.was_open = False

    @property
    def is_open(self) -> bool:
        """Whether a page is open."""
        return bool(self._pages)

    def send(self, kind: str, content: Mapping[str, Any]) -> None:
        """Send a message to all pages; to be called in the thread of the server."""
        if kind == "frame":
            self._history.extend(content["points"])
            text = frame_message(content)
        elif kind == "statistics":
            text = self._statistics = statistics_message(content)
        else:
            text = message(kind, content)
        for page in [*self._pages]:
            if kind == "frame" and page.qsize() >= MOST_FRAMES:
                continue
            if page.qsize() >= MOST_MESSAGES:
                self.leave(page)
                page.put_nowait(None)
            else:
                page.put_nowait(text)

    def enter(self) -> asyncio.Queue[str | None]:
        """Return the messages of a new page; None among them is the end."""
        page: asyncio.Queue[str | None] = asyncio.Queue()
        page.put_nowait(self._hello)
        page.put_nowait(message("history", {"points": [*self._history]}))
        if self._statistics is not None:
            page.put_nowait(self._statistics)
        self._pages.add(page)
        self.was_open = True
        self.changed.set()
        return page

    def leave(self, page: asyncio.Queue[str | None]) -> None:
        """Forget a page."""
        self._pages.discard(page)
        self.changed.set()

    def close(self) -> None:
        """End all pages, each after what waits for it."""
        for page in self._pages:
            page.put_nowait(None)


def new_app(guard: Guard, hub: Hub, order: Callable[[Order], bool]) -> web.Application:
    """Return the application; `order` takes what a page asks for, and returns False when it asks for too much."""
    heads = guard.heads()

    async def index(request: web.Request) -> web.Response:
        if not guard.knows(request):
            return web.Response(status=403, text=NO_KEY, headers=heads)
        return web.Response(body=page_file("index.html"), content_type=KINDS["index.html"], charset="utf-8", headers=heads)

    async def file(request: web.Request) -> web.Response:
        name = request.match_info["name"]
        if name not in KINDS:
            return web.Response(status=404, text="no such file\n", headers=heads)
        return web.Response(body=page_file(name), content_type=KINDS[name], charset="utf-8", headers=heads)

    async def socket(request: web.Request) -> web.StreamResponse:
        if not guard.knows(request):
            return web.Response(status=403, text=NO_KEY, headers=heads)
        return await _talk(request, hub, order)

    app = web.Application(middlewares=[guarded(guard)], client_max_size=1024)
    app.add_routes([web.get("/", index), web.get("/static/{name}", file), web.get("/socket", socket)])
    return app


async def _talk(request: web.Request, hub: Hub, order: Callable[[Order], bool]) -> web.WebSocketResponse:
    """Send a page all messages, and hand on what it asks for, until it leaves."""
    socket = web.WebSocketResponse(heartbeat=20.0, max_msg_size=4 * LONGEST, compress=False)
    await socket.prepare(request)
    page = hub.enter()
    sending = asyncio.create_task(_send(socket, page))
    try:
        async for received in socket:
            if received.type is not WSMsgType.TEXT:
                break
            wanted = read_order(received.data)
            if wanted is None or not order(wanted):
                break
    finally:
        hub.leave(page)
        sending.cancel()
        await socket.close()
    return socket


async def _send(socket: web.WebSocketResponse, page: asyncio.Queue[str | None]) -> None:
    try:
        while (text := await page.get()) is not None:
            await socket.send_str(text)
        await socket.close()
    except (ConnectionError, RuntimeError):  # the page has gone
        return
