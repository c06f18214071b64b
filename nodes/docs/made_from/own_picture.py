"""How a picture of one's own gets into ComfyUI: by the one node, where there is one, and step by step."""

from __future__ import annotations

import json
from pathlib import Path

from .markdown import table

__all__ = ["own_picture"]

_ONE_NODE = "PhysAnimator_AnimateIllustration"
_STEPS = (
    ("Load Image", "your picture"),
    ("PhysAnimator_SegmentByPoints", "*image* from **Load Image**; click on the part, and beside it"),
    ("PhysAnimator_MaskToMesh", "*mask* from **Segment by Points**, *image* from **Load Image**"),
    ("PhysAnimator_Body", "*mesh* from **Mask to Mesh**; *preset* is what the part is made of"),
    ("PhysAnimator_AutomaticScene", "*bodies* from **Body**; it holds them and blows"),
    ("PhysAnimator_Simulate", "*scene* from **Automatic Scene**"),
    ("PhysAnimator_SaveAnimation", "*image* from **Load Image**, *motion* from **Simulate**"),
)


def own_picture(root: Path) -> str:
    """What stands under *A picture of your own*, with links from the site's root."""
    schemas = json.loads((root / "tests" / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))
    parts = []
    if _ONE_NODE in schemas:
        parts.append(
            "Double-click on the empty canvas, type *animate illustration* and press Enter: one node,"
            f" [{schemas[_ONE_NODE]['display_name']}](made/nodes/{_ONE_NODE}.md). Drop your picture on it, click on"
            " what shall move, choose what that is made of, and press *Run*.\n\n"
            "To change each step by itself, or where other nodes make the mask, put these one after the other:\n"
        )
    else:
        parts.append("Put these nodes one after the other:\n")
    rows = [
        (f"[{schemas[name]['display_name']}](made/nodes/{name}.md)" if name in schemas else name, what)
        for name, what in _STEPS
    ]
    parts.append(table(("node", "what to connect"), rows))
    parts.append(
        "\nFor several parts, give each its own **Segment by Points**, **Mask to Mesh** and **Body**, and connect the"
        " *bodies* of one **Body** to the next. To draw the wind and the pins yourself, put"
        " [Scene Editor](made/nodes/PhysAnimator_SceneEditor.md) in the place of **Automatic Scene**, as in the"
        " template **scene_editor**.\n"
    )
    return "\n".join(parts)
