"""Bad input in a real host: refused before any work where the value was typed, else in a sentence by the node."""

from __future__ import annotations

import asyncio
import json
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest


def core(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": node_type, "inputs": inputs}


def ours(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return core(f"PhysAnimator_{node_type}", **inputs)


def bar(width: int = 320, height: int = 180) -> dict[str, Any]:
    """An upright bar of 40 x 120 px as a mask, and a grey picture."""
    return {
        "black": core("SolidMask", value=0.0, width=width, height=height),
        "white": core("SolidMask", value=1.0, width=40, height=120),
        "mask": core("MaskComposite", destination=["black", 0], source=["white", 0], x=140, y=30, operation="add"),
        "picture": core("EmptyImage", width=width, height=height, batch_size=1, color=0x808080),
        "mesh": ours("MaskToMesh", mask=["mask", 0], spacing=10.0, elements_across=3, mask_index=0),
        "body": ours("Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="top"),
    }


def stroke(**changes: Any) -> dict[str, Any]:
    usual = {"kind": "wind", "path": "[[0, 90], [320, 90]]", "radius": 150.0, "speed": 600.0, "strength": 2.0,
             "start": 0.0, "end": 0.0, "interval": 0.5}  # fmt: skip
    return ours("EnergyStroke", **(usual | changes))


def pin(**changes: Any) -> dict[str, Any]:
    usual = {"position": "[[160, 30]]", "region": "circle", "region.radius": 30.0, "motion": "pinned", "body": -1}
    return ours("RigPoint", **(usual | changes))


def scene(**changes: Any) -> dict[str, Any]:
    usual = {"bodies": ["body", 0], "gravity_x": 0.0, "gravity_y": 0.0, "frame_rate": 24.0}
    return ours("Scene", **(usual | changes))


def seen(source: str, output: int = 1) -> dict[str, Any]:
    return {"end": core("PreviewAny", source=[source, output])}


def simulated(frames: int = 9) -> dict[str, Any]:
    return {
        "scene": scene(rig_points=["pin", 0], strokes=["stroke", 0]),
        "pin": pin(),
        "stroke": stroke(),
        "motion": ours("Simulate", scene=["scene", 0], frames=frames),
    }


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"path": "nonsense"}, "path"),
        ({"path": "[[0, 0], [1]]"}, "path[1]"),
        ({"path": "[[0, 0], [1, 1e999]]"}, "finite pixel coordinates"),
        ({"path": "[[5, 5]]"}, "2 different points"),
        ({"kind": "storm"}, "wind, repel, attract"),
        ({"radius": -1.0}, "radius must be above 0"),
        ({"interval": 0.0}, "interval must be 0.01"),
        ({"interval": 0.01, "speed": 0.1}, "particles are under way at once"),
        ({"start": 1.0, "end": 0.5}, "end must be after start"),
        ({"repeat": 1.0}, "repeat must be left out where the stroke has no end"),
        ({"strength_keys": "strong"}, "strength_keys must be a list of pairs"),
        ({"strength_keys": "[[0.5, 1], [0.2, 1]]"}, "strength_keys must be at increasing shares"),
        ({"speed_keys": "[[0, 0], [1, 2]]"}, "speed_keys must be factors from 0.001"),
    ],
)
def test_a_bad_stroke_is_refused_before_any_work(host: Any, changes: dict[str, Any], sentence: str) -> None:
    prompt = bar() | {"stroke": stroke(**changes), "scene": scene(strokes=["stroke", 0])} | seen("scene")
    status, answer = host.post("/prompt", {"prompt": prompt})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert list(answer["node_errors"]) == ["stroke"]
    assert sentence in json.dumps(answer)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"position": "[[1, 2], 3]"}, "position[1]"),
        ({"region": "blob"}, "region must be one of circle, polygon, mask"),
        ({"region": "polygon", "region.points": "[[0, 0], [1, 1]]"}, "at least 3 points"),
        ({"region.radius": 0.0}, "radius"),
        ({"motion": "path", "motion.points": "[[0, 0], [9, 9]]", "motion.times": "[0, 1, 2]"}, "times"),
        ({"motion": "path", "motion.points": "[[0, 0], [9, 9]]", "motion.times": "soon"}, "list of seconds"),
        ({"motion": "wave", "motion.amplitude": 5.0, "motion.period": 0.0, "motion.angle": 0.0}, "period"),
        ({"motion": "dance"}, "motion must be one of pinned, wave, path"),
    ],
)
def test_a_bad_rig_point_is_refused_before_any_work(host: Any, changes: dict[str, Any], sentence: str) -> None:
    prompt = bar() | {"pin": pin(**changes), "scene": scene(rig_points=["pin", 0])} | seen("scene")
    status, answer = host.post("/prompt", {"prompt": prompt})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert list(answer["node_errors"]) == ["pin"]
    assert sentence in json.dumps(answer)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("{", "line 1"),
        ("[]", "object"),
        ('{"version": 99, "width": 320, "height": 180}', "version"),
        ('{"version": 1, "width": 320, "height": 180, "strokes": [{"radius": -3}]}', "strokes[0].radius"),
        ('{"version": 1, "width": 320, "height": 180, "gravity": [0, NaN]}', "gravity[1]"),
    ],
)
def test_a_bad_scene_document_is_refused_before_any_work(host: Any, text: str, sentence: str) -> None:
    prompt = bar() | {"scene": ours("SceneFromJSON", bodies=["body", 0], scene=text)} | seen("scene")
    status, answer = host.post("/prompt", {"prompt": prompt})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert sentence in answer["node_errors"]["scene"]["errors"][0]["details"]


@pytest.mark.parametrize("points", ["", "{}", "[[1, 2, 7]]", "[[-5, 3]]"])
def test_bad_query_points_are_refused_before_any_work(host: Any, points: str) -> None:
    prompt = bar() | {"cut": ours("SegmentByPoints", image=["picture", 0], points=points)} | seen("cut", 0)
    status, answer = host.post("/prompt", {"prompt": prompt})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert "points" in answer["node_errors"]["cut"]["errors"][0]["details"]


@pytest.mark.parametrize("points", ["", "[]", '{"version": 2, "width": 320, "height": 180, "query_points": []}'])
def test_no_points_ask_for_a_click_before_any_work(host: Any, points: str) -> None:
    prompt = bar() | {"cut": ours("SegmentByPoints", image=["picture", 0], points=points)} | seen("cut", 0)
    status, answer = host.post("/prompt", {"prompt": prompt})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert "click on what shall move" in answer["node_errors"]["cut"]["errors"][0]["details"]


def test_an_unknown_backend_is_refused_before_any_work(host: Any) -> None:
    cut = ours("SegmentByPoints", image=["picture", 0], points="[[40, 10]]", backend="sam2")
    status, answer = host.post("/prompt", {"prompt": bar() | {"cut": cut} | seen("cut", 0)})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    assert "sam2" in json.dumps(answer)


@pytest.mark.parametrize(
    ("node", "named"),
    [
        (stroke(path="nonsense"), "path"),
        (stroke(end=0.5, start=1.0, speed_keys="[[0, 0], [1, 2]]"), "speed_keys"),
        (stroke(strength=float("nan")), "strength"),
        (pin(position="nowhere"), "position"),
        (ours("SegmentByPoints", image=["picture", 0], points="[[40, 10, 0]]"), "points"),
        (ours("SegmentByPoints", image=["picture", 0], points="[[40, 10]]", box="[1, 2]"), "box"),
    ],
)
def test_one_wrong_value_is_one_line(host: Any, node: dict[str, Any], named: str) -> None:
    status, answer = host.post("/prompt", {"prompt": bar() | {"wrong": node} | seen("wrong", 0)})
    # What needs nothing of the refused node, such as a preview of a mesh, runs: then it is 200.
    assert status == 400 or answer["node_errors"], answer
    (line,) = answer["node_errors"]["wrong"]["errors"]
    assert line["details"].startswith(f"{named} - {named}")
    assert line["extra_info"]["input_name"] == named
    if status == 400:
        assert answer["error"]["details"].count("\n") == 0


def test_the_same_scene_in_another_spelling_is_not_run_again(host: Any) -> None:
    document = {"version": 2, "width": 320, "height": 180, "strokes": [{"kind": "wind", "path": [[0, 90], [320, 90]]}]}
    respelled = json.dumps(dict(reversed(document.items())) | {"width": 320.0}, indent=3)
    ran = []
    for text in (json.dumps(document), respelled):
        edited = {"scene": ours("SceneEditor", bodies=["body", 0], scene=text)}
        prompt = bar() | edited | {"motion": ours("Simulate", scene=["scene", 0], frames=3)} | seen("motion")
        messages = dict(host.wait(host.queue(prompt))["status"]["messages"])
        ran.append({"scene", "motion", "end"} - set(messages["execution_cached"]["nodes"]))
    assert ran == [{"scene", "motion", "end"}, set()]


def test_most_of_the_picture_from_one_point_is_told(host: Any) -> None:
    prompt = bar() | {"cut": ours("SegmentByPoints", image=["picture", 0], points="[[5, 5]]")} | seen("cut", 0)
    assert "of the picture from one point" in " ".join(host.run(prompt)["cut"]["advice"])


def test_a_point_outside_the_picture(host: Any) -> None:
    prompt = bar() | {"cut": ours("SegmentByPoints", image=["picture", 0], points="[[400, 10]]")} | seen("cut", 0)
    assert "points[0] must lie inside the picture of 320 x 180 px. Got: (400, 10)" in host.error_of(prompt)


def mesh_of(mask: list[Any], **changes: Any) -> dict[str, Any]:
    usual = {"mask": mask, "spacing": 10.0, "elements_across": 3, "mask_index": 0}
    return {"tried": ours("MaskToMesh", **(usual | changes))} | seen("tried")


def test_an_empty_mask(host: Any) -> None:
    tiny = {"none": core("SolidMask", value=0.0, width=64, height=64)}
    said = host.error_of(bar() | tiny | mesh_of(["none", 0], image=["picture", 0]))
    assert "mask has no white" in said
    assert "mask editor" in said


def test_a_mask_that_is_not_in_the_batch(host: Any) -> None:
    said = host.error_of(bar() | mesh_of(["mask", 0], mask_index=3))
    assert "mask_index must be below the number of masks (1). Got: 3" in said


def test_a_mask_of_another_shape_than_the_picture(host: Any) -> None:
    other = {"other": core("EmptyImage", width=200, height=200, batch_size=1, color=0)}
    said = host.error_of(bar() | other | mesh_of(["mask", 0], image=["other", 0]))
    assert "mask" in said
    assert "320" in said
    assert "200" in said


def test_a_batch_where_one_picture_is_wanted(host: Any) -> None:
    many = {"many": core("EmptyImage", width=320, height=180, batch_size=4, color=0)}
    said = host.error_of(bar() | many | mesh_of(["mask", 0], image=["many", 0]))
    assert "image must be one picture" in said
    assert "batch of 4" in said


def test_a_scene_in_which_nothing_acts(host: Any) -> None:
    assert "Nothing acts on the bodies" in host.error_of(bar() | {"scene": scene()} | seen("scene"))


def test_a_rig_point_for_a_body_that_is_not_there(host: Any) -> None:
    prompt = bar() | {"pin": pin(body=4), "scene": scene(rig_points=["pin", 0])} | seen("scene")
    assert "rig_points[0].body must be below the number of bodies (1)" in host.error_of(prompt)


def test_an_unknown_material(host: Any) -> None:
    prompt = bar() | {"stuff": ours("Material", preset="granite")}
    prompt["body"]["inputs"]["material"] = ["stuff", 0]
    prompt |= {"scene": scene(gravity_y=1.0)} | seen("scene")
    assert "preset must be one of hair, ribbon" in host.error_of(prompt)


def test_work_that_would_never_end_is_refused(host: Any) -> None:
    stiff = {"preset": "custom", "preset.youngs_modulus": 1e6, "preset.poisson_ratio": 0.3, "preset.density": 1.0,
             "preset.damping": 1.0}  # fmt: skip
    prompt = bar() | simulated(frames=100_000) | {"stuff": ours("Material", **stiff)} | seen("motion")
    prompt["body"]["inputs"]["material"] = ["stuff", 0]
    prompt["mesh"]["inputs"]["spacing"] = 4.0
    said = host.error_of(prompt)
    assert "youngs_modulus" in said
    assert "make fewer frames" in said


@pytest.mark.parametrize("kind", ["Render", "PreviewMotion"])
def test_a_picture_of_another_size_than_the_motion(host: Any, kind: str) -> None:
    other = {"other": core("EmptyImage", width=300, height=180, batch_size=1, color=0)}
    extra = {"longest_side": 320, "every": 1} if kind == "PreviewMotion" else {}
    tried = {"tried": ours(kind, image=["other", 0], motion=["motion", 0], **extra)}
    said = host.error_of(bar() | simulated() | other | tried | seen("tried", 0))
    assert "image" in said
    assert "300" in said
    assert "320" in said


def test_a_sketch_of_another_size_than_the_flow(host: Any) -> None:
    other = {"other": core("EmptyImage", width=300, height=180, batch_size=1, color=0)}
    flow = {"flow": ours("OpticalFlow", motion=["motion", 0])}
    tried = {"tried": ours("WarpSketch", sketch=["other", 0], flow=["flow", 0], mode="paper", blur_sigma=1.0)}
    said = host.error_of(bar() | simulated() | other | flow | tried | seen("tried", 0))
    assert "320 x 180" in said or "(320, 180)" in said


def test_interrupting_a_simulation_leaves_the_host_ready(host: Any) -> None:
    short = bar() | simulated(frames=5)
    short |= {"tracks": ours("Tracks", motion=["motion", 0], points=5, static_points=0, frames=0, width=0, height=0,
                             fit="crop", weighting=0.5)} | seen("tracks")  # fmt: skip
    before = host.run(short)["end"]["text"]
    long = bar() | simulated(frames=3000) | seen("motion")
    long["mesh"]["inputs"]["spacing"] = 4.0
    # On a thread of its own, because the browser's driver keeps a loop on this one.
    with ThreadPoolExecutor(1) as pool:
        frame = pool.submit(asyncio.run, _interrupted(host, long, "motion")).result()
    assert 3 <= frame < 3000
    short["scene"]["inputs"]["frame_rate"] = 23.0  # once something else, so that nothing is taken from the cache
    host.run(short)
    short["scene"]["inputs"]["frame_rate"] = 24.0
    assert host.run(short)["end"]["text"] == before
    assert len({json.dumps(point) for track in json.loads(before[0]) for point in track}) > 10  # it moves


async def _interrupted(host: Any, prompt: dict[str, Any], busy: str) -> int:
    """Post a prompt, stop it in the middle of a node, and return how far that node had come."""
    import aiohttp

    async with aiohttp.ClientSession() as session, session.ws_connect(f"{host.url}/ws?clientId=watcher") as socket:
        answer = await session.post(f"{host.url}/prompt", json={"prompt": prompt, "client_id": "watcher"})
        assert answer.status == 200, await answer.text()
        reached = 0
        async for message in socket:
            told = json.loads(message.data) if message.type == aiohttp.WSMsgType.TEXT else {}
            if told.get("type") == "progress" and told["data"]["node"] == busy and told["data"]["value"] >= 3:
                if not reached:
                    await session.post(f"{host.url}/interrupt")
                reached = told["data"]["value"]
            assert told.get("type") not in ("execution_error", "execution_success"), told
            if told.get("type") == "execution_interrupted":
                assert told["data"]["node_id"] == busy
                return reached
    raise AssertionError("the connection closed")
