"""Rig points: what is held, swung or led."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from comfy_api.latest import io

from ..physics.rig import Circle, KeyedPath, MaskRegion, Pinned, Polygon, RigMotion, RigRegion, Wave
from ..physics.rig import RigPoint as PhysicalRigPoint
from ..rendering.points import parse_polyline
from .literals import PATH_FORMS, chosen, refusal, times_of
from .tensors import mask_of
from .wires import RigWire

__all__ = ["RigPoint"]

_REGIONS = ("circle", "polygon", "mask")
_MOTIONS = ("pinned", "wave", "path")


class RigPoint(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_RigPoint",
            display_name="Rig Point",
            category="PhysAnimator/scene",
            description="Holds a region of a body still, swings it, or leads it along a path.",
            inputs=[
                io.String.Input(
                    "position",
                    default="[[640, 120]]",
                    tooltip=f"Where it is, in pixels {PATH_FORMS} Several points make several equal rig points.",
                ),
                io.DynamicCombo.Input(
                    "region",
                    options=_region_options(),
                    tooltip="What follows the rig point: a circle around it, a polygon, or what a mask covers.",
                ),
                io.DynamicCombo.Input(
                    "motion",
                    options=_motion_options(),
                    tooltip="pinned holds the region as drawn, wave swings it, path leads it along keyed points.",
                ),
                io.Int.Input(
                    "body",
                    default=-1,
                    min=-1,
                    max=4095,
                    tooltip="Number of the body it acts on, counted from 0 along the chain; -1 is every body.",
                ),
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
        **others: Any,
    ) -> bool | str:
        # The host hands over the inputs that a choice brings only to a function that takes every input.
        checks: list[Callable[[], Any]] = [
            lambda: chosen(region, "region", _REGIONS),
            lambda: chosen(motion, "motion", _MOTIONS),
        ]
        if position is not None:
            checks.append(lambda: parse_polyline(position, name="position"))
        if None not in (region or {}).values():
            checks.append(lambda: _region(region))
        if None not in (motion or {}).values():
            checks.append(lambda: _motion(motion))
        return refusal(*checks)

    @classmethod
    def execute(
        cls,
        position: str,
        body: int,
        region: dict[str, Any] | None = None,
        motion: dict[str, Any] | None = None,
        rig_points: tuple[PhysicalRigPoint, ...] = (),
    ) -> io.NodeOutput:
        places = parse_polyline(position, name="position")
        follows, moves = _region(region), _motion(motion)
        made = [PhysicalRigPoint(place, follows, moves, None if body < 0 else body) for place in places]
        return io.NodeOutput((*rig_points, *made))


def _region_options() -> list[io.DynamicCombo.Option]:
    radius = PhysicalRigPoint.region.radius
    return [
        io.DynamicCombo.Option(
            "circle",
            [
                io.Float.Input(
                    "radius",
                    default=radius,
                    min=0.5,
                    max=16384.0,
                    step=1.0,
                    display_name="radius",
                    tooltip="What lies within this distance follows [px].",
                )
            ],
        ),
        io.DynamicCombo.Option(
            "polygon",
            [
                io.String.Input(
                    "points",
                    default="[[600, 80], [680, 80], [680, 160], [600, 160]]",
                    display_name="points",
                    tooltip=f"Corners of the region in pixels {PATH_FORMS}",
                )
            ],
        ),
        io.DynamicCombo.Option("mask", [io.Mask.Input("mask", display_name="mask", tooltip="What it covers follows.")]),
    ]


def _motion_options() -> list[io.DynamicCombo.Option]:
    wave = Wave()
    return [
        io.DynamicCombo.Option("pinned", []),
        io.DynamicCombo.Option(
            "wave",
            [
                io.Float.Input(
                    "amplitude",
                    default=wave.amplitude,
                    min=-16384.0,
                    max=16384.0,
                    step=1.0,
                    display_name="amplitude",
                    tooltip="How far it swings to either side [px].",
                ),
                io.Float.Input(
                    "period",
                    default=wave.period,
                    min=0.05,
                    max=3600.0,
                    step=0.1,
                    display_name="period",
                    tooltip="Time of one swing forth and back [s].",
                ),
                io.Float.Input(
                    "angle",
                    default=0.0,
                    min=-360.0,
                    max=360.0,
                    step=5.0,
                    display_name="angle",
                    tooltip="Where it swings to first [degrees]: 0 to the right, 90 up.",
                ),
            ],
        ),
        io.DynamicCombo.Option(
            "path",
            [
                io.String.Input(
                    "points",
                    default="[[640, 120], [700, 120]]",
                    display_name="points",
                    tooltip=f"Keys in pixels {PATH_FORMS} The region moves by the difference to the first.",
                ),
                io.String.Input(
                    "times",
                    default="[0, 1]",
                    display_name="times",
                    tooltip="When it is at each key, as a list of rising seconds [s]; empty means one second apart.",
                ),
            ],
        ),
    ]


def _region(region: dict[str, Any] | None) -> RigRegion:
    kind, values = chosen(region, "region", _REGIONS)
    if kind == "circle":
        return Circle(values["radius"])
    if kind == "polygon":
        return Polygon(tuple(parse_polyline(values["points"], name="region points")))
    return MaskRegion(mask_of(values["mask"], name="region mask") >= 0.5)


def _motion(motion: dict[str, Any] | None) -> RigMotion:
    kind, values = chosen(motion, "motion", _MOTIONS)
    if kind == "pinned":
        return Pinned()
    if kind == "wave":
        radians = np.deg2rad(values["angle"])
        return Wave(values["amplitude"], values["period"], (float(np.cos(radians)), -float(np.sin(radians))))
    points = tuple(parse_polyline(values["points"], name="motion points"))
    return KeyedPath(times_of(values["times"], name="motion times") or tuple(map(float, range(len(points)))), points)
