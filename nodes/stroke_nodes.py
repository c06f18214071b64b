"""Energy strokes: where the wind goes."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ..physics.document import parse_polyline
from ..physics.forces import EnergyStroke as PhysicalStroke
from .host import PATH_FORMS, keys_of, refusal
from .host.field_inputs import input_of
from .host.wires import StrokesWire

__all__ = ["EnergyStroke"]

_NUMBERS = ("radius", "speed", "strength", "start", "end", "interval")


class EnergyStroke(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_EnergyStroke",
            display_name="Energy Stroke",
            category="PhysAnimator/scene",
            description="A drawn path along which particles travel that push, repel or attract the bodies.",
            inputs=[
                input_of(PhysicalStroke, "kind"),
                io.String.Input(
                    "path",
                    default="[[0, 360], [1280, 360]]",
                    multiline=True,
                    tooltip=f"Points of the stroke in pixels {PATH_FORMS} It may begin outside the picture.",
                ),
                *(input_of(PhysicalStroke, name) for name in _NUMBERS),
                *(input_of(PhysicalStroke, name, optional=True) for name in ("falloff", "repeat")),
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
