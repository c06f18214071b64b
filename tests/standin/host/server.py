"""The host's server as far as nodes know it: routes, messages, the running prompt, and who asks when one is posted."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from aiohttp import web


class _PromptQueue:
    def __init__(self) -> None:
        self.running: list[tuple[Any, ...]] = []

    def get_current_queue_volatile(self):
        return list(self.running), []


class PromptServer:
    instance: PromptServer

    def __init__(self, loop) -> None:
        self.routes = web.RouteTableDef()
        self.prompt_queue = _PromptQueue()
        self.client_id: str | None = "stand-in"
        self.messages: list[tuple[str, Any]] = []
        self.on_prompt_handlers: list[Callable[[Any], Any]] = []

    def add_on_prompt_handler(self, handler):
        self.on_prompt_handlers.append(handler)

    def send_sync(self, event, data, sid=None):
        self.messages.append((event, data))


PromptServer.instance = PromptServer(None)
