"""The Contact node in a real host."""

from __future__ import annotations

import json
from typing import Any


def node(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": f"PhysAnimator_{node_type}", "inputs": inputs}


def test_contact_and_its_colliders_reach_the_scene_and_its_document(host: Any) -> None:
    body = {"mesh": ["mesh", 0], "preset": "ribbon", "layer": 0, "attach": "left"}
    automatic = {"wind_strength": 2.0, "wind_angle": 0.0, "sway_by_size": True, "frame_rate": 12.0}
    touch = {"friction": 0.6, "thickness": 2.0, "self_contact": True}
    prompt = {
        "example": node("ExampleIllustration"),
        "mesh": node("MaskToMesh", mask=["example", 2], spacing=0.0, elements_across=3, mask_index=0),
        "body": node("Body", **body),
        "first": node("Contact", friction=0.0, thickness=1.0, self_contact=False, collider=["example", 3]),
        "contact": node("Contact", contact=["first", 0], **touch),
        "scene": node("AutomaticScene", bodies=["body", 0], contact=["contact", 0], **automatic),
        "simulate": node("Simulate", scene=["scene", 0], frames=4),
        "shown": {"class_type": "PreviewAny", "inputs": {"source": ["scene", 1]}},
        "preview": node("Render", image=["example", 0], motion=["simulate", 0]),
        "frames": {"class_type": "PreviewImage", "inputs": {"images": ["preview", 0]}},
    }
    outputs = host.run(prompt)
    document = json.loads(outputs["shown"]["text"][0])
    assert document["contact"] == touch
    assert [collider["region"]["type"] for collider in document["colliders"]] == ["mask"]
    assert len(outputs["frames"]["images"]) == 4
