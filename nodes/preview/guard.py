"""Who may use the routes of the scene editor, and how they are told that they may not."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Awaitable, Callable

from aiohttp import web

from ...physics.errors import PhysAnimatorError
from ..host import with_known_places
from .hosts import HOSTS_VARIABLE, Authority, authority_of, is_own_name, origin_of, told_origin
from .limits import MAX_REQUEST_BYTES

__all__ = ["BUSY", "KEEP_NOTHING", "Guard", "body_of", "hung_up", "refused"]

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]

BUSY = "The server is busy with other previews: try again in a moment."
KEEP_NOTHING = {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff"}
UNREADABLE = "The body of the request cannot be read: it is not what its Content-Encoding says."
_UNKNOWN_NAME = (
    "The scene editor does not answer under this name, which could be a foreign page's: open the host under localhost,"
    f" under its address or a name given to --listen, or name it in the environment variable {HOSTS_VARIABLE}."
)
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
            if not _has_own_name(request):
                return refused(403, _UNKNOWN_NAME)
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
        return refused(422, with_known_places(str(error)))
    except UnreadableBody:
        return await hung_up(request, refused(400, UNREADABLE))
    except web.HTTPException:  # says itself what is wrong
        raise
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


async def hung_up(request: web.Request, answer: web.StreamResponse) -> web.StreamResponse:
    """An answer after which the rest of a packed body is not read: the server would go on unpacking it."""
    if request.headers.get("Content-Encoding") is not None:
        answer.force_close()
        await answer.prepare(request)
        await answer.write_eof()
        if request.transport is not None:
            request.transport.close()
    return answer


class UnreadableBody(Exception):
    """A body is not compressed in the way that its headers say."""


async def body_of(request: web.Request) -> bytes | None:
    """The body of a request, or None when it is too large or too slow.

    A compressed body is unpacked while it is read, and no further than to the limit.

    Raises:
        UnreadableBody: it is compressed in another way than its headers say.
        ConnectionError: nobody is there any more.
    """
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
    except ConnectionError:
        raise
    except Exception as error:  # versions of the server tell a damaged body by errors of different kinds
        raise UnreadableBody from error


def _is_own_page(request: web.Request) -> bool:
    """Whether a request comes from a page of this server, or from no page at all."""
    sites, origins = request.headers.getall("Sec-Fetch-Site", []), request.headers.getall("Origin", [])
    if len(sites) > 1 or len(origins) > 1:
        return False
    if origins and told_origin() not in ("", "*") and origins[0].lower() == told_origin():
        return True
    if sites == ["same-origin"]:  # the browser's own word, which holds behind a proxy too that changes the Host
        return True
    if sites and sites != ["none"]:
        return False
    return not origins or _is_own_origin(request, origins[0])


def _is_own_origin(request: web.Request, text: str) -> bool:
    """Whether an origin names the host as the request does."""
    origin, host = origin_of(text), _host_of(request)
    if origin is None or host is None:
        return False
    scheme, named = origin
    return named == Authority(host.name, host.port or (443 if scheme == "https" else 80))


def _has_own_name(request: web.Request) -> bool:
    """Whether the host is asked under a name of its own."""
    host = _host_of(request)
    return host is not None and (is_own_name(host.name) or _is_vouched_for(request))


def _is_vouched_for(request: web.Request) -> bool:
    """Whether a browser says that its page is of the same origin, and came encrypted.

    A foreign page that has its name point to this machine has no certificate for it here.
    """
    page = request.headers.get("Origin") or request.headers.get("Referer", "")
    encrypted = page.lower().startswith("https://")
    origin = "/".join(page.split("/")[:3])
    return encrypted and request.headers.get("Sec-Fetch-Site") == "same-origin" and _is_own_origin(request, origin)


def _host_of(request: web.Request) -> Authority | None:
    hosts = request.headers.getall("Host", [])
    return authority_of(hosts[0]) if len(hosts) == 1 else None
