"""What moves: materials, and bodies made of a mesh and a material."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ..physics.material import PRESETS
from ..physics.material import Material as PhysicalMaterial
from ..physics.material import preset as preset_material
from ..physics.scene import ATTACHMENTS, Attachment
from ..physics.scene import Body as PhysicalBody
from ..rendering.moving_layers import moving_layers_of
from .host import chosen
from .host.field_inputs import input_of
from .host.wires import BodiesWire, MaskedBody, MaskedMesh, MaterialWire, MeshWire

__all__ = ["Body", "Material"]

_CUSTOM, _LAME = "custom", "lame"
_ELASTIC = ("youngs_modulus", "poisson_ratio", "density")
_AS_IN_THE_PAPER = PhysicalMaterial(mu=200.0, lambda_=300.0)
_OPTIONAL = ("stretch_limit", "wind_response", "root_stiffness")
_TITLES = {"youngs_modulus": "Young's modulus", "poisson_ratio": "Poisson's ratio"}


class Material(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        options = [io.DynamicCombo.Option(name, _inputs(made, "sway_frequency")) for name, made in PRESETS.items()]
        options.append(io.DynamicCombo.Option(_CUSTOM, _inputs(PhysicalMaterial(), *_ELASTIC)))
        options.append(io.DynamicCombo.Option(_LAME, _inputs(_AS_IN_THE_PAPER, "mu", "lambda_", "density")))
        return io.Schema(
            node_id="PhysAnimator_Material",
            display_name="Material (PhysAnimator)",
            category="PhysAnimator/scene",
            description="What a body is made of. Presets look alike at any size of picture.",
            inputs=[
                io.DynamicCombo.Input(
                    "preset",
                    options=options,
                    tooltip="What the part is; its usual values appear below. 'custom' takes Young's modulus and"
                    " Poisson's ratio, 'lame' the Lame parameters mu and lambda of the paper.",
                )
            ],
            outputs=[MaterialWire.Output(display_name="material", tooltip="For the node Body.")],
        )

    @classmethod
    def execute(cls, preset: dict[str, Any] | None = None) -> io.NodeOutput:
        name, given = chosen(preset, "preset", (*PRESETS, _CUSTOM, _LAME))
        values = {key: value for key, value in given.items() if value is not None}  # optional ones may be left out
        if "lambda" in values:
            values["lambda_"] = values.pop("lambda")  # no name that Python lets a field have
        if "stretch_limit" in values:
            # A widget has no gap between 0, which is no limit, and the least.
            values["stretch_limit"] = max(values["stretch_limit"], 1.0) if values["stretch_limit"] else None
        return io.NodeOutput(preset_material(name, **values) if name in PRESETS else PhysicalMaterial(**values))


class Body(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Body",
            display_name="Body (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Makes a mesh a soft body that moves, such as hair, cloth or a leaf. Chain several Body nodes"
            " for several parts.",
            inputs=[
                MeshWire.Input("mesh", tooltip="Its shape, from Mask to Mesh."),
                io.Combo.Input(
                    "preset",
                    options=list(PRESETS),
                    default="hair",
                    tooltip="What it is made of. Connect a Material node to set your own values instead.",
                ),
                input_of(PhysicalBody, "layer"),
                io.Combo.Input(
                    "attach",
                    options=list(ATTACHMENTS),
                    default="auto",
                    tooltip="Side at which Automatic Scene holds it: where it is attached to the rest of the picture."
                    " A Scene with your own rig points does not use it.",
                ),
                BodiesWire.Input("bodies", optional=True, tooltip="Bodies that come before this one."),
                MaterialWire.Input("material", optional=True, tooltip="Used instead of the preset when connected."),
            ],
            outputs=[BodiesWire.Output(display_name="bodies", tooltip="The bodies before this one, and this one.")],
        )

    @classmethod
    def execute(
        cls,
        mesh: MaskedMesh,
        preset: str,
        layer: int,
        attach: Attachment,
        bodies: tuple[MaskedBody, ...] = (),
        material: PhysicalMaterial | None = None,
    ) -> io.NodeOutput:
        body = PhysicalBody(mesh.mesh, material or preset_material(preset), layer)
        chain = (*bodies, MaskedBody(body, mesh.mask, attach, in_front=mesh.in_front))
        moving_layers_of([item.source for item in chain])
        return io.NodeOutput(chain)


def _inputs(material: PhysicalMaterial, *names: str) -> list[io.Input]:
    """The inputs of an option, with the values of a material."""
    return [
        input_of(
            PhysicalMaterial,
            name,
            default=getattr(material, name),
            display_name=_TITLES.get(name, name.replace("_", " ").strip()),
            optional=name in _OPTIONAL,
        )
        for name in (*names, "damping", *_OPTIONAL)
    ]
