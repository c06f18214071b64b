"""Wind that blows everywhere."""

from __future__ import annotations

from comfy_api.latest import io

from ..physics.forces import Wind as PhysicalWind
from .host.field_inputs import input_of
from .host.wires import WindWire

__all__ = ["Wind"]

_NUMBERS = ("strength", "angle", "gust", "gust_period", "turbulence", "turbulence_size")


class Wind(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Wind",
            display_name="Wind (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Wind that blows over the whole picture, in gusts and with eddies.",
            inputs=[
                *(input_of(PhysicalWind, name) for name in _NUMBERS),
                input_of(PhysicalWind, "seed", name="wind_seed"),
            ],
            outputs=[WindWire.Output(display_name="wind", tooltip="For Scene or Automatic Scene.")],
        )

    @classmethod
    def execute(cls, wind_seed: int, **values: float) -> io.NodeOutput:
        return io.NodeOutput(PhysicalWind(seed=wind_seed, **values))
