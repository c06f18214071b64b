"""Energy strokes: where the wind goes."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ..physics.document import parse_polyline
from ..physics.forces import FALLOFFS, STROKE_KINDS
from ..physics.forces import EnergyStroke as PhysicalStroke
from .host import PATH_FORMS, keys_of, refusal
from .host.wires import StrokesWire

__all__ = ["EnergyStroke"]


class EnergyStroke(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        usual = PhysicalStroke()
        return io.Schema(
            node_id="PhysAnimator_EnergyStroke",
            display_name="Energy Stroke",
            category="PhysAnimator/scene",
            description="A drawn path along which particles travel that push, repel or attract the bodies.",
            inputs=[
                io.Combo.Input(
                    "kind",
                    options=list(STROKE_KINDS),
                    default=usual.kind,
                    tooltip="wind pushes along the path, repel pushes away from the particles, attract pulls to them.",
                ),
                io.String.Input(
                    "path",
                    default="[[0, 360], [1280, 360]]",
                    multiline=True,
                    tooltip=f"Points of the stroke in pixels {PATH_FORMS} It may begin outside the picture.",
                ),
                io.Float.Input(
                    "radius",
                    default=usual.radius,
                    min=1.0,
                    max=16384.0,
                    step=10.0,
                    tooltip="A particle acts up to this distance [px].",
                ),
                io.Float.Input(
                    "speed",
                    default=usual.speed,
                    min=0.0,
                    max=100_000.0,
                    step=10.0,
                    tooltip="How fast particles travel along the path [px/s]; 0 keeps one at its first point.",
                ),
                io.Float.Input(
                    "strength",
                    default=usual.strength,
                    min=-1000.0,
                    max=1000.0,
                    step=0.1,
                    tooltip="Acceleration at full effect [sides/s^2], a side being the picture's longest;"
                    " 1 is a breeze, 10 a blow. Negative reverses it.",
                ),
                io.Float.Input(
                    "start",
                    default=usual.start,
                    min=0.0,
                    max=3600.0,
                    step=0.1,
                    tooltip="When the first particle sets out [s].",
                ),
                io.Float.Input(
                    "end",
                    default=0.0,
                    min=0.0,
                    max=3600.0,
                    step=0.1,
                    tooltip="When the last particle has set out [s]; 0 means never.",
                ),
                io.Float.Input(
                    "interval",
                    default=usual.interval,
                    min=0.01,
                    max=3600.0,
                    step=0.1,
                    tooltip="Time from one particle to the next [s]: 0.1 sends ten a second, a steady stream; 2 lets"
                    " single gusts pass.",
                ),
                io.Combo.Input(
                    "falloff",
                    options=list(FALLOFFS),
                    default=usual.falloff,
                    optional=True,
                    tooltip="How the effect goes with the distance: linear falls evenly (repel: grows), smooth falls"
                    " without a kink, constant acts alike up to the radius.",
                ),
                io.Float.Input(
                    "repeat",
                    default=0.0,
                    min=0.0,
                    max=3600.0,
                    step=0.1,
                    optional=True,
                    tooltip="The time from start to end begins anew every so often [s]; 0 means never. Needs an end.",
                ),
                _keys("strength_keys", "strength", "[[0, 1], [1, 0]] lets it die away towards the end."),
                _keys("speed_keys", "speed", "[[0, 0.5], [1, 2]] starts slowly and leaves fast."),
                StrokesWire.Input("strokes", optional=True, tooltip="Strokes that act besides this one."),
            ],
            outputs=[StrokesWire.Output(display_name="strokes", tooltip="The strokes before this one, and this one.")],
        )

    @classmethod
    def validate_inputs(
        cls, path: str | None = None, strokes: tuple[PhysicalStroke, ...] | None = None, **values: Any
    ) -> bool | str:
        if path is None or None in values.values():  # it comes from another node
            return True
        return refusal(lambda: _stroke(path, **values))

    @classmethod
    def execute(cls, path: str, strokes: tuple[PhysicalStroke, ...] = (), **values: Any) -> io.NodeOutput:
        return io.NodeOutput((*strokes, _stroke(path, **values)))


def _stroke(
    path: str,
    *,
    end: float = 0.0,
    repeat: float = 0.0,
    strength_keys: str = "",
    speed_keys: str = "",
    **values: Any,
) -> PhysicalStroke:
    """The stroke that the values of the inputs describe; InvalidInputError where one is unusable."""
    return PhysicalStroke(
        path=tuple(parse_polyline(path)),
        end=end or None,
        repeat=repeat or None,
        strength_keys=keys_of(strength_keys, name="strength_keys"),
        speed_keys=keys_of(speed_keys, name="speed_keys"),
        **values,
    )


def _keys(name: str, varied: str, example: str) -> io.String.Input:
    return io.String.Input(
        name,
        default="",
        optional=True,
        tooltip=f"How the {varied} changes along the path: a list of [part of the path from 0 to 1, factor on the"
        f" {varied}], such as {example} Empty: the same everywhere.",
    )
