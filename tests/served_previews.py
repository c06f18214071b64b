"""The routes of the scene editor behind a web server like the host's, for tests that ask them."""

from __future__ import annotations

import asyncio
import threading
import time
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import asynccontextmanager
from typing import Any

import numpy as np
from aiohttp import ClientResponse, web
from aiohttp.test_utils import TestClient, TestServer
from physanimator.nodes.preview import PreviewBodies, PreviewStore, split_records
from physanimator.nodes.preview.routes import PreviewRoutes
from physanimator.physics.material import Material
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.scene import Body

__all__ = ["PATIENCE", "SCENE", "Served", "bodies", "in_a_server", "served"]

PATIENCE = 60.0
SCENE: dict[str, Any] = {
    "version": 2,
    "width": 100,
    "height": 80,
    "strokes": [{"path": [[0, 30], [100, 50]], "radius": 60, "speed": 200, "strength": 4}],
    "rig_points": [{"position": [20, 30], "region": {"type": "circle", "radius": 15}}],
}


def bodies(*, picture: bool = False, columns: int = 5, rows: int = 3) -> PreviewBodies:
    x, y = np.meshgrid(np.linspace(20, 60, columns), np.linspace(20, 40, rows))
    cell = np.array([[0, 1, columns], [1, columns + 1, columns]])
    cells = [cell + columns * row + column for row in range(rows - 1) for column in range(columns - 1)]
    triangles = np.concatenate(cells)
    mesh = TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), triangles, 100, 80)
    of_body = (Body(mesh, Material(youngs_modulus=10.0, damping=4.0)),)
    if not picture:
        return PreviewBodies(of_body)
    drawn = np.full((80, 100, 3), (40, 90, 200), np.uint8)
    hole = np.zeros((80, 100), np.uint8)
    drawn[20:40, 20:60], hole[20:40, 20:60] = (200, 20, 20), 255
    return PreviewBodies(of_body, drawn, hole)


class Served:
    """The routes on a server of their own.

    Attributes:
        routes: the routes.
        client: asks them.
        key: of bodies that they hold.
    """

    def __init__(self, routes: PreviewRoutes, client: TestClient[Any, Any], key: str) -> None:
        self.routes, self.client, self.key = routes, client, key

    def body(self, **changes: Any) -> dict[str, Any]:
        return {"editor": "one", "key": self.key, "scene": SCENE, "frames": 5} | changes

    async def ask(self, **changes: Any) -> ClientResponse:
        return await self.client.post("/physanimator/preview", json=self.body(**changes))

    async def stream(self, **changes: Any) -> list[tuple[int, bytes]]:
        answer = await self.ask(**changes)
        assert answer.status == 200, await answer.text()
        return split_records(await answer.read())

    async def idle(self) -> None:
        """Wait until nothing simulates any more: no run is left, and no thread of the pool has work."""
        end = time.monotonic() + PATIENCE
        while len(self.routes.runs):
            assert time.monotonic() < end
            await asyncio.sleep(0.01)
        loop, gate = asyncio.get_running_loop(), threading.Barrier(self.routes.threads._max_workers)
        waits = [loop.run_in_executor(self.routes.threads, gate.wait, PATIENCE) for _ in range(gate.parties)]
        await asyncio.gather(*waits)


@asynccontextmanager
async def served(stored: PreviewBodies | None = None) -> AsyncIterator[Served]:
    store = PreviewStore()
    key = store.put(stored or bodies())
    routes, table, app = PreviewRoutes(store), web.RouteTableDef(), web.Application()
    routes.register(table)
    app.add_routes(table)
    async with TestClient(TestServer(app)) as client:
        yield Served(routes, client, key)
    routes.close()


def in_a_server(test: Callable[[Served], Awaitable[None]], stored: PreviewBodies | None = None) -> None:
    async def run() -> None:
        async with served(stored) as server:
            await test(server)
            await server.idle()

    asyncio.run(run())
