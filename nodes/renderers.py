"""Who paints the frames of the node Render: composite alone, or a model, after it or after sketches."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.errors import require
from .host import chosen, lines_of_frames
from .models.inpainting import inpainted_frames, refused_inpainting
from .models.inpainting_inputs import inpainting_inputs
from .models.svd import check_followed, missing_svd_files, svd_frames
from .models.svd_inputs import dual_clock_inputs, svd_inputs

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from ..rendering.composite import Background, LayeredRenderer

__all__ = [
    "COMPOSITE",
    "check_followed_by",
    "check_moves_without_motion",
    "frames_by_model",
    "missing_model_files",
    "renderer_chosen",
    "renderer_input",
    "sketches_of",
]

COMPOSITE, _SVD, _INPAINTING = "composite", "sketch-guided SVD", "soft inpainting"
_DUAL_CLOCK = "animation-guided SVD"
_RENDERERS = (COMPOSITE, _SVD, _INPAINTING, _DUAL_CLOCK)


def renderer_input() -> io.DynamicCombo.Input:
    """The optional input renderer, and what each choice brings."""
    return io.DynamicCombo.Input(
        "renderer",
        options=[
            io.DynamicCombo.Option(COMPOSITE, []),
            io.DynamicCombo.Option(_SVD, svd_inputs()),
            io.DynamicCombo.Option(_INPAINTING, inpainting_inputs()),
            io.DynamicCombo.Option(_DUAL_CLOCK, dual_clock_inputs()),
        ],
        optional=True,
        tooltip="composite: the illustration's own pixels, without any model."
        " sketch-guided SVD: the paper's renderer, for which two model files are needed. soft inpainting:"
        " composite, with what the parts have uncovered painted by Stable Diffusion. animation-guided SVD:"
        " composite's frames, repainted by Stable Video Diffusion alone.",
    )


def renderer_chosen(given: dict[str, Any] | None) -> tuple[str, dict[str, Any]]:
    """Name and values of the choice; composite where nothing was said."""
    return chosen(given, "renderer", _RENDERERS) if given else (COMPOSITE, {})


def missing_model_files(given: dict[str, Any] | None) -> str:
    """What to tell about chosen model files that are not there; empty if none."""
    return missing_svd_files(given or {}) or refused_inpainting(given or {})


def check_followed_by(given: dict[str, Any] | None, *, sketches: bool) -> None:
    """Raise InvalidInputError where what a model should follow does not go together.

    Args:
        given: the choice, with what it brings.
        sketches: some are connected.
    """
    if given and given.get("renderer") == _DUAL_CLOCK:
        check_followed(given, sketches=sketches)


def check_moves_without_motion(given: dict[str, Any] | None) -> None:
    """Raise InvalidInputError where the choice asks for something that only a motion can tell."""
    choice = given or {"renderer": COMPOSITE}
    name = choice.get("renderer")
    moves = f"connected for the renderer {name}, which moves the picture's own pixels"
    require("motion", "nothing", name == _SVD, moves)
    keeps = "connected or keep_still_parts switched off, as it tells which parts are still"
    require("motion", "nothing", not choice.get("keep_still_parts"), keeps)


def frames_by_model(
    name: str,
    picture: NDArray[Any],
    layers: LayeredRenderer | None,
    background: Background,
    choice: dict[str, Any],
) -> Iterator[NDArray[Any]]:
    """All frames by the model of a choice.

    Args:
        name: of the choice.
        picture: the illustration, opaque.
        layers: draws the motion; None where nothing but sketches is followed.
        background: of composite's frames.
        choice: its values.
    """
    if name == _INPAINTING and layers is not None:
        return inpainted_frames(layers, background, choice)
    sketches = sketches_of(choice)
    if name == _SVD:
        return svd_frames(picture, sketches, layers, choice)
    check_followed(choice, sketches=bool(sketches))
    return svd_frames(picture, sketches, layers, choice, background)


def sketches_of(choice: dict[str, Any]) -> list[NDArray[Any]]:
    """The sketches that a choice brings, dark lines on white; none where none are connected."""
    given = choice.get("sketches")
    return [] if given is None else lines_of_frames(given)
