"""Painted materials: masks that make parts of a body stiffer, heavier or more damped."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comfy_api.latest import io

from ..physics.limits import LEAST_FACTOR, MOST_FACTOR
from ..physics.material import PRESETS
from ..physics.material import Material as PhysicalMaterial
from ..physics.material import preset as preset_material
from .host import default_of, mask_of
from .host.wires import MaskedMesh, MaterialWire, MeshWire

if TYPE_CHECKING:
    import torch

__all__ = ["PaintMaterial"]


class PaintMaterial(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        from ..physics.material import painted

        return io.Schema(
            node_id="PhysAnimator_PaintMaterial",
            display_name="Paint Material (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Makes parts of a body stiffer, heavier or more damped, as masks say.",
            inputs=[
                MeshWire.Input("mesh", tooltip="Shape of the body that will be made of it, from Mask to Mesh."),
                io.Combo.Input(
                    "preset",
                    options=list(PRESETS),
                    default="hair",
                    tooltip="What is painted on. Connect a Material node to set your own values instead.",
                ),
                _factor("black", default_of(painted, "low"), "black"),
                _factor("white", default_of(painted, "high"), "white"),
                MaterialWire.Input("material", optional=True, tooltip="Used instead of the preset when connected."),
                io.Mask.Input("stiffness", optional=True, tooltip="Where it is stiffer."),
                io.Mask.Input("damping", optional=True, tooltip="Where it comes to rest sooner."),
                io.Mask.Input("mass", optional=True, tooltip="Where it is heavier."),
            ],
            outputs=[MaterialWire.Output(display_name="material", tooltip="For the node Body, with the same mesh.")],
        )

    @classmethod
    def execute(
        cls,
        mesh: MaskedMesh,
        preset: str,
        black: float,
        white: float,
        material: PhysicalMaterial | None = None,
        stiffness: torch.Tensor | None = None,
        damping: torch.Tensor | None = None,
        mass: torch.Tensor | None = None,
    ) -> io.NodeOutput:
        from ..physics.material import painted

        given = {"stiffness": stiffness, "damping": damping, "density": mass}
        masks = {name: mask_of(mask, name=name) for name, mask in given.items() if mask is not None}
        return io.NodeOutput(painted(material or preset_material(preset), mesh.mesh, **masks, low=black, high=white))


def _factor(name: str, default: float, colour: str) -> io.Float.Input:
    tooltip = f"Factor where a mask is {colour} [1]; greys lie between. 1 changes nothing."
    return io.Float.Input(name, default=default, min=LEAST_FACTOR, max=float(MOST_FACTOR), step=0.05, tooltip=tooltip)
