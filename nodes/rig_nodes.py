"""Rig points: what is held, swung or led."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any

from comfy_api.latest import io

from ..physics.document import parse_polyline
from ..physics.limits import MAX_BODIES
from ..physics.rig import Combined, Pinned, RigMotion
from ..physics.rig import RigPoint as PhysicalRigPoint
from .host import PATH_FORMS, refusal
from .host.field_inputs import input_of
from .host.wires import RigWire
from .rig_inputs import (
    OPTIONAL_INPUTS,
    motion_of,
    motion_options,
    region_of,
    region_options,
    squash_of,
    squash_options,
    turn_of,
    turn_options,
)

__all__ = ["RigPoint"]

_PARTS: dict[str, Callable[[dict[str, Any] | None], Any]] = {
    "region": region_of,
    "motion": motion_of,
    "turn": turn_of,
    "squash": squash_of,
}


class RigPoint(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_RigPoint",
            display_name="Rig Point (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Holds a region of a body still, swings it, leads it along a path, turns it or squashes it.",
            inputs=[
                io.String.Input(
                    "position",
                    default="[[640, 120]]",
                    tooltip=f"Where it is, in pixels {PATH_FORMS} Several points make several equal rig points.",
                ),
                io.DynamicCombo.Input(
                    "region",
                    options=region_options(),
                    tooltip="What follows the rig point: a circle around it, a polygon, or what a mask covers.",
                ),
                io.DynamicCombo.Input(
                    "motion",
                    options=motion_options(),
                    tooltip="pinned holds the region as drawn, wave swings it, path leads it along keyed points.",
                ),
                io.Int.Input(
                    "body",
                    default=-1,
                    min=-1,
                    max=MAX_BODIES - 1,
                    tooltip="Number of the body it acts on, counted from 0 along the chain; -1 is every body.",
                ),
                io.DynamicCombo.Input(
                    "turn",
                    options=turn_options(),
                    optional=True,
                    tooltip="Turns the region about the rig point: swing to and fro, rotation by keyed angles.",
                ),
                io.DynamicCombo.Input(
                    "squash",
                    options=squash_options(),
                    optional=True,
                    tooltip="Squashes and stretches the region about the rig point: pulse to and fro, squash by keys.",
                ),
                input_of(PhysicalRigPoint, "falloff", optional=True),
                RigWire.Input("rig_points", optional=True, tooltip="Rig points that act besides this one."),
            ],
            outputs=[
                RigWire.Output(display_name="rig_points", tooltip="The rig points before this one, and this one.")
            ],
        )

    @classmethod
    def validate_inputs(
        cls,
        position: str | None = None,
        region: dict[str, Any] | None = None,
        motion: dict[str, Any] | None = None,
        turn: dict[str, Any] | None = None,
        squash: dict[str, Any] | None = None,
        **others: Any,
    ) -> bool | str:
        # The host hands over the inputs that a choice brings only to a function that takes every input.
        checks: list[Callable[[], Any]] = []
        if position is not None:
            checks.append(lambda: parse_polyline(position, name="position"))
        for name, choice in {"region": region, "motion": motion, "turn": turn, "squash": squash}.items():
            if None not in [value for key, value in (choice or {}).items() if key not in OPTIONAL_INPUTS]:
                checks.append(partial(_PARTS[name], choice))
        return refusal(*checks)

    @classmethod
    def execute(
        cls,
        position: str,
        body: int,
        falloff: float = PhysicalRigPoint.falloff,
        region: dict[str, Any] | None = None,
        motion: dict[str, Any] | None = None,
        turn: dict[str, Any] | None = None,
        squash: dict[str, Any] | None = None,
        rig_points: tuple[PhysicalRigPoint, ...] = (),
    ) -> io.NodeOutput:
        places = parse_polyline(position, name="position")
        follows, moves = region_of(region), _together(motion_of(motion), turn_of(turn), squash_of(squash))
        made = [PhysicalRigPoint(place, follows, moves, None if body < 0 else body, falloff) for place in places]
        return io.NodeOutput((*rig_points, *made))


def _together(*motions: RigMotion | None) -> RigMotion:
    moving = tuple(motion for motion in motions if not isinstance(motion, Pinned | None))
    return Combined(moving) if len(moving) > 1 else moving[0] if moving else Pinned()
