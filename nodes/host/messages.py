"""Sentences for the person at the browser, as a toast, beside the log and the history."""

from __future__ import annotations

import logging
from collections.abc import Iterable
from typing import Any

from .running import context, server
from .wording import in_users_words

__all__ = ["EVENT", "all_told", "hint_of_pixel_art", "send_to_page", "shown_with", "tell_user"]

EVENT = "physanimator.advice"
"""Name of the message that nodes/web/js/host/advice.js shows as a toast."""


def tell_user(node: Any, sentences: Iterable[str]) -> dict[str, list[str]]:
    """Show sentences of a node that is being executed, at once: before long work, not after it.

    The browser that queued the prompt shows them as toasts; the log has them too.

    Args:
        node: the node's class, as ``execute`` has it.
        sentences: what the user should know; none for nothing.

    Returns:
        What belongs into the node's ``ui``, so that the history has the sentences for programs that queue prompts:
        see :func:`shown_with`, or ``io.NodeOutput(..., ui=told or None)``. Empty without sentences.
    """
    told = list(dict.fromkeys(map(in_users_words, sentences)))
    if not told:
        return {}
    title = node.define_schema().display_name  # GET_SCHEMA would write to the class, which is locked by now
    for sentence in told:
        logging.warning("PhysAnimator, %s: %s", title.removesuffix(" (PhysAnimator)"), sentence)
    send_to_page(EVENT, {"title": title, "sentences": told})
    return {"advice": told}


def send_to_page(event: str, data: dict[str, Any]) -> None:
    """Let the browser that has queued the prompt know something of the node that is being executed, at once.

    Args:
        event: name of the message.
        data: what it holds; the node's id is added as "node".
    """
    host, running = server(), context()
    client = getattr(host, "client_id", None)
    if running is not None and client is not None:  # without a client it would reach every browser
        host.send_sync(event, {**data, "node": str(running.node_id)}, client)


def hint_of_pixel_art(node: Any, picture: Any) -> dict[str, list[str]]:
    """Tell of the input ``pixel_art`` where a picture looks like pixel art; returns what ``tell_user`` does.

    Args:
        node: the node's class, as ``execute`` has it; its input is off.
        picture: RGB or RGBA, shape [h, w, c].
    """
    from ...rendering.composite import pixel_art_hint

    return tell_user(node, pixel_art_hint(picture, option="pixel_art"))


def all_told(*told: dict[str, list[str]]) -> dict[str, list[str]]:
    """What several calls of ``tell_user`` have returned, as one."""
    sentences = [sentence for each in told for sentence in each.get("advice", [])]
    return {"advice": sentences} if sentences else {}


def shown_with(shown: Any, told: dict[str, list[str]]) -> dict[str, Any]:
    """A node's ``ui``: what it shows, and what it has told.

    Args:
        shown: one of the host's ``ui`` classes, such as PreviewImage.
        told: from ``tell_user``.
    """
    return {**shown.as_dict(), **told}
