"""Routes of the host's server for the scene editor: meshes, and live previews by the real solver.

Requests come from whoever reaches the server: only the host's own pages may use the routes, no request names a file but
a picture of the host's own folders or a layered file of its input folder, everything has a limit, and nothing is cut or
simulated on the thread that answers.
"""

from __future__ import annotations

import asyncio
import functools
import itertools
import logging
import re
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from aiohttp import web

from ...physics.errors import Cancelled, SimulationError
from ...physics.interruption import interruptible
from .artworks import flattened_png
from .guard import BUSY, KEEP_NOTHING, Guard, body_of, hung_up, refused
from .holds import found_holds
from .limits import MAX_EDITORS, MAX_REQUEST_BYTES
from .picking import Picker, read_pick
from .plates import Plates, png_of
from .queue import RecordQueue
from .records import encode_mesh
from .requests import PreviewRequest, document_points, is_key, preview_scene, read_request
from .session import PreviewRun, PreviewRuns, stream
from .store import PreviewBodies, PreviewStore
from .turns import Turns

__all__ = ["PreviewRoutes"]

_FORGOTTEN = "The server does not hold these bodies any more: run the graph once, then edit on."
_EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example" / "illustration.png"
_NUMBER = re.compile(r"[0-9]{1,4}")
_WRITE_SECONDS = 60.0
_POLL_SECONDS = 0.25
_CHECK_SECONDS = 20.0


class PreviewRoutes:
    """The routes over one store of bodies.

    Attributes:
        store: the bodies that previews can be made of.
        runs: the simulations that are under way.
        threads: on which requests are checked and simulated.
    """

    def __init__(self, store: PreviewStore, *, warm_up: Callable[[], None] = lambda: None) -> None:
        """
        Args:
            store: the bodies that previews can be made of.
            warm_up: gets the solver ready, without waiting for it.
        """
        self.store = store
        self._warm_up = warm_up
        self.runs = PreviewRuns()
        self._guard = Guard()
        self._order = itertools.count()
        self._plates = Plates()
        self._picker, self._turns = Picker(store, _EXAMPLE), Turns()
        self._one_artwork = asyncio.Lock()
        # One thread for each editor's simulation and one for the one that it supersedes, and two for checking.
        self.threads = ThreadPoolExecutor(2 * MAX_EDITORS + 2, thread_name_prefix="physanimator-preview")

    def register(self, routes: web.RouteTableDef) -> None:
        """Add the routes to a table such as the host's."""
        routes.get("/physanimator/mesh/{key}")(self._guard(self.mesh))
        routes.get("/physanimator/plate/{key}")(self._guard(self.plate))
        routes.get("/physanimator/layer/{key}/{number}")(self._guard(self.layer))
        routes.get("/physanimator/holds/{key}/{attach}")(self._guard(self.holds))
        routes.post("/physanimator/preview")(self._guard(self.preview))
        routes.get("/physanimator/example")(self._guard(self.example))
        routes.get("/physanimator/artwork")(self._guard(self.artwork))
        routes.post("/physanimator/pick")(self._guard(self.pick))
        routes.post("/physanimator/warm-up")(self._guard(self.warm_up))

    def close(self) -> None:
        """Let the threads end once they have nothing to do."""
        self.threads.shutdown(wait=False)
        self._plates.close()

    async def example(self, _request: web.Request) -> web.StreamResponse:
        """The illustration that comes with the pack, to draw on before its node has run."""
        return web.FileResponse(_EXAMPLE)

    async def artwork(self, request: web.Request) -> web.StreamResponse:
        """A layered file of the input folder as a picture, PNG; only one is read at a time, as they may be large."""
        async with self._one_artwork:
            body = await self._on_a_thread(_Patience(request), flattened_png, request.query.get("file", ""))
        return web.Response(body=body, content_type="image/png", headers=KEEP_NOTHING)

    async def warm_up(self, _request: web.Request) -> web.StreamResponse:
        """Get the solver ready: an editor has been opened, and its first preview shall not wait for that."""
        self._warm_up()
        return web.Response(status=204, headers=KEEP_NOTHING)

    async def mesh(self, request: web.Request) -> web.StreamResponse:
        """The rest shape of the bodies of a key, as ``physics.preview_records`` describes it."""
        stored = self._stored(request)
        if stored is None:
            return refused(404, _FORGOTTEN)
        body = await self._on_a_thread(_Patience(request), encode_mesh, stored)
        return web.Response(body=body, content_type="application/octet-stream", headers=KEEP_NOTHING)

    async def plate(self, request: web.Request) -> web.StreamResponse:
        """The picture of a key without its bodies, as PNG."""
        stored = self._stored(request)
        if stored is None:
            return refused(404, _FORGOTTEN)
        if stored.picture is None:
            return refused(409, "Connect the illustration to image: a clean plate is made from it.")
        return web.Response(body=await self._plates.png(stored), content_type="image/png", headers=KEEP_NOTHING)

    async def layer(self, request: web.Request) -> web.StreamResponse:
        """The picture of a layer of a key, as PNG, by its place among those that are shown."""
        stored, number = self._stored(request), request.match_info["number"]
        if stored is None or not _NUMBER.fullmatch(number) or int(number) >= len(stored.layers):
            return refused(404, _FORGOTTEN)
        body = await self._on_a_thread(_Patience(request), png_of, stored.layers[int(number)].pixels)
        return web.Response(body=body, content_type="image/png", headers=KEEP_NOTHING)

    async def holds(self, request: web.Request) -> web.StreamResponse:
        """Pins for the bodies of a key, as JSON: where each is found to be held, or at a side."""
        stored = self._stored(request)
        if stored is None:
            return refused(404, _FORGOTTEN)
        attach = request.match_info["attach"]
        return web.json_response(
            await self._on_a_thread(_Patience(request), found_holds, stored, attach), headers=KEEP_NOTHING
        )

    async def preview(self, request: web.Request) -> web.StreamResponse:
        """A scene over the bodies of a key, simulated and streamed frame by frame."""
        order = next(self._order)
        if request.content_type != "application/json":
            return refused(415, "The request must have the content type application/json.")
        body = await body_of(request)
        if body is None:
            return await hung_up(
                request, refused(413, f"The scene must be at most {MAX_REQUEST_BYTES >> 20} MB of text.")
            )
        check = _Patience(request)
        wanted: PreviewRequest = await self._on_a_thread(check, read_request, body)
        stored = self.store.get(wanted.key)
        if stored is None:
            return refused(404, _FORGOTTEN)
        scene, frames = await self._on_a_thread(check, preview_scene, wanted, stored.bodies, stored.layer_masks)
        points = document_points(wanted, scene)
        prepared = await self._on_a_thread(check, self.runs.prepare, scene)
        run = self.runs.enter(wanted.editor, order, prepared)
        if run is None:
            return refused(429, BUSY)
        try:
            return await self._streamed(request, run, functools.partial(stream, scene, frames, run, points=points))
        finally:
            run.cancel("The editor is gone.")
            self.runs.leave(run)

    async def pick(self, request: web.Request) -> web.StreamResponse:
        """The cut under the points of an editor, and what moves the parts; of an editor's requests the latest wins."""
        order = next(self._order)
        if request.content_type != "application/json":
            return refused(415, "The request must have the content type application/json.")
        body = await body_of(request)
        if body is None:
            return await hung_up(request, refused(413, f"At most {MAX_REQUEST_BYTES >> 20} MB can be asked at once."))
        patience = _Patience(request)
        wanted = await self._on_a_thread(patience, read_pick, body)
        async with self._turns.of(wanted.editor, order) as turn:
            found = await self._on_a_thread(_both(patience, turn.check), self._picker.answer, wanted)
        return web.json_response(found, headers=KEEP_NOTHING)

    def _stored(self, request: web.Request) -> PreviewBodies | None:
        key = request.match_info["key"]
        return self.store.get(key) if is_key(key) else None

    async def _streamed(
        self, request: web.Request, run: PreviewRun, simulate: Callable[[RecordQueue], None]
    ) -> web.StreamResponse:
        response = web.StreamResponse(headers=KEEP_NOTHING)
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
                await _sent(response, data)
            elif not closed:
                await _woken(filled)
        if closed:
            await _ended(simulating)
            await response.write_eof()
        return response

    async def _on_a_thread(self, check: Callable[[], None], call: Callable[..., Any], *arguments: Any) -> Any:
        """The result of a call, which is given up at its next checkpoint once ``check`` raises."""

        def checked() -> Any:
            check()
            with interruptible(check):
                return call(*arguments)

        return await asyncio.get_running_loop().run_in_executor(self.threads, checked)


class _Patience:
    """Ends what is prepared for a request when nobody waits for it any more, or when it takes too long."""

    def __init__(self, request: web.Request) -> None:
        self._request, self._end = request, time.monotonic() + _CHECK_SECONDS

    def __call__(self) -> None:
        """
        Raises:
            Cancelled: the client is gone.
            SimulationError: the time is over.
        """
        if _is_gone(self._request):
            raise Cancelled("The editor is gone.")
        if time.monotonic() > self._end:
            raise SimulationError(
                "This takes too long to prepare for a live preview; draw with fewer points, or queue the graph."
            )


def _both(*checks: Callable[[], None]) -> Callable[[], None]:
    """All checks as one."""

    def check() -> None:
        for each in checks:
            each()

    return check


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


async def _sent(response: web.StreamResponse, data: bytes) -> None:
    """Send, unless the client has not read for so long that it shall not keep others from simulating.

    Raises:
        ConnectionError: the client is gone or does not read.
    """
    try:
        await asyncio.wait_for(response.write(data), _WRITE_SECONDS)
    except asyncio.TimeoutError:
        raise ConnectionError("the client does not read") from None


def _is_gone(request: web.Request) -> bool:
    return request.transport is None or request.transport.is_closing()
