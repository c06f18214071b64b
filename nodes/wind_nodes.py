"""Wind that blows everywhere."""

from __future__ import annotations

from comfy_api.latest import io

from ..physics.forces import Wind as PhysicalWind
from .host.wires import WindWire

__all__ = ["Wind"]


class Wind(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        usual = PhysicalWind()
        return io.Schema(
            node_id="PhysAnimator_Wind",
            display_name="Wind",
            category="PhysAnimator/scene",
            description="Wind that blows over the whole picture, in gusts and with eddies.",
            inputs=[
                io.Float.Input(
                    "strength",
                    default=usual.strength,
                    min=0.0,
                    max=1000.0,
                    step=0.1,
                    tooltip="Acceleration when it blows hardest, without eddies [sides/s^2], a side being the picture's"
                    " longest; 0.5 is a breeze, 3 a storm.",
                ),
                io.Float.Input(
                    "angle",
                    default=usual.angle,
                    min=-360.0,
                    max=360.0,
                    step=5.0,
                    tooltip="Where it blows to [degrees]: 0 to the right, 90 up, 180 to the left.",
                ),
                _share(
                    "gust",
                    usual.gust,
                    "Share of the strength that comes and goes [1]: 0 blows steadily, at 1 it is calm between gusts.",
                ),
                io.Float.Input(
                    "gust_period",
                    default=usual.gust_period,
                    min=0.05,
                    max=3600.0,
                    step=0.1,
                    tooltip="Time from gust to gust [s].",
                ),
                _share("turbulence", usual.turbulence, "How strong the eddies are, as a share of the wind [1]."),
                io.Float.Input(
                    "turbulence_size",
                    default=usual.turbulence_size,
                    min=1.0,
                    max=16384.0,
                    step=10.0,
                    tooltip="How large an eddy is [px].",
                ),
                io.Int.Input(
                    "wind_seed",
                    default=usual.seed,
                    min=0,
                    max=2**31 - 1,
                    tooltip="Chooses among winds that are alike in all else.",
                ),
            ],
            outputs=[WindWire.Output(display_name="wind", tooltip="For Scene or Automatic Scene.")],
        )

    @classmethod
    def execute(
        cls,
        strength: float,
        angle: float,
        gust: float,
        gust_period: float,
        turbulence: float,
        turbulence_size: float,
        wind_seed: int,
    ) -> io.NodeOutput:
        return io.NodeOutput(PhysicalWind(strength, angle, gust, gust_period, turbulence, turbulence_size, wind_seed))


def _share(name: str, usual: float, tooltip: str) -> io.Float.Input:
    return io.Float.Input(name, default=usual, min=0.0, max=1.0, step=0.05, tooltip=tooltip)
