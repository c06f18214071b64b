"""How good the frames are, in numbers."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from .host import host_progress, picture_of, pictures_of
from .host.wires import MaskedMotion, MotionWire

if TYPE_CHECKING:
    import torch

__all__ = ["Metrics"]

_FOLDER = "metrics"
_NUMBERS = {
    "flow_warp_error": "Change of colour on the bodies from frame to frame [0 to 1]; lower is steadier.",
    "static_drift": "Change of colour where no body ever comes [0 to 1]; lower is better.",
    "sketch_adherence": "Distance of the frames' lines from the sketches [px]; -1 without sketches.",
    "dynamic_degree": "Motion that is seen in what moves most [px/frame].",
    "hole_ratio": "Share of the picture that the bodies have left [0 to 1].",
}


class Metrics(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Metrics",
            display_name="Metrics (PhysAnimator)",
            category="PhysAnimator/render",
            description="Measures frames against the motion that they should show. Works without any model file.",
            is_output_node=True,
            inputs=[
                io.Image.Input("images", tooltip="From Render, Interpolate or a video model: one for each frame."),
                MotionWire.Input("motion", tooltip="From Simulate: what the frames should show."),
                io.Image.Input(
                    "drawing",
                    optional=True,
                    tooltip="The illustration, to measure drift against; else the first frame.",
                ),
                io.Image.Input(
                    "sketches", optional=True, tooltip="From Warp Sketch: what the frames' lines should follow."
                ),
                io.Boolean.Input(
                    "fid",
                    default=False,
                    optional=True,
                    tooltip="Also the Frechet inception distance to the references; needs a model file.",
                ),
                io.Image.Input("references", optional=True, tooltip="Pictures that fid compares with; at least 2."),
                io.String.Input(
                    "description",
                    default="",
                    optional=True,
                    tooltip="What the clip shows, for VideoScore's grades; needs a model folder. Empty: no grades.",
                ),
            ],
            outputs=[
                io.String.Output(display_name="report", tooltip="All measures as JSON."),
                *(io.Float.Output(name, display_name=name, tooltip=tip) for name, tip in _NUMBERS.items()),
            ],
        )

    @classmethod
    def validate_inputs(cls, fid: bool | None = None, description: str | None = None, **others: Any) -> bool | str:
        from ..rendering.metrics.learned import FID_FILE, VIDEO_SCORE_FOLDER

        wanted = [FID_FILE] * bool(fid) + [VIDEO_SCORE_FOLDER] * bool((description or "").strip())
        told = [file.missing(f"models/{_FOLDER}/{file.name}") for file in wanted if not _place(file.name).exists()]
        return " ".join(told) or True

    @classmethod
    def execute(
        cls,
        images: torch.Tensor,
        motion: MaskedMotion,
        drawing: torch.Tensor | None = None,
        sketches: torch.Tensor | None = None,
        fid: bool = False,
        references: torch.Tensor | None = None,
        description: str = "",
    ) -> io.NodeOutput:
        from ..rendering.metrics import measure_clip

        lines = None if sketches is None else pictures_of(sketches, name="sketches")
        frames = pictures_of(images, name="images")
        found: dict[str, float | None] = measure_clip(
            frames,
            motion.motion,
            drawing=None if drawing is None else picture_of(drawing, name="drawing"),
            sketches=None if lines is None else (each.mean(axis=2) for each in lines),
            progress=host_progress(),
        ).as_dict()
        found |= _learned(frames, references if fid else None, description.strip(), wanted=fid)
        report = json.dumps(found, indent=2)
        numbers = [-1.0 if found[name] is None else found[name] for name in _NUMBERS]
        return io.NodeOutput(report, *numbers, ui={"text": [report]})


def _learned(
    frames: Any, references: torch.Tensor | None, description: str, *, wanted: bool
) -> dict[str, float | None]:
    """What networks say of the frames."""
    from ..physics.errors import require
    from ..rendering.metrics.learned import FID_FILE, VIDEO_SCORE_FOLDER

    found: dict[str, float | None] = {}
    if wanted:
        from ..rendering.metrics.learned.fid import frechet_inception_distance

        require("references", references, references is not None, "connected where fid is on")
        compared = pictures_of(references, name="references")
        found["fid"] = frechet_inception_distance(frames, compared, _place(FID_FILE.name))
    if description:
        from ..rendering.metrics.learned import video_score

        grades = video_score(frames, description, _place(VIDEO_SCORE_FOLDER.name))
        found |= {f"video_score_{name}": grade for name, grade in grades.items()}
    return found


def _place(name: str) -> Path:
    import folder_paths

    return Path(folder_paths.models_dir) / _FOLDER / name
