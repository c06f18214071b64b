"""A motion saved for other programs to go on with, from what draws it."""

from __future__ import annotations

from collections.abc import Collection
from pathlib import Path
from typing import TYPE_CHECKING

from ..physics.progress import Progress
from .files import StrPath, check_text_output
from .moving_pieces import DEFAULT_TOLERANCE, check_tolerance, puppet_of

if TYPE_CHECKING:
    from .artwork import Blend
    from .composite import LayeredRenderer, PixelArtRenderer

__all__ = ["check_gltf_output", "check_spine_output", "save_renderer_as_gltf", "save_renderer_as_spine"]

_IN_SPINE: tuple[Blend, ...] = ("normal", "multiply", "screen", "add")
_IN_GLTF: tuple[Blend, ...] = ("normal",)


def check_spine_output(folder: StrPath, *, coming: Collection[Path] = ()) -> None:
    """Refuse a folder for a skeleton before any work; see :func:`~physanimator.rendering.export.check_spine_folder`."""
    from .export import check_spine_folder

    check_spine_folder(folder, coming=coming)


def check_gltf_output(path: StrPath, *, coming: Collection[Path] = ()) -> None:
    """Refuse a place for a scene before any work: InvalidInputError where its name is none in .glb, or taken."""
    check_text_output(path, ".glb", coming=coming)


def save_renderer_as_spine(
    renderer: LayeredRenderer | PixelArtRenderer,
    folder: StrPath,
    *,
    first: int = 0,
    tolerance: float = DEFAULT_TOLERANCE,
    progress: Progress | None = None,
) -> list[str]:
    """Write what a renderer draws as a skeleton of Spine 4.2; see :func:`~physanimator.rendering.export.save_spine`.

    Args:
        renderer: of the motion.
        folder: where to; it is made where it is missing, and its name is the skeleton's.
        first: number of the motion's first frame that is shown.
        tolerance: how far a vertex may ever be from where the motion has it [px].
        progress: called after each layer; may raise to stop.

    Returns:
        Sentences that say what was written, and what is otherwise than in the frames.

    Raises:
        InvalidInputError: the folder holds a skeleton that PhysAnimator did not write, nothing can be written there,
            the tolerance is out of its range, or the renderer draws pixel art.
    """
    from .export import save_spine

    check_tolerance(tolerance)
    puppet = puppet_of(renderer, first=first, blends=_IN_SPINE)
    made = save_spine(puppet, folder, tolerance=tolerance, progress=progress)
    written = f"{len(puppet.pieces)} slots, {made.keys} keys, at most {made.error:.2f} px from the motion"
    return [written, *_laid_otherwise(renderer, _IN_SPINE, "Spine")]


def save_renderer_as_gltf(
    renderer: LayeredRenderer | PixelArtRenderer,
    path: StrPath,
    *,
    first: int = 0,
    tolerance: float = DEFAULT_TOLERANCE,
    progress: Progress | None = None,
) -> list[str]:
    """Write what a renderer draws as a glTF scene; see :func:`~physanimator.rendering.export.save_gltf`.

    Args:
        renderer: of the motion.
        path: a name in .glb.
        first: number of the motion's first frame that is shown.
        tolerance: how far a vertex may ever be from where the motion has it [px].
        progress: called after each layer; may raise to stop.

    Returns:
        Sentences that say what was written, and what is otherwise than in the frames.

    Raises:
        InvalidInputError: nothing can be written there, the tolerance is out of its range, or the renderer draws pixel
            art.
    """
    from .export import save_gltf

    check_tolerance(tolerance)
    check_gltf_output(path)
    puppet = puppet_of(renderer, first=first, blends=_IN_GLTF)
    made = save_gltf(puppet, path, tolerance=tolerance, progress=progress)
    written = f"{len(puppet.pieces)} meshes, {made.targets} morph targets, at most {made.error:.2f} px from the motion"
    return [written, *_laid_otherwise(renderer, _IN_GLTF, "glTF")]


def _laid_otherwise(renderer: LayeredRenderer | PixelArtRenderer, blends: Collection[Blend], program: str) -> list[str]:
    """A sentence for each layer whose mode a program does not know."""
    from .composite import LayeredRenderer

    if not isinstance(renderer, LayeredRenderer):
        return []
    artwork, movers = renderer.layers_at_rest, renderer.movers
    told = []
    for index, (name, layer) in enumerate(zip(artwork.names, artwork.layers, strict=True)):
        if layer.visible and layer.blend not in blends:
            now = "is laid over what is behind it" if index in movers else "has the colours that it gives at rest"
            told.append(f"layer {name[:60]} {now}, because {program} has no mode {layer.blend}")
    return told
