"""Contact: bodies that keep out of each other and of what stands still."""

from __future__ import annotations

from typing import TYPE_CHECKING

from comfy_api.latest import io

from ..physics.scene import Collider
from ..physics.scene import Contact as PhysicalContact
from .host import mask_of
from .host.field_inputs import input_of
from .host.wires import ContactWire, Touch

if TYPE_CHECKING:
    import torch

__all__ = ["Contact"]


class Contact(io.ComfyNode):
    @classmethod
    def define_schema(cls) -> io.Schema:
        return io.Schema(
            node_id="PhysAnimator_Contact",
            display_name="Contact (PhysAnimator)",
            category="PhysAnimator/scene",
            description="Lets bodies touch instead of passing through each other, and slide over still shapes.",
            inputs=[
                *(input_of(PhysicalContact, name) for name in ("friction", "thickness", "self_contact")),
                io.Mask.Input(
                    "collider",
                    optional=True,
                    tooltip="White where something stands still that bodies keep out of, such as a shoulder under hair."
                    " What lies over it as drawn may stay there until it comes off. For one that moves, see the help.",
                ),
                ContactWire.Input("contact", optional=True, tooltip="Contact whose colliders act besides this one."),
            ],
            outputs=[ContactWire.Output(display_name="contact", tooltip="For Scene or Automatic Scene.")],
        )

    @classmethod
    def execute(
        cls,
        friction: float,
        thickness: float,
        self_contact: bool,
        collider: torch.Tensor | None = None,
        contact: Touch | None = None,
    ) -> io.NodeOutput:
        colliders = () if contact is None else contact.colliders
        if collider is not None:
            colliders = (*colliders, Collider.from_mask(mask_of(collider, name="collider") > 0.5))
        return io.NodeOutput(Touch(PhysicalContact(friction, thickness, self_contact), colliders))
