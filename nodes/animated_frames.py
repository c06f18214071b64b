"""What the node Animate Illustration draws: its frames, and the small video of them that it shows."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from comfy_api.latest import io, ui

from .host import announce_batch, picture_batch

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..physics.motion import Motion
    from ..rendering.composite import Background, LayeredRenderer, PixelArtRenderer
    from .host import FrameBatch
    from .host.progress import Report

__all__ = ["Drawn", "draw"]

_LONGER, _SHORTER, _LONGEST = 960, 480, 4096
"""Sides of what is shown [px]: of a page that is very long or wide the shorter one counts, as far as videos reach."""


class Drawn(NamedTuple):
    """The frames, where they are wanted, what the node shows, and what the user was told."""

    batch: FrameBatch | None
    shown: Any
    told: dict[str, list[str]]


def draw(
    node: Any,
    renderer: LayeredRenderer | PixelArtRenderer,
    motion: Motion,
    background: Background,
    report: Report,
    *,
    wanted: bool,
    exact: bool,
) -> Drawn:
    """Draw every frame once.

    Args:
        node: the node's class, as ``execute`` has it.
        renderer: of the motion.
        motion: what is drawn.
        background: what is there where nothing moves.
        report: the node's progress, whose second half this is.
        wanted: whether somebody takes the frames.
        exact: mix no colours.
    """
    from ..rendering.pictures import write_animation

    count, channels = len(motion), 3 + background.has_alpha
    instead = "connect motion to Save Animation, which holds one frame at a time"
    told: dict[str, list[str]] = {}
    if wanted:
        told = announce_batch(node, count, motion.width, motion.height, channels=channels, instead=instead)
    batch = picture_batch(count) if wanted else None
    lossless = background.has_alpha or exact
    name, path = _place(".webp" if lossless else ".mp4")
    frames = _frames(renderer, background, batch, report, exact=exact)
    write_animation(frames, path, motion.frame_rate, exact=exact)
    saved = ui.SavedImages([ui.SavedResult(name, "", io.FolderType.temp)], is_animated=True)
    return Drawn(batch, saved, told)


def _frames(
    renderer: LayeredRenderer | PixelArtRenderer,
    background: Background,
    batch: FrameBatch | None,
    report: Report,
    *,
    exact: bool,
) -> Iterator[NDArray[Any]]:
    """The frames as they are shown, one after another; the batch gets them as they are."""
    from ..rendering.composite import shown_frame
    from ..rendering.pictures import resized

    for number in range(len(renderer)):
        frame = shown_frame(renderer, number, background)
        if batch is not None:
            batch.put(frame)
        height, width = frame.shape[:2]
        longer, shorter = max(width, height), min(width, height)
        scale = min(1.0, _LONGEST / longer, max(_LONGER / longer, _SHORTER / shorter))
        size = max(1, round(width * scale)), max(1, round(height * scale))
        yield frame if scale == 1 else resized(frame, *size, nearest=exact)
        report(len(renderer) + number + 1, 2 * len(renderer))


def _place(ending: str) -> tuple[str, str]:
    """Name and path of a new file in the host's temporary folder."""
    import folder_paths

    folder = folder_paths.get_temp_directory()
    os.makedirs(folder, exist_ok=True)
    name = f"physanimator_{secrets.token_hex(8)}{ending}"
    return name, os.path.join(folder, name)
