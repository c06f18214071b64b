"""Tracks of a motion, for video models that follow points."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from comfy_api.latest import io

from ..physics.motion import FITS, Fit
from .host import host_progress, picture_batch, pictures_for
from .host.previews import animated
from .host.wires import MaskedMotion, MotionWire

if TYPE_CHECKING:
    import torch
    from numpy.typing import NDArray

    from ..physics.motion import Tracks as PointTracks

__all__ = ["Tracks"]

_LONGEST_PREVIEW = 640  # [px]


class Tracks(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Tracks",
            display_name="Motion to Tracks",
            category="PhysAnimator/motion",
            description="Follows points of a motion, for video models that are led by tracks (Wan-Move, ATI).",
            is_output_node=True,
            inputs=[
                MotionWire.Input("motion", tooltip="From Simulate."),
                io.Int.Input("points", default=64, min=1, max=4096, tooltip="Points on the bodies."),
                io.Int.Input(
                    "static_points",
                    default=16,
                    min=0,
                    max=4096,
                    tooltip="Points of the background that no body ever covers: they tell the model what stands still.",
                ),
                io.Int.Input(
                    "frames",
                    default=0,
                    min=0,
                    max=10_000,
                    tooltip="Samples over the whole motion: the model's length, or 121 for Wan Track To Video; 0 takes"
                    " the motion's own frames.",
                ),
                io.Int.Input(
                    "width",
                    default=0,
                    min=0,
                    max=16_384,
                    tooltip="Width of the video that the tracks are for [px]; 0 is the illustration's.",
                ),
                io.Int.Input(
                    "height",
                    default=0,
                    min=0,
                    max=16_384,
                    tooltip="Height of the video that the tracks are for [px]; 0 is the illustration's.",
                ),
                io.Combo.Input(
                    "fit",
                    options=list(FITS),
                    default="crop",
                    tooltip="How the illustration comes to that size: cut to its middle, as the Wan nodes do with their"
                    " start image, or stretched.",
                ),
                io.Float.Input(
                    "weighting",
                    default=0.5,
                    min=0.0,
                    max=2.0,
                    step=0.05,
                    tooltip="0 spreads the points evenly over the bodies; more gathers them where much moves.",
                ),
                io.Image.Input(
                    "image",
                    optional=True,
                    tooltip="The illustration, or the rendered frames: the preview draws the tracks on it.",
                ),
            ],
            outputs=[
                io.Tracks.Output(display_name="tracks", tooltip="Paths and visibility: for WanMoveTrackToVideo."),
                io.String.Output(
                    display_name="coordinates", tooltip="The paths as JSON: for WanTrackToVideo and spline editors."
                ),
                io.Image.Output(display_name="preview", tooltip="Every second sample, at most 640 px wide or high."),
            ],
        )

    @classmethod
    def execute(
        cls,
        motion: MaskedMotion,
        points: int,
        static_points: int,
        frames: int,
        width: int,
        height: int,
        fit: Fit,
        weighting: float,
        image: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..physics.motion import tracks

        moved = motion.motion
        found = tracks(
            moved,
            points=points,
            static_points=static_points,
            frames=frames or None,
            width=width or None,
            height=height or None,
            fit=fit,
            weighting=weighting,
        )
        pictures = None
        if image is not None:
            pictures = pictures_for(image, moved.width, moved.height, frames=len(moved))
        preview = _preview(found, pictures, fit)
        return io.NodeOutput(_core_tracks(found), found.to_json(), preview, ui=animated(preview, found.frame_rate / 2))


def _core_tracks(found: PointTracks) -> dict[str, Any]:
    """What travels on the host's TRACKS wire."""
    import torch

    return {
        "track_path": torch.from_numpy(found.path.copy()),
        "track_visibility": torch.from_numpy(found.visibility.copy()),
    }


def _preview(found: PointTracks, pictures: NDArray[np.float32] | None, fit: Fit) -> torch.Tensor:
    """Every second sample on its picture, or on a dark ground."""
    from ..rendering.overlays import draw_tracks, reframed

    scale = min(1.0, _LONGEST_PREVIEW / max(found.width, found.height))
    # Even sides: a video of the preview can be saved.
    width, height = (max(2, 2 * round(side * scale / 2)) for side in (found.width, found.height))
    shown, report = range(0, len(found), 2), host_progress()
    batch = picture_batch(len(shown))
    ground = np.full((height, width, 3), 0.1, dtype=np.float32)
    for number, sample in enumerate(shown, start=1):
        if pictures is not None and (number == 1 or len(pictures) > 1):
            frame = round(sample * (len(pictures) - 1) / max(1, len(found) - 1))
            ground = reframed(pictures[frame], width, height, fit)
        batch.put(draw_tracks(ground, found, sample))
        report(number, len(shown))
    return batch.tensor
