"""Skeletons and scenes opened again: by readers of others where Node has them, and by the formats' own documents."""

from __future__ import annotations

import json
import shutil
import struct
import subprocess
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

READERS = Path(__file__).parent / "readers"

_PLACE = {"@esotericsoftware/spine-core": "read_spine.mjs", "@gltf-transform/core": "read_gltf.mjs",
          "gltf-validator": "check_gltf.mjs"}  # fmt: skip


def read_by_node(package: str, *arguments: str) -> Any:
    """What a script in ``readers`` prints; skips where Node or the package is not there."""
    node = shutil.which("node")
    if node is None or not (READERS / "node_modules" / package).is_dir():
        pytest.skip(f"{package} is not installed: npm install --prefix tests/readers")
    command = [node, str(READERS / _PLACE[package]), *arguments]
    done = subprocess.run(command, capture_output=True, text=True, encoding="utf-8", timeout=120)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def spine_by_its_runtime(folder: Path, times: list[float]) -> dict[str, Any]:
    """A skeleton as Spine's own runtime draws it at some times."""
    stem = folder.name
    asked = ",".join(map(repr, times))
    read = read_by_node(
        "@esotericsoftware/spine-core", str(folder / f"{stem}.json"), str(folder / f"{stem}.atlas"), asked
    )
    assert read["version"].startswith("4.2")
    return read


def spine_by_its_format(folder: Path, times: list[float]) -> dict[str, Any]:
    """The same from the files alone, as the format's page describes them, for meshes without weights."""
    data = json.loads((folder / f"{folder.name}.json").read_text("utf-8"))
    (skin,) = data["skins"]
    (animation,) = data["animations"].values()
    deforms = animation.get("attachments", {}).get("default", {})
    boxes = _regions((folder / f"{folder.name}.atlas").read_text("utf-8"))
    frames = [
        [_drawn(slot, skin["attachments"][slot["name"]], deforms.get(slot["name"], {}), boxes, time)
         for slot in data["slots"]]
        for time in times
    ]  # fmt: skip
    ends = [key.get("time", 0) for slot in deforms.values() for each in slot.values() for key in each["deform"]]
    head = data["skeleton"]
    return {"version": head["spine"], "fps": head["fps"], "duration": max(ends, default=0), "x": head["x"],
            "width": head["width"], "height": head["height"], "frames": frames}  # fmt: skip


def _regions(atlas: str) -> dict[str, tuple[str, tuple[int, int], list[int]]]:
    found, page, size, region = {}, "", (0, 0), ""
    for line in atlas.splitlines():
        if not line:
            page = ""
        elif ":" not in line:
            page, region = (line, "") if not page else (page, line)
        elif line.startswith("size:"):
            size = tuple(map(int, line[5:].split(",")))
        elif line.startswith("bounds:"):
            found[region] = (page, size, list(map(int, line[7:].split(","))))
    return found


def _drawn(slot: dict, attachments: dict, deform: dict, boxes: dict, time: float) -> dict[str, Any]:
    name = slot["attachment"]
    made = attachments[name]
    page, (width, height), (left, top, across, down) = boxes[name]
    blend = ["normal", "additive", "multiply", "screen"].index(slot.get("blend", "normal"))
    common = {"slot": slot["name"], "blend": blend, "page": page}
    if made.get("type", "region") == "region":
        x, y = made["width"] / 2, made["height"] / 2
        vertices = np.array([[-x, -y], [-x, y], [x, y], [x, -y]]) + (made["x"], made["y"])
        uvs, triangles, hull = np.array([[0, 1], [0, 0], [1, 0], [1, 1]]), [0, 1, 2, 2, 3, 0], 4
    else:
        vertices = np.array(made["vertices"]).reshape(-1, 2)
        uvs, triangles, hull = np.array(made["uvs"]).reshape(-1, 2), made["triangles"], made["hull"]
        vertices = vertices + _offsets(deform[name]["deform"], vertices.size, time) if name in deform else vertices
    uvs = (np.array([left, top]) + uvs * (across, down)) / (width, height)
    return {**common, "vertices": vertices.ravel(), "uvs": uvs.ravel(), "triangles": triangles, "hull": hull}


def _offsets(keys: list[dict], count: int, time: float) -> np.ndarray:
    rows = np.zeros((len(keys), count))
    for row, key in zip(rows, keys, strict=True):
        given = key.get("vertices", [])
        row[key.get("offset", 0) : key.get("offset", 0) + len(given)] = given
    at = [key.get("time", 0) for key in keys]
    return np.stack([np.interp(time, at, column) for column in rows.T]).reshape(-1, 2)


def pages_of(folder: Path) -> dict[str, np.ndarray]:
    """The pages of a skeleton's atlas, straight RGBA."""
    return {file.name: np.asarray(Image.open(file).convert("RGBA")) for file in folder.glob("*.png")}


def gltf_by_its_format(path: Path) -> tuple[dict[str, Any], list[dict[str, Any]]]:
    """The document of a .glb file, and its meshes with what moves them, as ``readers/read_gltf.mjs`` gives them."""
    data = path.read_bytes()
    magic, version, size, length, kind = struct.unpack_from("<4sIIII", data)
    assert (magic, version, size, kind) == (b"glTF", 2, len(data), 0x4E4F534A)
    document = json.loads(data[20 : 20 + length])
    start = 20 + length + 8

    def array(number: int) -> np.ndarray:
        accessor = document["accessors"][number]
        view = document["bufferViews"][accessor["bufferView"]]
        kinds = {5126: "<f4", 5123: "<u2", 5125: "<u4"}
        part = data[start + view["byteOffset"] : start + view["byteOffset"] + view["byteLength"]]
        across = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}[accessor["type"]]
        return np.frombuffer(part, kinds[accessor["componentType"]], count=accessor["count"] * across)

    (root,) = (document["nodes"][number] for number in document["scenes"][0]["nodes"])
    (animation,) = document.get("animations", [{"channels": [], "samplers": []}])
    meshes = []
    for number in root["children"]:
        node = document["nodes"][number]
        (primitive,) = document["meshes"][node["mesh"]]["primitives"]
        sampler = next((each["sampler"] for each in animation["channels"] if each["target"]["node"] == number), None)
        keyed = {"input": None} if sampler is None else animation["samplers"][sampler]
        meshes.append(
            {
                "name": node["name"],
                "rest": array(primitive["attributes"]["POSITION"]),
                "places": array(primitive["attributes"]["TEXCOORD_0"]).reshape(-1, 2),
                "triangles": array(primitive["indices"]).reshape(-1, 3),
                "targets": [array(target["POSITION"]) for target in primitive.get("targets", [])],
                "times": [] if keyed["input"] is None else array(keyed["input"]),
                "weights": [] if keyed["input"] is None else array(keyed["output"]),
            }
        )
    return document, meshes


def morphed(mesh: dict[str, Any], frame: int) -> np.ndarray:
    """Vertices of a mesh at the time of a key, shape [v, 3]."""
    vertices = np.array(mesh["rest"], dtype=np.float64)
    count = len(mesh["targets"])
    for weight, target in zip(mesh["weights"][frame * count : (frame + 1) * count], mesh["targets"], strict=True):
        vertices = vertices + weight * np.array(target)
    return vertices.reshape(-1, 3)
