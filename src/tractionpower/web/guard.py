"""Who may talk to the driving page: this machine only, under its own address, with the key of this run.

The server listens on loopback. That alone does not keep other pages out: a page of another site may open a WebSocket to
127.0.0.1, and a name of another site may be made to resolve to 127.0.0.1 (DNS rebinding). So the address in the request must
be that of the server, its origin too where a browser tells it, and the page and its WebSocket want a key made at random.
"""

from __future__ import annotations

import hmac
import secrets
from dataclasses import dataclass, field

from aiohttp import web
from aiohttp.typedefs import Handler, Middleware

LOOPBACK = "127.0.0.1"

NAMES = (LOOPBACK, "localhost")
"""Names under which the server may be called."""


def _new_key() -> str:
    return secrets.token_urlsafe(24)


@dataclass(frozen=True, slots=True)
class Guard:
    """What a request must bring.

    Attributes
    ----------
    port
        Port on which the server listens.
    key
        Secret of this run, part of the address of the page.
    """

    port: int
    key: str = field(default_factory=_new_key, repr=False)

    @property
    def address(self) -> str:
        """Address of the page, with its key."""
        return f"http://{LOOPBACK}:{self.port}/?key={self.key}"

    @property
    def hosts(self) -> frozenset[str]:
        """What the head ``Host`` may say."""
        return frozenset(f"{name}:{self.port}" for name in NAMES)

    def refusal(self, request: web.BaseRequest) -> str | None:
        """Return why a request is refused, by its address and its origin; None when it is not."""
        if request.headers.get("Host", "").lower() not in self.hosts:
            return "this server answers under its own address only"
        origins = request.headers.getall("Origin", [])
        if any(origin.lower() not in {f"http://{host}" for host in self.hosts} for origin in origins):
            return "this server answers its own page only"
        return None

    def knows(self, request: web.BaseRequest) -> bool:
        """Return whether a request brings the key."""
        given = request.query.get("key", "")
        return hmac.compare_digest(given.encode("utf-8", "surrogatepass"), self.key.encode())

    def heads(self) -> dict[str, str]:
        """Return the heads of every answer: nothing from elsewhere, in no frame, not kept."""
        sockets = " ".join(f"ws://{host}" for host in sorted(self.hosts))
        policy = {
            "default-src": "'none'",
            "script-src": "'self'",
            "style-src": "'self'",
            "img-src": "'self'",
            "connect-src": f"'self' {sockets}",
            "base-uri": "'none'",
            "form-action": "'none'",
            "frame-ancestors": "'none'",
        }
        return {
            "Content-Security-Policy": "; ".join(f"{key} {value}" for key, value in policy.items()),
            "X-Content-Type-Options": "nosniff",
            "Referrer-Policy": "no-referrer",
            "Cross-Origin-Opener-Policy": "same-origin",
            "Cross-Origin-Resource-Policy": "same-origin",
            "Cache-Control": "no-store",
        }


def guarded(guard: Guard) -> Middleware:
    """Return what refuses every request that is not from this machine's own page, before anything else looks at it."""

    @web.middleware
    async def check(request: web.Request, handler: Handler) -> web.StreamResponse:
        refusal = guard.refusal(request)
        if refusal is not None:
            return web.Response(status=403, text=f"{refusal}\n", headers=guard.heads())
        return await handler(request)

    return check
