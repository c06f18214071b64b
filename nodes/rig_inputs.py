"""What a rig point's dynamic combos bring: regions, ways, turns and squashes, as inputs and as physics."""

from __future__ import annotations

from typing import Any

import numpy as np
from comfy_api.latest import io

from ..physics.document import parse_polyline
from ..physics.rig import (
    Circle,
    KeyedPath,
    MaskRegion,
    Pinned,
    Polygon,
    Pulse,
    RigMotion,
    RigPoint,
    RigRegion,
    Rotation,
    Squash,
    Swing,
    Wave,
)
from .host import PATH_FORMS, chosen, mask_of, numbers_of, times_of
from .host.field_inputs import input_of

__all__ = [
    "OPTIONAL_INPUTS",
    "motion_of",
    "motion_options",
    "region_of",
    "region_options",
    "squash_of",
    "squash_options",
    "turn_of",
    "turn_options",
]

OPTIONAL_INPUTS = ("phase", "easing")
"""Inputs that a choice brings and that a prompt may leave out."""

_REGIONS = ("circle", "polygon", "mask")
_MOTIONS = ("pinned", "wave", "path")
_TURNS = ("none", "swing", "rotation")
_SQUASHES = ("none", "pulse", "squash")


def region_options() -> list[io.DynamicCombo.Option]:
    """What may follow a rig point."""
    radius = _input(Circle, "radius", default=RigPoint.region.radius)
    corners = "[[600, 80], [680, 80], [680, 160], [600, 160]]"
    points = _text("points", corners, f"Corners of the region in pixels {PATH_FORMS}")
    mask = io.Mask.Input("mask", display_name="mask", tooltip="What it covers follows.")
    return [
        io.DynamicCombo.Option("circle", [radius]),
        io.DynamicCombo.Option("polygon", [points]),
        io.DynamicCombo.Option("mask", [mask]),
    ]


def motion_options() -> list[io.DynamicCombo.Option]:
    """Where a rig point may go."""
    swinging = [
        _input(Wave, "amplitude"),
        _input(Wave, "period"),
        _angle(),
        _input(Wave, "phase"),
    ]
    keyed = [
        _text(
            "points",
            "[[640, 120], [700, 120]]",
            f"Keys in pixels {PATH_FORMS} The region moves by the difference to the first.",
        ),
        _times("[0, 1]"),
        _input(KeyedPath, "easing"),
    ]
    return [
        io.DynamicCombo.Option("pinned", []),
        io.DynamicCombo.Option("wave", swinging),
        io.DynamicCombo.Option("path", keyed),
    ]


def turn_options() -> list[io.DynamicCombo.Option]:
    """How a region may turn about its rig point."""
    swinging = [_input(Swing, name) for name in ("amplitude", "period", "phase")]
    keyed = [
        _text("angles", "[0, 20, 0]", "Keys as a list of angles [degrees], counterclockwise, relative to the first."),
        _times("[0, 0.5, 1]"),
        _input(Rotation, "easing"),
    ]
    return [
        io.DynamicCombo.Option("none", []),
        io.DynamicCombo.Option("swing", swinging),
        io.DynamicCombo.Option("rotation", keyed),
    ]


def squash_options() -> list[io.DynamicCombo.Option]:
    """How a region may be squashed about its rig point."""
    pulsing = [_input(Pulse, name) for name in ("stretch", "period", "phase", "angle", "keep_area")]
    keyed = [
        _text("factors", "[1, 0.8, 1.1, 1]", "Keys as a list of factors: above 1 is longer, relative to the first."),
        _times("[0, 0.2, 0.5, 0.8]"),
        _input(Squash, "angle"),
        _input(Squash, "keep_area"),
        _input(Squash, "easing"),
    ]
    return [
        io.DynamicCombo.Option("none", []),
        io.DynamicCombo.Option("pulse", pulsing),
        io.DynamicCombo.Option("squash", keyed),
    ]


def region_of(region: dict[str, Any] | None) -> RigRegion:
    """The region that was chosen; InvalidInputError where it is unusable."""
    kind, values = _chosen(region, "region", _REGIONS)
    if kind == "circle":
        return Circle(values["radius"])
    if kind == "polygon":
        return Polygon(tuple(parse_polyline(values["points"], name="region points")))
    return MaskRegion(mask_of(values["mask"], name="region mask") >= 0.5)


def motion_of(motion: dict[str, Any] | None) -> RigMotion:
    """The way that was chosen; InvalidInputError where it is unusable."""
    kind, values = _chosen(motion, "motion", _MOTIONS)
    if kind == "pinned":
        return Pinned()
    if kind == "wave":
        radians = np.deg2rad(values.pop("angle"))
        return Wave(direction=(float(np.cos(radians)), -float(np.sin(radians))), **values)
    points = tuple(parse_polyline(values["points"], name="motion points", offsets=True))
    times = times_of(values["times"], name="motion times") or _seconds(len(points))
    return KeyedPath(times, points, values.get("easing", KeyedPath.easing))


def turn_of(turn: dict[str, Any] | None) -> RigMotion | None:
    """The turn that was chosen, None for none; InvalidInputError where it is unusable."""
    kind, values = _chosen(turn, "turn", _TURNS)
    if kind == "none":
        return None
    if kind == "swing":
        return Swing(**values)
    angles = numbers_of(values.pop("angles"), name="turn angles", like="degrees such as [0, 20, 0]")
    times = times_of(values.pop("times"), name="turn times") or _seconds(len(angles))
    return Rotation(times, angles, **values)


def squash_of(squash: dict[str, Any] | None) -> RigMotion | None:
    """The squash that was chosen, None for none; InvalidInputError where it is unusable."""
    kind, values = _chosen(squash, "squash", _SQUASHES)
    if kind == "none":
        return None
    if kind == "pulse":
        return Pulse(**values)
    factors = numbers_of(values.pop("factors"), name="squash factors", like="factors such as [1, 0.8, 1]")
    times = times_of(values.pop("times"), name="squash times") or _seconds(len(factors))
    return Squash(times, factors, **values)


def _chosen(choice: dict[str, Any] | None, name: str, options: tuple[str, ...]) -> tuple[str, dict[str, Any]]:
    """The option and what was given of its inputs; a prompt made before this pack had an input leaves it out."""
    if "none" in options and (choice or {}).get(name) is None:
        return "none", {}
    kind, values = chosen(choice, name, options)
    return kind, {key: value for key, value in values.items() if value is not None}


def _seconds(count: int) -> tuple[float, ...]:
    return tuple(map(float, range(count)))


def _input(kind: type, name: str, **options: Any) -> io.Input:
    title = name.replace("_", " ")
    return input_of(kind, name, display_name=title, optional=name in OPTIONAL_INPUTS, **options)


def _angle() -> io.Float.Input:
    tooltip = "Where it swings to first [degrees]: 0 to the right, 90 up."
    return io.Float.Input(
        "angle", default=0.0, min=-360.0, max=360.0, step=5.0, display_name="angle", optional=False, tooltip=tooltip
    )


def _text(name: str, default: str, tooltip: str) -> io.String.Input:
    return io.String.Input(name, default=default, display_name=name, tooltip=tooltip)


def _times(default: str) -> io.String.Input:
    tooltip = "When it is at each key, as a list of rising seconds [s]; empty means one second apart."
    return _text("times", default, tooltip)
