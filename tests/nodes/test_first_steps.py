"""What a person sees first, in the stand-in: masks and meshes alone, and bodies that hold before anybody has drawn."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest
from PIL import Image

STROKE = {"kind": "wind", "path": [[0, 40], [160, 40]], "radius": 60, "speed": 300, "strength": 8}
PIN = {"position": [72, 70], "region": {"type": "circle", "radius": 12}}


def core(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": node_type, "inputs": inputs}


def ours(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return core(f"PhysAnimator_{node_type}", **inputs)


def bar() -> dict[str, Any]:
    """A white bar on black, as a mask and as a picture."""
    return {
        "black": core("SolidMask", value=0.0, width=160, height=96),
        "white": core("SolidMask", value=1.0, width=24, height=64),
        "mask": core("MaskComposite", destination=["black", 0], source=["white", 0], x=60, y=16, operation="add"),
        "picture": core("MaskToImage", mask=["mask", 0]),
    }


def edited(document: dict[str, Any], attach: str = "top") -> dict[str, Any]:
    return bar() | {
        "mesh": ours("MaskToMesh", mask=["mask", 0], spacing=8.0, elements_across=2, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach=attach),
        "editor": ours("SceneEditor", scene=json.dumps(document), bodies=["body", 0], image=["picture", 0]),
        "motion": ours("Simulate", scene=["editor", 0], frames=8),
        "render": ours("Render", image=["picture", 0], motion=["motion", 0]),
        "seen": core("PreviewImage", images=["render", 0]),
    }


def drawn(*, of: dict[str, Any] | None = None) -> dict[str, Any]:
    return {"version": 2, "width": 160, "height": 96, "strokes": [STROKE], **(of or {})}


def pictures(standin: Any, shown: dict[str, Any]) -> np.ndarray:
    return np.stack([np.asarray(Image.open(standin.file(saved))).astype(int) for saved in shown["images"]])


@pytest.mark.parametrize("named", [{}, {"bodies": [{"layer": 0}]}])
def test_a_stroke_on_a_fresh_body_leaves_it_where_it_is_attached(standin: Any, named: dict[str, Any]) -> None:
    outputs = standin.run(edited(drawn(of=named)))
    (hold,) = outputs["editor"]["physanimator_editor"][0]["holds"]
    assert hold["points"]
    frames = pictures(standin, outputs["seen"])
    assert frames[7, 17, 62:82].min() > 220, "the root stays"
    assert np.abs(frames[7, 60:80] - frames[0, 60:80]).max() > 200, "the tip swings"


@pytest.mark.parametrize(
    "said",
    [{"rig_points": []}, {"rig_points": [PIN]}, {"bodies": [{"attach": "none"}]}],
    ids=["none", "own", "nowhere"],
)
def test_who_says_where_a_body_is_held_has_the_word(standin: Any, said: dict[str, Any]) -> None:
    outputs = standin.run(edited(drawn(of=said)))
    assert outputs["editor"]["physanimator_editor"][0]["holds"] == []
    frames = pictures(standin, outputs["seen"])
    assert frames[7, 17, 62:82].min() < 150, "what holds it is not its top"


def test_a_body_that_is_attached_nowhere_is_not_held(standin: Any) -> None:
    info = standin.run(edited(drawn(), attach="bottom"))["editor"]["physanimator_editor"][0]
    assert info["holds"][0]["points"][0]["position"][1] > 60


def test_masks_and_meshes_run_on_their_own_and_show_what_is_cut(standin: Any) -> None:
    prompt = bar() | {"segment": ours("SegmentByPoints", image=["picture", 0], points="[[72, 40, 1]]")}
    (shown,) = pictures(standin, standin.run(prompt)["segment"])
    assert shown[40, 72].min() > 250
    prompt = bar() | {
        "mesh": ours("MaskToMesh", mask=["mask", 0], spacing=12.0, elements_across=1, mask_index=0,
                     image=["picture", 0]),
    }  # fmt: skip
    (shown,) = pictures(standin, standin.run(prompt)["mesh"])
    inside = shown[20:76, 62:82].reshape(-1, 3)
    tinted = (inside[:, 1] - inside[:, 0] > 25) & (inside[:, 0] > 100)
    assert tinted.mean() > 0.3, "the mask is laid over the picture in colour"
    assert shown[5, 5].max() < 10
