"""An experiment: starting noise for video models that moves along with the bodies."""

from __future__ import annotations

from comfy_api.latest import io

from ..physics.motion import Fit
from ..rendering.control import ModelFormat
from .host import announce_batch, host_progress
from .host.wires import MaskedMotion, MotionWire
from .video_format_inputs import length_input, refused_form, size_inputs

__all__ = ["MovingNoise"]


class MovingNoise(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_MovingNoise",
            display_name="Moving Noise (experiment)",
            category="PhysAnimator/video models",
            description="White noise that moves along with the bodies, one picture for each step of a model's latents:"
            " for models that were tuned for such noise, as Go-with-the-Flow's are. Others take it as any noise.",
            inputs=[
                MotionWire.Input("motion", tooltip="From Simulate."),
                length_input(),
                *size_inputs(),
                io.Int.Input("channels", default=16, min=1, max=128, tooltip="Of the model's latents; 16 for Wan."),
                io.Int.Input(
                    "seed",
                    default=0,
                    min=0,
                    max=2**64 - 1,
                    control_after_generate=True,
                    tooltip="Other numbers make another noise of the same motion.",
                ),
            ],
            outputs=[
                io.Latent.Output(
                    display_name="noise", tooltip="For VOIDWarpedNoiseSource, which makes the host's NOISE of it."
                )
            ],
        )

    @classmethod
    def validate_inputs(
        cls, frames: int | None = None, width: int | None = None, height: int | None = None
    ) -> bool | str:
        return refused_form(frames=frames, width=width, height=height)

    @classmethod
    def execute(
        cls, motion: MaskedMotion, frames: int, width: int, height: int, fit: Fit, channels: int, seed: int
    ) -> io.NodeOutput:
        import torch

        from ..rendering.control import experimental_moving_noise

        form, moved = ModelFormat(frames, width, height, fit), motion.motion
        smaller = "scale the picture down"
        told = announce_batch(cls, 2 * channels, moved.width, moved.height, channels=1, instead=smaller)
        report = host_progress()
        noise = experimental_moving_noise(moved, form, channels=channels, seed=seed, progress=report)
        return io.NodeOutput({"samples": torch.from_numpy(noise).movedim(0, 1)[None].contiguous()}, ui=told or None)
