"""The published workflow that hands frames to the interpolation nodes of hosts newer than the oldest supported one.

An older host's frontend does not know these nodes and cannot save them: they are put into the quickstart as it was
exported, between its frames and its video, with the inputs that ``comfy_extras/nodes_frame_interpolation.py`` has.
"""

from __future__ import annotations

import copy
import uuid
from typing import Any

__all__ = ["NAME", "for_newer_hosts", "with_frame_interpolation"]

NAME = "frame_interpolation"
_NODES = {"FrameInterpolationModelLoader", "FrameInterpolate"}
_FILE, _MULTIPLIER, _RATE = "rife_v4.26.safetensors", 2, 48
_SOURCE = "https://huggingface.co/Comfy-Org/frame_interpolation"
_NOTE = f"""\
## Twice the frames, by RIFE or FILM

*Frame Interpolate* draws a frame between every two that *Render* gives: n frames become {_MULTIPLIER} n - 1, shown at \
{_RATE} frames a second instead of 24.

**Needs a ComfyUI that has *Load Frame Interpolation Model* and *Frame Interpolate*.** 0.8.0 has not: update, or \
connect *Render* to *Create Video*.

**Model file:** `models/frame_interpolation/{_FILE}`, or `film_net_fp16.safetensors`, from {_SOURCE}

**Fewer frames to render:** choose a lower *frame_rate* in *Automatic Scene* and a higher *multiplier*; *fps* in \
*Create Video* is their product. What swings must not turn round between two frames.
"""


def for_newer_hosts(api: dict[str, Any]) -> bool:
    """Whether a workflow in API format needs nodes that the oldest supported host lacks."""
    return any(node["class_type"] in _NODES for node in api.values())


def with_frame_interpolation(ui: dict[str, Any], api: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The quickstart in both formats, with frames drawn between those that it renders."""
    ui, api = copy.deepcopy(ui), copy.deepcopy(api)
    by_type = {node["type"]: node for node in ui["nodes"]}
    render, video, save = (by_type[name] for name in ("PhysAnimator_Render", "CreateVideo", "SaveVideo"))
    loader, drawn = _nodes(ui["last_node_id"], render)
    ui["id"] = str(uuid.uuid5(uuid.NAMESPACE_URL, f"physanimator/{NAME}"))
    by_type["MarkdownNote"]["widgets_values"] = [_NOTE]
    save["widgets_values"][0] = f"PhysAnimator/{NAME}"
    for node in (video, save):
        node["pos"][1] += 300
        node["order"] += 2
    ui["groups"][-1]["bounding"][3] += 300
    ui["nodes"] += [loader, drawn]
    ui["last_node_id"] = drawn["id"]
    _connect(ui, loader, drawn, video)
    api[str(loader["id"])] = _api("Load Frame Interpolation Model", loader, model_name=_FILE)
    links = {"interp_model": [str(loader["id"]), 0], "images": [str(render["id"]), 0]}
    api[str(drawn["id"])] = _api("Frame Interpolate", drawn, multiplier=_MULTIPLIER, **links)
    api[str(video["id"])]["inputs"] |= {"images": [str(drawn["id"]), 0], "fps": _RATE}
    api[str(save["id"])]["inputs"]["filename_prefix"] = f"PhysAnimator/{NAME}"
    return ui, api


def _nodes(last: int, render: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    left, top = render["pos"][0], render["pos"][1] + render["size"][1] + 105
    usual = {"flags": {}, "mode": 0, "order": render["order"] + 1}
    loader = usual | {
        "id": last + 1,
        "type": "FrameInterpolationModelLoader",
        "pos": [left, top],
        "size": [render["size"][0], 58],
        "inputs": [_slot("model_name", "COMBO", widget=True)],
        "outputs": [{"name": "INTERP_MODEL", "type": "INTERP_MODEL", "links": []}],
        "properties": {"Node name for S&R": "FrameInterpolationModelLoader"},
        "widgets_values": [_FILE],
    }
    drawn = usual | {
        "id": last + 2,
        "type": "FrameInterpolate",
        "pos": [left, top + 150],
        "size": [render["size"][0], 78],
        "order": render["order"] + 2,
        "inputs": [
            _slot("interp_model", "INTERP_MODEL"),
            _slot("images", "IMAGE"),
            _slot("multiplier", "INT", widget=True),
        ],
        "outputs": [{"name": "IMAGE", "type": "IMAGE", "links": []}],
        "properties": {"Node name for S&R": "FrameInterpolate"},
        "widgets_values": [_MULTIPLIER],
    }
    return loader, drawn


def _slot(name: str, kind: str, *, widget: bool = False) -> dict[str, Any]:
    return {"name": name, "type": kind, "link": None} | ({"widget": {"name": name}} if widget else {})


def _connect(ui: dict[str, Any], loader: dict[str, Any], drawn: dict[str, Any], video: dict[str, Any]) -> None:
    """From the frames through the new nodes to the video, whose rate no longer is the simulation's."""
    nodes = {node["id"]: node for node in ui["nodes"]}
    rate = next(slot for slot in video["inputs"] if slot["name"] == "fps")
    cut = next(link for link in ui["links"] if link[0] == rate["link"])
    nodes[cut[1]]["outputs"][cut[2]]["links"].remove(cut[0])
    ui["links"].remove(cut)
    rate["link"], video["widgets_values"] = None, [_RATE]

    frames = next(link for link in ui["links"] if link[3] == video["id"] and link[4] == 0)
    frames[3:5] = [drawn["id"], 1]
    drawn["inputs"][1]["link"] = frames[0]
    for source, target, slot in ((loader, drawn, 0), (drawn, video, 0)):
        ui["last_link_id"] += 1
        number, output = ui["last_link_id"], source["outputs"][0]
        output["links"].append(number)
        target["inputs"][slot]["link"] = number
        ui["links"].append([number, source["id"], 0, target["id"], slot, output["type"]])


def _api(title: str, node: dict[str, Any], **inputs: Any) -> dict[str, Any]:
    return {"inputs": inputs, "class_type": node["type"], "_meta": {"title": title}}
