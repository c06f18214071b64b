"""What a command is given: options that go together, and the files that they name."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .names import named_as
from .physics_options import physics_of

if TYPE_CHECKING:
    from ...physics.scene import Contact
    from ..artwork import Artwork
    from ..options import AutomaticWind

__all__ = ["check_inputs", "check_taken", "read_inputs", "read_plate"]


_GREY = 8  # levels by which colours may differ and still be grey, black or white
_MASK_SHARE = 0.8  # of a grey picture in black and white: it is a mask rather than a drawing


def check_inputs(options: argparse.Namespace) -> None:
    """Refuse options that do not go together, before any work.

    Raises:
        InvalidInputError: the message names the options.
    """
    from ...physics.errors import InvalidInputError
    from ..artwork import is_artwork_file

    if is_artwork_file(options.image):
        _check_layers_alone(options)
    elif options.move or options.still:
        raise InvalidInputError("--move and --still need layered artwork as IMAGE. Got: a flat picture")
    elif not options.mask and not options.points:
        raise InvalidInputError(f"{options.command} needs --mask or --points to know what moves. Got: neither")
    automatic = (options.attach, options.wind, options.wind_angle, options.turbulence)
    if options.scene is not None and any(said is not None for said in automatic):
        raise InvalidInputError("--attach, --wind, --wind-angle and --turbulence work without --scene. Got: both")


def _check_layers_alone(options: argparse.Namespace) -> None:
    """Refuse options that say again, or otherwise, what layers say."""
    from ...physics.errors import InvalidInputError
    from .names import option_of

    for name in ("mask", "points", "in_front", "plate", "pixel_art"):
        if getattr(options, name, None):
            raise InvalidInputError(
                f"IMAGE must be a flat picture where {option_of(name)} is given. Got: {options.image[:80]}, whose"
                " layers are parts of their own"
            )


def check_taken(options: argparse.Namespace, image: Any) -> None:
    """Say which value of another option was taken as the picture, and refuse it if it is likely to be a mask.

    Args:
        options: of the command; ``image_after`` names that option, if there is one.
        image: the picture, uint8, shape [h, w, 3 or 4].

    Raises:
        InvalidInputError: it has hardly anything but black and white in it.
    """
    import numpy as np

    from ...physics.errors import InvalidInputError
    from .messages import warn

    option = getattr(options, "image_after", None)
    if option is None or not isinstance(image, np.ndarray):
        return
    colours = image[..., :3].astype(np.int16)
    grey = np.ptp(colours, axis=2).max() <= _GREY
    if grey and np.mean((colours <= _GREY) | (colours >= 255 - _GREY)) > _MASK_SHARE:
        raise InvalidInputError(
            f"IMAGE must be given, best before the options. Got: {options.image}, the last value of {option}, which"
            " looks like a mask"
        )
    if not options.quiet:
        warn(f"physanimator: {options.image}, the last value of {option}, is taken as the picture")


def _wind(options: argparse.Namespace) -> AutomaticWind:
    """What was said of the automatic scene's wind."""
    from ..options import AutomaticWind

    said = {"strength": options.wind, "angle": options.wind_angle, "turbulence": options.turbulence}
    return AutomaticWind(**{name: value for name, value in said.items() if value is not None})


def read_inputs(options: argparse.Namespace) -> tuple[Any, dict[str, Any]]:
    """The illustration, and what moves how as the options of ``animate``.

    Raises:
        InvalidInputError: a file cannot be read.
    """
    from ..artwork import is_artwork_file
    from ..options import LayerChoice, Touching
    from ..parts import arranged

    scene = _scene(options)
    if is_artwork_file(options.image):
        with named_as("--move or --still", "layer"):
            artwork = arranged(_artwork(options.image), options.move, options.still)
        width, height = artwork.width, artwork.height
        image: Any = artwork
        parts: dict[str, Any] = {"layers": LayerChoice(options.move, options.still)}
    else:
        image = _picture(options.image, "IMAGE")
        height, width = image.shape[:2]
        front = None if options.in_front is None else _mask(options.in_front, "--in-front", width, height)
        parts = {"in_front": front}
    return image, {
        **parts,
        "masks": [_mask(path, "--mask", width, height) for path in options.mask],
        "points": [_points(path, width, height) for path in options.points],
        "scene": scene,
        "preset": options.preset,
        "sway": options.sway,
        "spacing": options.spacing,
        "strands": options.strands,
        "physics": physics_of(options),
        "touching": Touching(
            _contact(options, scene), [_collider(path, image, width, height) for path in options.collider]
        ),
        "wind": _wind(options),
        **({} if options.attach is None else {"attach": options.attach}),
    }


def read_plate(options: argparse.Namespace, *, alpha: bool = True) -> Any:
    """The picture of ``--plate``; None without the option.

    Raises:
        InvalidInputError: the file cannot be read.
    """
    return None if options.plate is None else _picture(options.plate, "--plate", alpha=alpha)


def _picture(path: str, option: str, *, alpha: bool = True) -> Any:
    from ..pictures import load_image
    from ..pictures.picture_files import first_of_several, reading
    from .messages import warn

    with named_as(option, "picture"):
        picture = load_image(path, alpha=alpha)
        with reading(path, "picture") as opened:
            for sentence in first_of_several(opened, f"{option} {path}"):
                warn(f"physanimator: warning: {sentence}")
    return picture


def _artwork(path: str) -> Artwork:
    """Layered artwork, after saying on standard error what of it is not shown as its own program shows it."""
    from ..artwork import load_artwork
    from .messages import warn

    with named_as("IMAGE", "artwork"):
        found = load_artwork(path)
    for sentence in found.warnings:
        warn(f"physanimator: warning: {sentence}")
    return found


def _mask(path: str, option: str, width: int, height: int) -> Any:
    """A mask, after saying on standard error what may not be meant so in it."""
    from ..pictures.mask_files import read_mask
    from .messages import warn

    with named_as(option, "picture"):
        found = read_mask(path, width=width, height=height, name=option)
    for note in found.notes:
        warn(f"physanimator: warning: {note}")
    return found.coverage


def _collider(given: str, image: Any, width: int, height: int) -> Any:
    """The mask in a file; of layered artwork also the name of a layer, where there is no such file."""
    import numpy as np

    if not isinstance(image, np.ndarray) and not Path(given).exists():
        return given
    return _mask(given, "--collider", width, height)


def _scene(options: argparse.Namespace) -> dict[str, Any] | None:
    """The scene file's document, which the simulation checks further."""
    from ...physics.document import check_document, read_json
    from ..files import read_text_file

    if options.scene is None:
        return None
    document = read_json(read_text_file(options.scene, "--scene"))
    return document if isinstance(document, dict) else check_document(document)


def _points(path: str, width: int, height: int) -> str:
    """The text of a file of points, after a look at whether it holds points of this picture."""
    from ...physics.document import parse_points
    from ..files import read_text_file

    text = read_text_file(path, "--points")
    with named_as(f"--points {path}"):
        parse_points(text, width=width, height=height)
    return text


def _contact(options: argparse.Namespace, scene: Any) -> Contact | None:
    """The usual contact, unless the scene has its own."""
    from ...physics.scene import Contact

    wanted = options.contact or options.collider
    return Contact() if wanted and not (isinstance(scene, dict) and scene.get("contact")) else None
