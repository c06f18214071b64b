"""The routes find the host's server where there is one, once, and nothing happens where there is none."""

from __future__ import annotations

import sys
import threading
from types import SimpleNamespace

import pytest
from aiohttp import web
from physanimator.nodes.preview import server


@pytest.fixture(autouse=True)
def unregistered() -> None:
    server._registered.clear()


@pytest.mark.parametrize("module", [None, SimpleNamespace(), SimpleNamespace(PromptServer=SimpleNamespace())])
def test_without_a_host_nothing_happens(module: object, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "server", module)
    server.register_routes()
    assert not server._registered.is_set()


def test_a_host_gets_the_routes_once(monkeypatch: pytest.MonkeyPatch) -> None:
    table = web.RouteTableDef()
    host = SimpleNamespace(PromptServer=SimpleNamespace(instance=SimpleNamespace(routes=table)))
    monkeypatch.setitem(sys.modules, "server", host)
    for _ in range(2):
        server.register_routes()
    paths = [(route.method, route.path) for route in table if isinstance(route, web.RouteDef)]
    assert paths == [
        ("GET", "/physanimator/mesh/{key}"),
        ("GET", "/physanimator/plate/{key}"),
        ("GET", "/physanimator/layer/{key}/{number}"),
        ("GET", "/physanimator/holds/{key}/{attach}"),
        ("POST", "/physanimator/preview"),
        ("GET", "/physanimator/example"),
        ("GET", "/physanimator/artwork"),
        ("POST", "/physanimator/pick"),
        ("POST", "/physanimator/warm-up"),
    ]


def test_the_solver_is_readied_once_and_its_contact_only_where_bodies_may_touch(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    warmed: list[bool] = []
    monkeypatch.setattr("physanimator.nodes.preview.session.warm_up", lambda *, contact: warmed.append(contact))
    monkeypatch.setattr(server, "_warmed", {kind: threading.Event() for kind in (False, True)})
    for contact in (False, False, True, True, False):
        server.start_warm_up(contact=contact)
        for thread in threading.enumerate():
            if thread.name == "physanimator-warm-up":
                thread.join()
    assert warmed == [False, True]
