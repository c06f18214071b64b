"""Small graphs in which a bar moves, in the form that the host's API takes."""

from __future__ import annotations

from typing import Any

__all__ = ["core", "drawn_bar", "moving_bar", "ours"]


def core(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": node_type, "inputs": inputs}


def ours(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return core(f"PhysAnimator_{node_type}", **inputs)


def moving_bar(frames: int = 4) -> dict[str, Any]:
    """A white bar that hangs at its top and is blown to the right, as a picture and its motion."""
    return {
        "black": core("SolidMask", value=0.0, width=160, height=96),
        "white": core("SolidMask", value=1.0, width=24, height=64),
        "mask": core("MaskComposite", destination=["black", 0], source=["white", 0], x=60, y=16, operation="add"),
        "picture": core("MaskToImage", mask=["mask", 0]),
        "mesh": ours("MaskToMesh", mask=["mask", 0], spacing=8.0, elements_across=2, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="top"),
        "scene": ours("AutomaticScene", bodies=["body", 0], wind_strength=3.0, wind_angle=0.0, sway_by_size=True,
                      frame_rate=12.0),
        "motion": ours("Simulate", scene=["scene", 0], frames=frames),
    }  # fmt: skip


def drawn_bar(frames: int = 4) -> dict[str, Any]:
    """The same, drawn and shown."""
    return moving_bar(frames) | {
        "render": ours("Render", image=["picture", 0], motion=["motion", 0]),
        "seen": core("PreviewImage", images=["render", 0]),
    }
