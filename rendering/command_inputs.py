"""What a command is given: options that go together, and the files that they name."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from ..physics.collision import Contact

__all__ = ["check_inputs", "read_inputs"]


def check_inputs(options: argparse.Namespace) -> None:
    """Refuse options that do not go together, before any work.

    Raises:
        InvalidInputError: the message names the options.
    """
    from ..physics.errors import InvalidInputError

    if not options.mask and not options.points:
        raise InvalidInputError(f"{options.command} needs --mask or --points to know what moves. Got: neither")
    if options.scene and _wind(options):
        raise InvalidInputError("--attach, --wind, --wind-angle and --turbulence work without --scene. Got: both")


def _wind(options: argparse.Namespace) -> dict[str, Any]:
    """What was said of the automatic scene."""
    wind = {"attach": options.attach, "wind_strength": options.wind, "wind_angle": options.wind_angle}
    wind["turbulence"] = options.turbulence
    return {name: value for name, value in wind.items() if value is not None}


def read_inputs(options: argparse.Namespace) -> tuple[Any, dict[str, Any]]:
    """The illustration, and what moves how as the options of ``animate``.

    Raises:
        InvalidInputError: a file cannot be read.
    """
    from ..physics.json_text import read_json
    from .images import load_image, load_mask

    scene = read_json(_text(options.scene, "scene")) if options.scene else None
    image = load_image(options.image, alpha=True)
    height, width = image.shape[:2]
    return image, {
        "masks": [load_mask(path, width=width, height=height) for path in options.mask],
        "points": [_text(path, "points") for path in options.points],
        "scene": scene,
        "preset": options.preset,
        "sway": options.sway,
        "spacing": options.spacing,
        "contact": _contact(options, scene),
        "colliders": [load_mask(path, width=width, height=height) for path in options.collider],
        **_wind(options),
    }


def _contact(options: argparse.Namespace, scene: Any) -> Contact | None:
    """The usual contact, unless the scene has its own."""
    from ..physics.collision import Contact

    wanted = options.contact or options.collider
    return Contact() if wanted and not (isinstance(scene, dict) and scene.get("contact")) else None


def _text(path: str, name: str) -> str:
    from ..physics.errors import InvalidInputError

    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = error.strerror if isinstance(error, OSError) else "it is not text"
        raise InvalidInputError(f"{name} must be a readable text file. Got: {path}: {reason}") from None
