"""What moves: materials, and bodies made of a mesh and a material."""

from __future__ import annotations

from typing import Any

from comfy_api.latest import io

from ..physics.material import PRESETS
from ..physics.material import Material as PhysicalMaterial
from ..physics.material import preset as preset_material
from ..physics.scene import ATTACHMENTS, Attachment
from ..physics.scene import Body as PhysicalBody
from .host import chosen
from .host.wires import BodiesWire, MaskedBody, MaskedMesh, MaterialWire, MeshWire

__all__ = ["Body", "Material"]

_CUSTOM = "custom"


class Material(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        options = [io.DynamicCombo.Option(name, _preset_inputs(made)) for name, made in PRESETS.items()]
        options.append(io.DynamicCombo.Option(_CUSTOM, _elastic_inputs(PhysicalMaterial())))
        return io.Schema(
            node_id="PhysAnimator_Material",
            display_name="Material",
            category="PhysAnimator/scene",
            description="What a body is made of. Presets look alike at any size of picture.",
            inputs=[
                io.DynamicCombo.Input(
                    "preset",
                    options=options,
                    tooltip="What the part is; its usual values appear below. 'custom' takes elastic constants.",
                )
            ],
            outputs=[MaterialWire.Output(display_name="material", tooltip="For the node Body.")],
        )

    @classmethod
    def execute(cls, preset: dict[str, Any] | None = None) -> io.NodeOutput:
        name, given = chosen(preset, "preset", (*PRESETS, _CUSTOM))
        values = {key: value for key, value in given.items() if value is not None}  # optional ones may be left out
        if "stretch_limit" in values:
            values["stretch_limit"] = values["stretch_limit"] or None
        return io.NodeOutput(PhysicalMaterial(**values) if name == _CUSTOM else preset_material(name, **values))


class Body(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Body",
            display_name="Body",
            category="PhysAnimator/scene",
            description="Makes a mesh a body that moves. Chain several Body nodes for several parts.",
            inputs=[
                MeshWire.Input("mesh", tooltip="Its shape, from Mask to Mesh."),
                io.Combo.Input(
                    "preset",
                    options=list(PRESETS),
                    default="hair",
                    tooltip="What it is made of. Connect a Material node to set your own values instead.",
                ),
                io.Int.Input(
                    "layer",
                    default=PhysicalBody.layer,
                    min=-99,
                    max=99,
                    tooltip="A higher layer covers a lower one; of equal layers, the later one in the chain does.",
                ),
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
        return io.NodeOutput((*bodies, MaskedBody(body, mesh.mask, attach)))


def _preset_inputs(material: PhysicalMaterial) -> list[io.Input]:
    return [_sway(material), _damping(material), *_shared_inputs(material)]


def _sway(material: PhysicalMaterial) -> io.Float.Input:
    return io.Float.Input(
        "sway_frequency",
        default=material.sway_frequency,
        min=0.05,
        max=20.0,
        step=0.05,
        display_name="sway frequency",
        tooltip="How often it swings to and fro about where it is held [Hz]: lower is softer and heavier.",
    )


def _damping(material: PhysicalMaterial) -> io.Float.Input:
    return io.Float.Input(
        "damping",
        default=material.damping,
        min=0.0,
        max=50.0,
        step=0.1,
        display_name="damping",
        tooltip="How fast it comes to rest [1/s]: 0 swings forever, 1.5 is a breeze, 10 moves as in honey.",
    )


def _shared_inputs(material: PhysicalMaterial) -> list[io.Input]:
    return [
        io.Float.Input(
            "stretch_limit",
            default=material.stretch_limit or 0.0,
            min=0.0,
            max=10.0,
            step=0.01,
            display_name="stretch limit",
            optional=True,
            tooltip="How many times as far as drawn a point gets from where the part is held, at most [1]: 1.06 hardly"
            " stretches and yet bends; 0 for no limit.",
        ),
        io.Float.Input(
            "wind_response",
            default=material.wind_response,
            min=0.0,
            max=100.0,
            step=0.1,
            display_name="wind response",
            optional=True,
            tooltip="How strongly wind and strokes act on it [1]: 1 is ordinary, 3 light as a ribbon, 0.5 heavy, 0 not"
            " at all.",
        ),
    ]


def _elastic_inputs(material: PhysicalMaterial) -> list[io.Input]:
    return [
        io.Float.Input(
            "youngs_modulus",
            default=material.youngs_modulus,
            min=0.1,
            max=1_000_000.0,
            step=10.0,
            display_name="Young's modulus",
            tooltip="Stiffness against stretching [density x side^2/s^2], a side being the picture's longest.",
        ),
        io.Float.Input(
            "poisson_ratio",
            default=material.poisson_ratio,
            min=0.0,
            max=0.49,
            step=0.01,
            display_name="Poisson's ratio",
            tooltip="How much a pull in one direction narrows the other [1]: 0 not at all, 0.45 like rubber.",
        ),
        io.Float.Input(
            "density",
            default=material.density,
            min=0.01,
            max=100.0,
            step=0.1,
            display_name="density",
            tooltip="Mass per area [1]; 1 is ordinary.",
        ),
        _damping(material),
        *_shared_inputs(material),
    ]
