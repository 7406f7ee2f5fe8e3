"""A headless Chromium, driven by its DevTools protocol: opens a page, presses keys, reads what stands there, takes pictures."""

from __future__ import annotations

import asyncio
import base64
import json
import os
import shutil
import subprocess
import tempfile
import time
from pathlib import Path
from typing import Any

import aiohttp

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome", "msedge")
FLAGS = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--no-first-run",
    "--no-default-browser-check",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--remote-debugging-port=0",
)


def find_browser() -> str | None:
    """Return the path of a Chromium, or None where there is none."""
    return next((found for name in NAMES if (found := shutil.which(name))), None)


class Browser:
    """One page in a headless Chromium; to be used as ``async with Browser() as page``."""

    def __init__(self, width: int = 1366, height: int = 700, *, dark: bool = False) -> None:
        self.size, self.dark = (width, height), dark
        self.complaints: list[str] = []
        self._answers: dict[int, asyncio.Future[Any]] = {}
        self._count = 0

    async def __aenter__(self) -> Browser:
        program = find_browser()
        assert program is not None
        self._profile = tempfile.mkdtemp(prefix="chromium-")
        window = f"--window-size={self.size[0]},{self.size[1]}"
        command = [program, *FLAGS, window, f"--user-data-dir={self._profile}", "about:blank"]
        self._process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        port = await self._port()
        self._http = aiohttp.ClientSession()
        async with self._http.get(f"http://127.0.0.1:{port}/json/list") as answer:
            pages = [page for page in await answer.json() if page["type"] == "page"]
        self._socket = await self._http.ws_connect(pages[0]["webSocketDebuggerUrl"], max_msg_size=0)
        self._reading = asyncio.create_task(self._read())
        for domain in ("Page", "Runtime", "Log"):
            await self.call(f"{domain}.enable")
        shape = {"width": self.size[0], "height": self.size[1], "deviceScaleFactor": 1, "mobile": False}
        await self.call("Emulation.setDeviceMetricsOverride", **shape)
        scheme = [{"name": "prefers-color-scheme", "value": "dark" if self.dark else "light"}]
        await self.call("Emulation.setEmulatedMedia", features=scheme)
        return self

    async def __aexit__(self, *_: object) -> None:
        self._reading.cancel()
        await self._socket.close()
        await self._http.close()
        self._process.terminate()
        try:
            self._process.wait(10)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait(10)
        shutil.rmtree(self._profile, ignore_errors=True)

    async def _port(self) -> int:
        file = Path(self._profile) / "DevToolsActivePort"
        until = time.monotonic() + 30.0
        while time.monotonic() < until:
            lines = file.read_text().splitlines() if file.is_file() else []
            if len(lines) > 1:
                return int(lines[0])
            await asyncio.sleep(0.05)
        raise TimeoutError("Chromium does not tell its port")

    async def _read(self) -> None:
        async for received in self._socket:
            found = json.loads(received.data)
            if found.get("id") in self._answers:
                self._answers.pop(found["id"]).set_result(found)
            elif found.get("method") == "Log.entryAdded" and found["params"]["entry"]["level"] in {"error", "warning"}:
                self.complaints.append(str(found["params"]["entry"]))
            elif found.get("method") == "Runtime.exceptionThrown":
                self.complaints.append(str(found["params"]["exceptionDetails"]))

    async def call(self, method: str, **params: Any) -> dict[str, Any]:
        """Call a method of the protocol and return its result."""
        self._count += 1
        self._answers[self._count] = answer = asyncio.get_running_loop().create_future()
        await self._socket.send_json({"id": self._count, "method": method, "params": params})
        found = await asyncio.wait_for(answer, 30.0)
        assert "error" not in found, found
        result: dict[str, Any] = found["result"]
        return result

    async def open(self, address: str) -> None:
        """Go to an address."""
        await self.call("Page.navigate", url=address)

    async def value(self, expression: str) -> Any:
        """Return the value of an expression in the page."""
        found = await self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    async def text(self, selector: str) -> str:
        """Return the text of an element."""
        return str(await self.value(f"document.querySelector({json.dumps(selector)})?.textContent ?? ''"))

    async def until(self, expression: str, seconds: float = 10.0) -> None:
        """Wait until an expression of the page is true."""
        until = time.monotonic() + seconds
        while not await self.value(f"Boolean({expression})"):
            assert time.monotonic() < until, f"never true: {expression}; complaints: {self.complaints}"
            await asyncio.sleep(0.01)

    async def press(self, code: str, key: str = "", hold: int = 1) -> None:
        """Press a key, by its place; `hold` is how often it repeats."""
        named = {"code": code, "key": key or code.removeprefix("Key").removeprefix("Digit").lower()}
        for repeat in range(hold):
            await self.call("Input.dispatchKeyEvent", type="rawKeyDown", autoRepeat=repeat > 0, **named)
        await self.call("Input.dispatchKeyEvent", type="keyUp", **named)

    async def picture(self, file: str | os.PathLike[str]) -> None:
        """Write a picture of the page."""
        found = await self.call("Page.captureScreenshot", format="png")
        Path(file).write_bytes(base64.b64decode(found["data"]))
