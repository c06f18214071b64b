"""Where bodies are held, as the editor's page takes it: pins for each body, in the form of a scene document."""

from __future__ import annotations

from typing import Any, get_args

from ...physics.document import encode
from ...physics.errors import require
from ...physics.scene import Held, Scene, pins
from .store import PreviewBodies

__all__ = ["FOUND", "found_holds", "holds_of_bodies"]

FOUND = "found"
"""Stands for where each body is found to be held by itself."""


def holds_of_bodies(scene: Scene, count: int) -> list[dict[str, Any]]:
    """The first rig points of a scene, by the bodies that they hold."""
    held: dict[int, list[Any]] = {}
    for point in scene.rig_points[:count]:
        held.setdefault(point.body, []).append(_plain(point))
    return [_entry(number, scene.bodies[number].name, points) for number, points in held.items()]


def found_holds(stored: PreviewBodies, attach: str) -> list[dict[str, Any]]:
    """Pins for each body.

    Args:
        stored: the bodies.
        attach: where to hold them; ``FOUND`` for where each is found to be held.

    Raises:
        InvalidInputError: there is no such side.
    """
    sides = (FOUND, *get_args(Held))
    require("attach", attach, attach in sides, f"one of {', '.join(sides)}")
    entries = []
    own = stored.attachments or ("auto",) * len(stored.bodies)
    for number, (body, held) in enumerate(zip(stored.bodies, own, strict=True)):
        points = pins(body, number, attach=held if attach == FOUND else attach)
        entries.append(_entry(number, body.name, [_plain(point) for point in points]))
    return entries


def _entry(number: int, name: str, points: list[Any]) -> dict[str, Any]:
    return {"body": number, "name": name, "points": points}


def _plain(point: Any) -> dict[str, Any]:
    """A pin without what is the same for all."""
    return {"position": encode(point.position), "region": encode(point.region)}
