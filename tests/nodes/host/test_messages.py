"""What nodes tell the person at the browser, with stand-ins for the host's server."""

from __future__ import annotations

import logging
import sys
import types
from typing import Any, NamedTuple

import numpy as np
import pytest
from physanimator.nodes.host import messages, running


class Node(NamedTuple):
    prompt_id: str
    node_id: str


class Queue:
    def __init__(self, *items: Any) -> None:
        self.items = list(items)

    def get_current_queue_volatile(self) -> tuple[list[Any], list[Any]]:
        return self.items, []


class Server:
    def __init__(self, client: str | None, *items: Any) -> None:
        self.client_id, self.prompt_queue = client, Queue(*items)
        self.sent: list[Any] = []
        self.handlers: list[Any] = []

    def send_sync(self, *message: Any) -> None:
        self.sent.append(message)

    def add_on_prompt_handler(self, handler: Any) -> None:
        self.handlers.append(handler)


class Simulate:
    @classmethod
    def define_schema(cls) -> Any:
        return types.SimpleNamespace(display_name="Simulate")


def host(patch: pytest.MonkeyPatch, server: Server, node: Node | None) -> Server:
    patch.setitem(sys.modules, "server", types.SimpleNamespace(PromptServer=types.SimpleNamespace(instance=server)))
    utils = types.ModuleType("comfy_execution.utils")
    utils.get_executing_context = lambda: node  # type: ignore[attr-defined]
    patch.setitem(sys.modules, "comfy_execution", types.ModuleType("comfy_execution"))
    patch.setitem(sys.modules, "comfy_execution.utils", utils)
    return server


def test_sentences_reach_the_browser_that_asked_the_log_and_the_history(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    server = host(monkeypatch, Server("me"), Node("p", "7:3"))
    with caplog.at_level(logging.WARNING):
        told = messages.tell_user(Simulate, ["one", "two", "one"])
    assert told == {"advice": ["one", "two"]}
    assert server.sent == [(messages.EVENT, {"node": "7:3", "title": "Simulate", "sentences": ["one", "two"]}, "me")]
    assert "PhysAnimator, Simulate: two" in caplog.text


def test_without_a_browser_nobody_else_s_is_written_to(monkeypatch: pytest.MonkeyPatch) -> None:
    server = host(monkeypatch, Server(None), Node("p", "7"))
    assert messages.tell_user(Simulate, ["one"]) == {"advice": ["one"]}
    assert messages.tell_user(Simulate, []) == {}
    assert server.sent == []


def test_pixel_art_is_told_how_it_stays_hard(monkeypatch: pytest.MonkeyPatch) -> None:
    server = host(monkeypatch, Server("me"), Node("p", "7"))
    smooth = np.linspace(0, 1, 64 * 64 * 3, dtype=np.float32).reshape(64, 64, 3)
    assert messages.hint_of_pixel_art(Simulate, smooth) == {}
    told = messages.hint_of_pixel_art(Simulate, np.round(smooth * 2) / 2)
    assert told["advice"][0].endswith("pixel_art keeps its pixels hard")
    assert server.sent[0][1]["sentences"] == told["advice"]


def test_what_was_told_is_joined() -> None:
    assert messages.all_told({}, {"advice": ["one"]}, {"advice": ["two"]}) == {"advice": ["one", "two"]}
    assert messages.all_told({}, {}) == {}


def test_links_of_the_node_that_runs_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    prompt = {"1": {"inputs": {}}, "2": {"inputs": {"a": ["1", 1], "b": 3}}, "3": {"inputs": {"a": [["1", 2]]}}}
    host(monkeypatch, Server("me", (0, "other", {}), (1, "p", prompt)), Node("p", "1"))
    assert running.is_linked(1) is True
    assert running.is_linked(0) is False
    assert running.is_linked(2) is False  # a value that looks like no link
    host(monkeypatch, Server("me", (1, "p", prompt)), Node("p", "1.0.0.5"))
    assert running.is_linked(1) is None  # made during the run
    host(monkeypatch, Server("me"), Node("p", "1"))
    assert running.is_linked(1) is None


def test_the_prompt_that_is_being_checked_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    server = host(monkeypatch, Server("me"), Node("p", "2"))
    running.watch_prompts()
    running.watch_prompts()
    (handler,) = server.handlers
    posted = {"prompt": {"2": {"inputs": {"renderer": "nothing"}}}}
    assert handler(posted) is posted
    assert running.sent_inputs() == {"renderer": "nothing"}
    handler({"number": 3})
    assert running.sent_inputs() is None
