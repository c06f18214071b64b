"""Routes of the host's server for the scene editor: meshes, and live previews by the real solver.

Requests come from whoever reaches the server: only the host's own pages may use the routes, nothing in a request names
a file, everything has a limit, and a simulation never runs on the thread that answers.
"""

from __future__ import annotations

import asyncio
import functools
import logging
from collections.abc import Awaitable, Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from aiohttp import web

from ..physics.errors import PhysAnimatorError
from ..physics.preview_limits import MAX_EDITORS, MAX_REQUEST_BYTES
from ..physics.preview_records import encode_mesh
from ..physics.preview_requests import PreviewRequest, is_key, preview_scene, read_request
from ..physics.preview_session import PreviewRun, PreviewRuns, RecordQueue, stream
from ..physics.preview_store import PreviewBodies, PreviewStore
from .preview_plates import Plates

__all__ = ["PreviewRoutes"]

Handler = Callable[[web.Request], Awaitable[web.StreamResponse]]

_FORGOTTEN = "The server does not hold these bodies any more: run the graph once, then edit on."
_BUSY = "The server is busy with other previews: try again in a moment."
_BODY_SECONDS = 10.0
_POLL_SECONDS = 0.25
_MOST_REQUESTS = 16
_KEEP_NOTHING = {"Cache-Control": "no-store", "X-Content-Type-Options": "nosniff"}


class PreviewRoutes:
    """The routes over one store of bodies.

    Attributes:
        store: the bodies that previews can be made of.
        runs: the simulations that are under way.
        threads: on which requests are checked and simulated.
    """

    def __init__(self, store: PreviewStore) -> None:
        self.store = store
        self.runs = PreviewRuns()
        self._under_way = 0
        self._plates = Plates()
        # One thread for each editor's simulation and one for the one that it supersedes, and two for checking.
        self.threads = ThreadPoolExecutor(2 * MAX_EDITORS + 2, thread_name_prefix="physanimator-preview")

    def register(self, routes: web.RouteTableDef) -> None:
        """Add the routes to a table such as the host's."""
        routes.get("/physanimator/mesh/{key}")(self._guarded(self.mesh))
        routes.get("/physanimator/plate/{key}")(self._guarded(self.plate))
        routes.post("/physanimator/preview")(self._guarded(self.preview))

    def close(self) -> None:
        """Let the threads end once they have nothing to do."""
        self.threads.shutdown(wait=False)
        self._plates.close()

    async def mesh(self, request: web.Request) -> web.StreamResponse:
        """The rest shape of the bodies of a key, as ``physics.preview_records`` describes it."""
        stored = self._stored(request)
        if stored is None:
            return _refused(404, _FORGOTTEN)
        body = await self._on_a_thread(encode_mesh, stored)
        return web.Response(body=body, content_type="application/octet-stream", headers=_KEEP_NOTHING)

    async def plate(self, request: web.Request) -> web.StreamResponse:
        """The picture of a key without its bodies, as PNG."""
        stored = self._stored(request)
        if stored is None:
            return _refused(404, _FORGOTTEN)
        if stored.picture is None:
            return _refused(409, "Connect the illustration to image: a clean plate is made from it.")
        return web.Response(body=await self._plates.png(stored), content_type="image/png", headers=_KEEP_NOTHING)

    async def preview(self, request: web.Request) -> web.StreamResponse:
        """A scene over the bodies of a key, simulated and streamed frame by frame."""
        if request.content_type != "application/json":
            return _refused(415, "The request must have the content type application/json.")
        body = await _body_of(request)
        if body is None:
            return _refused(413, f"The scene must be at most {MAX_REQUEST_BYTES >> 20} MB of text.")
        wanted: PreviewRequest = await self._on_a_thread(read_request, body)
        stored = self.store.get(wanted.key)
        if stored is None:
            return _refused(404, _FORGOTTEN)
        scene, frames = await self._on_a_thread(preview_scene, wanted, stored.bodies)
        run = self.runs.enter(wanted.editor)
        if run is None:
            return _refused(429, _BUSY)
        try:
            return await self._streamed(request, run, functools.partial(stream, scene, frames, run))
        finally:
            run.cancel("The editor is gone.")
            self.runs.leave(run)

    def _stored(self, request: web.Request) -> PreviewBodies | None:
        key = request.match_info["key"]
        return self.store.get(key) if is_key(key) else None

    async def _streamed(
        self, request: web.Request, run: PreviewRun, simulate: Callable[[RecordQueue], None]
    ) -> web.StreamResponse:
        response = web.StreamResponse(headers=_KEEP_NOTHING)
        response.content_type = "application/octet-stream"
        await response.prepare(request)
        loop, filled = asyncio.get_running_loop(), asyncio.Event()
        queue = RecordQueue(lambda: _wake(loop, filled))
        simulating = loop.run_in_executor(self.threads, simulate, queue)
        closed = False
        while not closed and not _is_gone(request):
            filled.clear()
            data, closed = queue.take()
            if data:
                await response.write(data)
            elif not closed:
                await _woken(filled)
        if closed:
            await _ended(simulating)
            await response.write_eof()
        return response

    def _guarded(self, handler: Handler) -> Handler:
        """The handler for the host's own pages alone, not too often at once, and with every error as a sentence."""

        async def answer(request: web.Request) -> web.StreamResponse:
            if not _is_own_page(request):
                return _refused(403, "Only the host's own pages may use this.")
            if self._under_way >= _MOST_REQUESTS:
                return _refused(429, _BUSY)
            self._under_way += 1
            try:
                return await handler(request)
            except PhysAnimatorError as error:
                return _refused(422, str(error))
            except ConnectionError:  # nobody is there to be answered
                return web.Response(status=499)
            except Exception:
                logging.exception("PhysAnimator: a request of the scene editor has failed")
                return _refused(500, "This has failed on the server; its log tells more.")
            finally:
                self._under_way -= 1

        return answer

    async def _on_a_thread(self, call: Callable[..., Any], *arguments: Any) -> Any:
        return await asyncio.get_running_loop().run_in_executor(self.threads, functools.partial(call, *arguments))


async def _ended(simulating: asyncio.Future[None]) -> None:
    """Wait for a simulation whose last record has been taken; what went wrong has gone out with that."""
    try:
        await simulating
    except Exception:
        logging.exception("PhysAnimator: a preview has failed")


def _wake(loop: asyncio.AbstractEventLoop, filled: asyncio.Event) -> None:
    try:
        loop.call_soon_threadsafe(filled.set)
    except RuntimeError:  # the server has stopped
        logging.debug("PhysAnimator: a preview has outlived its server")


async def _woken(filled: asyncio.Event) -> None:
    """Wait for the event, but no longer than it may take to notice that nobody listens any more."""
    try:
        await asyncio.wait_for(filled.wait(), _POLL_SECONDS)
    except asyncio.TimeoutError:
        return


async def _body_of(request: web.Request) -> bytes | None:
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


def _is_gone(request: web.Request) -> bool:
    return request.transport is None or request.transport.is_closing()


def _is_own_page(request: web.Request) -> bool:
    """Whether a request comes from a page of this server, or from no page at all."""
    site = request.headers.get("Sec-Fetch-Site")
    if site is not None:  # the browser's own word, which holds behind a proxy too that changes the Host
        return site in ("same-origin", "none")
    origin = request.headers.get("Origin")
    host = request.headers.get("Host", "").lower()
    return origin is None or origin.lower() in (f"http://{host}", f"https://{host}")


def _refused(status: int, sentence: str) -> web.Response:
    return web.json_response({"error": sentence}, status=status, headers=_KEEP_NOTHING)
