"""The scene editor and its routes in a real host."""

from __future__ import annotations

import io
import json
import socket
import struct
import urllib.error
import urllib.request
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example"

SIZE = {"version": 2, "width": 1280, "height": 720}
WIND = {"kind": "wind", "path": [[400, 100], [1000, 100]], "radius": 200, "speed": 1500, "strength": 3}
PIN = {"position": [560, 100], "region": {"type": "circle", "radius": 60}}
FRAME, END, ERROR = 1, 2, 3


def core(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": node_type, "inputs": inputs}


def ours(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return core(f"PhysAnimator_{node_type}", **inputs)


def editor(document: dict[str, Any] | str) -> dict[str, Any]:
    text = document if isinstance(document, str) else json.dumps(document)
    return {
        "example": ours("ExampleIllustration"),
        "mesh": ours("MaskToMesh", mask=["example", 2], spacing=0.0, elements_across=3, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="left"),
        "editor": ours("SceneEditor", scene=text, bodies=["body", 0], image=["example", 0]),
    }


@pytest.fixture(scope="module")
def info(host: Any) -> dict[str, Any]:
    return host.run(editor(SIZE))["editor"]["physanimator_editor"][0]


def ask(host: Any, body: Any, **headers: str) -> tuple[int, bytes]:
    request = urllib.request.Request(
        host.url + "/physanimator/preview", json.dumps(body).encode(), {"Content-Type": "application/json", **headers}
    )
    try:
        with urllib.request.urlopen(request, timeout=60) as answer:
            return answer.status, answer.read()
    except urllib.error.HTTPError as error:
        with error:
            return error.code, error.read()


def records(data: bytes) -> list[tuple[int, bytes]]:
    found, at = [], 0
    while at < len(data):
        kind, length = struct.unpack_from("<B3xI", data, at)
        found.append((kind, data[at + 8 : at + 8 + length]))
        at += 8 + length + (-length % 4)
    return found


def test_an_empty_scene_runs_and_tells_the_editor_what_it_draws_on(host: Any, info: dict[str, Any]) -> None:
    assert (info["width"], info["height"], info["plate"]) == (1280, 720, None)
    assert host.view(info["image"]).startswith(b"\x89PNG")
    data = host.read(f"/physanimator/mesh/{info['key']}")
    length = struct.unpack_from("<I", data)[0]
    header = json.loads(data[4 : 4 + length])
    vertices, triangles, bodies = (array["shape"][0] for array in header["arrays"])
    assert bodies == 1
    assert len(data) == 4 + length + (-length % 4) + 8 * vertices + 12 * triangles + 8


def test_a_preview_moves_as_the_queue_does(host: Any, info: dict[str, Any]) -> None:
    document = SIZE | {"strokes": [WIND], "rig_points": [PIN]}
    status, data = ask(host, {"editor": "a", "key": info["key"], "scene": document, "frames": 12})
    assert status == 200
    (_, header), *frames, (last, end) = records(data)
    assert last == END
    assert [struct.unpack_from("<I", payload)[0] for _, payload in frames] == list(range(12))
    described = json.loads(header)
    moved = np.frombuffer(frames[-1][1], "<i2", 2 * described["vertices"], 4) * described["unit"]
    assert np.abs(moved).max() > 3
    assert np.abs(moved).max() <= json.loads(end)["largest_displacement"] + described["unit"]
    prompt = editor(document) | {
        "simulate": ours("Simulate", scene=["editor", 0], frames=12),
        "preview": ours("PreviewMotion", image=["example", 0], motion=["simulate", 0], longest_side=640, every=2),
    }
    assert host.run(prompt)["preview"]["images"]


def test_what_is_wrong_comes_back_as_a_sentence(host: Any, info: dict[str, Any]) -> None:
    wrong = SIZE | {"strokes": [{**WIND, "radius": -1}]}
    status, data = ask(host, {"editor": "a", "key": info["key"], "scene": wrong, "frames": 12})
    assert (status, json.loads(data)["error"]) == (422, "strokes[0].radius: must be above 0 px. Got: -1")
    assert "strokes[0].radius" in host.error_of(editor(wrong))
    assert "the scene is not JSON" in host.error_of(editor("{"))


def test_only_the_host_s_own_pages_are_answered(host: Any, info: dict[str, Any]) -> None:
    body = {"editor": "a", "key": info["key"], "scene": SIZE, "frames": 2}
    assert ask(host, body, Origin=host.url)[0] == 200
    assert ask(host, body, **{"Sec-Fetch-Site": "cross-site"})[0] == 403
    assert ask(host, body, Origin="http://example.org")[0] == 403
    assert ask(host, body | {"key": "../../etc/passwd"})[0] == 422
    assert ask(host, body | {"key": "0" * 64})[0] == 404


def test_the_plate_is_made_when_asked_for(host: Any, info: dict[str, Any]) -> None:
    file = host.read(f"/physanimator/plate/{info['key']}")
    plate = np.asarray(Image.open(io.BytesIO(file)).convert("RGB")).astype(int)
    picture = np.asarray(Image.open(io.BytesIO(host.view(info["image"]))).convert("RGB")).astype(int)
    changed = np.abs(plate - picture).max(axis=2) > 8
    mask = np.asarray(Image.open(EXAMPLE / "mask_ribbon.png").convert("L")) > 0
    assert changed[mask].mean() > 0.5
    assert not changed[~mask].any()


def test_a_sprite_keeps_its_transparency(host: Any) -> None:
    prompt = editor(SIZE)
    prompt["around"] = core("SolidMask", value=1.0, width=1280, height=720)
    prompt["clear"] = core("CropMask", mask=["around", 0], x=0, y=0, width=300, height=720)
    prompt["none"] = core("SolidMask", value=0.0, width=1280, height=720)
    prompt["alpha"] = core("MaskComposite", destination=["none", 0], source=["clear", 0], x=0, y=0, operation="add")
    prompt["sprite"] = core("JoinImageWithAlpha", image=["example", 0], alpha=["alpha", 0])
    prompt["editor"]["inputs"] |= {"image": ["sprite", 0], "plate": ["sprite", 0]}
    told = host.run(prompt)["editor"]["physanimator_editor"][0]
    made = host.read(f"/physanimator/plate/{told['key']}")
    for file in (host.view(told["image"]), host.view(told["plate"]), made):
        shown = Image.open(io.BytesIO(file))
        assert shown.mode == "RGBA"
        opacity = np.asarray(shown)[..., 3]
        assert not opacity[:, :300].any()
        assert opacity[:, 1200:].min() == 255


def test_a_connected_plate_is_saved_and_must_fit(host: Any) -> None:
    prompt = editor(SIZE)
    prompt["editor"]["inputs"]["plate"] = ["example", 0]
    assert host.view(host.run(prompt)["editor"]["physanimator_editor"][0]["plate"]).startswith(b"\x89PNG")
    scaled = {"upscale_method": "area", "width": 640, "height": 360, "crop": "disabled"}
    prompt["small"] = core("ImageScale", image=["example", 0], **scaled)
    prompt["editor"]["inputs"]["plate"] = ["small", 0]
    assert "plate must be of the bodies' size, 1280 x 720 px. Got: 640 x 360 px" in host.error_of(prompt)


def test_a_client_that_goes_away_leaves_the_server_free(host: Any, info: dict[str, Any]) -> None:
    body = {"editor": "gone", "key": info["key"], "scene": SIZE | {"strokes": [WIND], "frame_rate": 1}, "frames": 1200}
    data = json.dumps(body).encode()
    lines = ["POST /physanimator/preview HTTP/1.1", "Host: x", "Content-Type: application/json"]
    head = "\r\n".join([*lines, f"Content-Length: {len(data)}", "", ""])
    for _ in range(12):
        with socket.create_connection(("127.0.0.1", host.port)) as client:
            client.sendall(head.encode() + data)
            assert client.recv(64)
    answered = [ask(host, {**body, "editor": str(k), "frames": 2})[0] for k in range(6)]
    assert answered == [200] * 6


def test_query_points_of_a_document_cut_the_part_out(host: Any) -> None:
    points = {"version": 2, "width": 640, "height": 360, "query_points": [{"x": 150, "y": 210}]}
    listed = [[300, 420, 1]]

    def cut(value: Any) -> np.ndarray:
        prompt = {
            "example": ours("ExampleIllustration"),
            "cut": ours("SegmentByPoints", image=["example", 0], points=json.dumps(value)),
            "shown": core("MaskPreview", mask=["cut", 0]),
        }
        file = host.view(host.run(prompt)["shown"]["images"][0])
        return np.asarray(Image.open(io.BytesIO(file)).convert("L"))

    mask = cut(points)
    assert 0 < mask.mean() < 255
    np.testing.assert_array_equal(mask, cut(listed))
    without = {**points, "query_points": []}
    prompt = {
        "example": ours("ExampleIllustration"),
        "cut": ours("SegmentByPoints", image=["example", 0], points=json.dumps(without)),
        "shown": core("PreviewImage", images=["cut", 1]),
    }
    assert "click on what shall move" in host.error_of(prompt)


def layered(document: dict[str, Any], *, bodies: bool, strands: bool = False, still: str = "plant") -> dict[str, Any]:
    moved = {"move": "", "still": still, "preset": "by name", "spacing": 0.0, "elements_across": 3, "strands": strands}
    given = {"bodies": ["bodies", 0]} if bodies else {"layers": ["load", 0]}
    return {
        "load": ours("LoadLayers", file="PhysAnimator example.psd"),
        **({"bodies": ours("ArtworkToBodies", layers=["load", 0], **moved)} if bodies else {}),
        "editor": ours("SceneEditor", scene=json.dumps(document), **given),
        "json": core("PreviewAny", source=["editor", 1]),
    }


@pytest.mark.parametrize("bodies", [False, True])
def test_what_moves_is_what_the_document_names(host: Any, bodies: bool) -> None:
    named = [{"name": "ribbon", "material": {"preset": "jelly"}}, {"name": "arms"}, {"name": "moustache"}]
    region = {"type": "layer", "name": "body"}
    document = {**SIZE, "bodies": named, "still": ["cape"], "colliders": [{"region": region}], "contact": {}}
    document["rig_points"] = [{**PIN, "body": 0}, {**PIN, "body": 2}]
    results = host.run(layered(document, bodies=bodies))
    (info,) = results["editor"]["physanimator_editor"]
    moving = ["back hair", "arms", "skirt", "front hair", "ribbon", *([] if bodies else ["plant"])]
    told = info["layers"]["layers"]
    assert [each["name"] for each in told if each["moving"]] == moving[::-1]
    assert {each["name"] for each in told if each["moves"]} == {*moving, "cape"} - {"arms"}
    written = json.loads(results["json"]["text"][0])
    assert [body["name"] for body in written["bodies"]] == moving
    assert written["bodies"][4]["material"]["name"] == "jelly"
    held = [point.get("body") for point in written["rig_points"]]
    assert held[-1] == 4, "the document's own pin"
    assert set(held[:-1]) == set(range(len(moving))) - {1, 4}, "layers that it has no word of are held"
    assert (written["still"], written["colliders"]) == (["cape"], [{"region": region}])
    assert any("moustache" in sentence for sentence in results["editor"]["advice"])
    drawn = info["layers"]["drawn"]
    assert [each["body"] for each in drawn if each["body"] is not None] == list(range(len(moving)))
    with urllib.request.urlopen(f"{host.url}/physanimator/layer/{info['key']}/{len(drawn) - 1}", timeout=60) as answer:
        picture = Image.open(io.BytesIO(answer.read()))
    assert picture.mode == "RGBA"
    assert list(picture.size) == drawn[-1]["box"][2:]
    status, body = ask(host, {"editor": "layers", "key": info["key"], "scene": document, "frames": 3})
    assert status == 200, body


def written(host: Any, document: dict[str, Any], **more: Any) -> dict[str, Any]:
    results = host.run(layered({**SIZE, **document}, **more))
    return json.loads(results["json"]["text"][0]) | {"told": results["editor"]["physanimator_editor"][0]}


@pytest.mark.parametrize("bodies", [False, True])
def test_layers_are_held_from_the_start_as_artwork_to_bodies_finds_it(host: Any, bodies: bool) -> None:
    first = written(host, {}, bodies=bodies)
    names = [body["name"] for body in first["bodies"]]
    assert {names[point["body"]] for point in first["rig_points"]} == set(names)
    automatic = ours("AutomaticScene", bodies=["bodies", 0], wind_strength=1.0, wind_angle=0.0, sway_by_size=True,
                     frame_rate=24.0)  # fmt: skip
    prompt = layered({**SIZE}, bodies=True, strands=not bodies, still="plant" if bodies else "")
    found = host.run({**prompt, "auto": automatic, "text": core("PreviewAny", source=["auto", 1])})["text"]["text"][0]
    assert first["rig_points"] == json.loads(found)["rig_points"]
    told = first["told"]["holds"]
    assert sum(len(each["points"]) for each in told) == len(first["rig_points"])
    assert [each["name"] for each in told] == names
    none = {"bodies": [{"name": name} for name in names], "rig_points": []}
    assert written(host, none, bodies=bodies)["rig_points"] == [], "what somebody has taken away stays away"
    said = {"bodies": [{"name": names[0], "attach": "bottom"}, {"name": names[1], "attach": "none"}]}
    again = written(host, said, bodies=bodies)
    assert 1 not in {point["body"] for point in again["rig_points"]}
    assert again["bodies"][0]["attach"] == "bottom"
    lowest, usual = (
        max(y for point in each["rig_points"] if point["body"] == 0 for _, y in point["region"]["points"])
        for each in (again, first)
    )
    assert lowest > usual


def test_a_layer_that_is_switched_on_beside_bodies_is_slit_as_from_the_start(host: Any) -> None:
    start = written(host, {}, bodies=False)["bodies"]
    slit = {body["name"] for body in start if body.get("strands")}
    assert "front hair" in slit
    on = {"bodies": [{"name": "front hair", "attach": "crown"}]}
    later = written(host, on, bodies=True, strands=True, still="front hair")
    assert {body["name"] for body in later["bodies"] if body.get("strands")} == slit
    assert {later["bodies"][point["body"]]["name"] for point in later["rig_points"]} == {body["name"] for body in start}
    contact = written(host, {**on, "contact": {}}, bodies=True, strands=False, still="front hair")
    assert [body["name"] for body in contact["bodies"] if body.get("strands")] == ["front hair"]
    none = written(host, {"bodies": [{"name": "front hair", "strands": False}]}, bodies=True, strands=True,
                   still="front hair")  # fmt: skip
    assert {body["name"] for body in none["bodies"] if body.get("strands")} == slit - {"front hair"}


@pytest.mark.parametrize("bodies", [False, True])
def test_layers_lie_in_the_order_of_the_document(host: Any, bodies: bool) -> None:
    turned = written(host, {"order": ["front hair", "face"]}, bodies=bodies)
    told = [each["name"] for each in turned["told"]["layers"]["layers"]]
    assert told.index("face") < told.index("front hair")
    assert turned["order"] == ["front hair", "face"]
    usual = written(host, {}, bodies=bodies)
    assert sorted(each["name"] for each in usual["told"]["layers"]["layers"]) == sorted(told)
    assert turned["told"]["key"] != usual["told"]["key"]


def test_layers_that_cannot_be_leant_on(host: Any) -> None:
    region = {"type": "layer", "name": "ribbon"}
    document = {**SIZE, "colliders": [{"region": region}], "contact": {}}
    error = host.error_of(layered(document, bodies=False))
    assert (
        "must be one that stands still; there are background, arms, body, collar, face. Got: ribbon, which moves"
        in error
    )
