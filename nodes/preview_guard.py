"""Who may use the routes of the scene editor, and how they are told that they may not."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable

from aiohttp import web

from ..physics.errors import PhysAnimatorError
from ..physics.preview_limits import MAX_REQUEST_BYTES

__all__ = ["BUSY", "KEEP_NOTHING", "Guard", "body_of", "refused"]

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]

BUSY = "The server is busy with other previews: try again in a moment."
KEEP_NOTHING = {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff"}
_BODY_SECONDS = 10.0
_MOST_REQUESTS = 16


class Guard:
    """Lets requests of the host's own pages through, not too many at once, and makes every error a sentence."""

    def __init__(self) -> None:
        self._under_way = 0

    def __call__(self, handler: Handler) -> Handler:
        """The handler behind the guard."""

        async def answer(request: web.Request) -> web.StreamResponse:
            if not _is_own_page(request):
                return refused(403, "Only the host's own pages may use this.")
            if self._under_way >= _MOST_REQUESTS:
                return refused(429, BUSY)
            self._under_way += 1
            try:
                return await _answered(handler, request)
            finally:
                self._under_way -= 1

        return answer


async def _answered(handler: Handler, request: web.Request) -> web.StreamResponse:
    try:
        return await handler(request)
    except PhysAnimatorError as error:
        return refused(422, str(error))
    except ConnectionError:  # nobody is there to be answered
        if request.transport is not None:
            request.transport.abort()
        return web.Response(status=499)
    except Exception:
        logging.exception("PhysAnimator: a request of the scene editor has failed")
        return refused(500, "This has failed on the server; its log tells more.")


def refused(status: int, sentence: str) -> web.Response:
    """An answer that says what is wrong."""
    return web.json_response({"error": sentence}, status=status, headers=KEEP_NOTHING)


async def body_of(request: web.Request) -> bytes | None:
    """The body of a request, or None when it is too large or too slow."""
    if (request.content_length or 0) > MAX_REQUEST_BYTES:
        return None

    async def read() -> bytes | None:
        body = bytearray()
        async for chunk in request.content.iter_any():
            body += chunk
            if len(body) > MAX_REQUEST_BYTES:
                return None
        return bytes(body)

    try:
        return await asyncio.wait_for(read(), _BODY_SECONDS)
    except asyncio.TimeoutError:
        return None


def _is_own_page(request: web.Request) -> bool:
    """Whether a request comes from a page of this server, or from no page at all."""
    site = request.headers.get("Sec-Fetch-Site")
    if site is not None:  # the browser's own word, which holds behind a proxy too that changes the Host
        return site in ("same-origin", "none")
    origin = request.headers.get("Origin")
    host = request.headers.get("Host", "").lower()
    return origin is None or origin.lower() in (f"http://{host}", f"https://{host}")
