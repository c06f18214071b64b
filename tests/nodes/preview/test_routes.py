"""The routes of the scene editor behind a web server like the host's, with well-meant and hostile requests."""

from __future__ import annotations

import asyncio
import io
import json
import random
import struct
import threading
import time
from collections.abc import AsyncIterator, Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from physanimator.nodes.preview import FRAME, HEADER, PreviewBodies, guard, routes, split_records
from physanimator.nodes.preview.limits import MAX_EDITORS, MAX_REQUEST_BYTES
from physanimator.nodes.preview.records import END, ERROR
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.interruption import checkpoint
from physanimator.rendering.layer_pictures import LayerPicture
from PIL import Image
from served_previews import PATIENCE, SCENE, Served, bodies, in_a_server


def test_a_scene_comes_back_frame_by_frame() -> None:
    async def test(server: Served) -> None:
        records = await server.stream(frames=30)
        assert [kind for kind, _ in records] == [HEADER, *[FRAME] * 30, END]
        assert json.loads(records[-1][1])["largest_displacement"] > 1
        mesh = await server.client.get(f"/physanimator/mesh/{server.key}")
        assert mesh.status == 200
        assert struct.unpack_from("<I", await mesh.read())[0] > 100

    in_a_server(test)


@pytest.mark.parametrize("path", ["mesh", "plate"])
@pytest.mark.parametrize("key", ["0" * 64, "x", "..%2f..%2fetc%2fpasswd", "A" * 64])
def test_unknown_keys(path: str, key: str) -> None:
    async def test(server: Served) -> None:
        answer = await server.client.get(f"/physanimator/{path}/{key}")
        assert answer.status == 404
        assert "run the graph once" in (await answer.json())["error"]

    in_a_server(test)


def test_layers_come_as_pictures_by_their_place() -> None:
    shown = np.random.default_rng(3).integers(0, 256, (2, 6, 5, 4), np.uint8)
    layers = tuple(LayerPicture(number, pixels, (0, 0, 5, 6), "normal") for number, pixels in enumerate(shown))
    stored = replace(bodies(), layers=layers)
    assert stored.key != bodies().key != replace(stored, layers=layers[:1]).key
    assert stored.size == bodies().size + shown.nbytes

    async def test(server: Served) -> None:
        for number, pixels in enumerate(shown):
            answer = await server.client.get(f"/physanimator/layer/{server.key}/{number}")
            assert answer.content_type == "image/png"
            np.testing.assert_array_equal(np.asarray(Image.open(io.BytesIO(await answer.read()))), pixels)
        for place in ("2", "-1", "x", "00000", "1e3", "%31%00", "9999999999999999999"):
            answer = await server.client.get(f"/physanimator/layer/{server.key}/{place}")
            assert answer.status == 404
        assert (await server.client.get(f"/physanimator/layer/{'0' * 64}/0")).status == 404

    in_a_server(test, stored)


def test_a_preview_leans_on_layers_by_name() -> None:
    def masks(name: str) -> np.ndarray:
        if name != "shoulder":
            raise InvalidInputError(f"layer must be one that stands still; there are shoulder. Got: {name}")
        return np.pad(np.ones((10, 30), bool), ((60, 10), (20, 50)))

    async def test(server: Served) -> None:
        scene = {**SCENE, "contact": {}, "colliders": [{"region": {"type": "layer", "name": "shoulder"}}]}
        assert (await server.ask(scene=scene)).status == 200
        scene["colliders"] = [{"region": {"type": "layer", "name": "knee"}}]
        answer = await server.ask(scene=scene)
        assert answer.status == 422
        assert "there are shoulder. Got: knee" in (await answer.json())["error"]

    in_a_server(test, replace(bodies(), layer_masks=masks))


def test_the_plate_is_made_once_and_has_lost_the_body() -> None:
    async def test(server: Served) -> None:
        path = f"/physanimator/plate/{server.key}"
        answers = await asyncio.gather(*(server.client.get(path) for _ in range(5)))
        files = {await answer.read() for answer in answers}
        assert [answer.content_type for answer in answers] == ["image/png"] * 5
        assert len(files) == 1
        picture = np.asarray(Image.open(io.BytesIO(files.pop())))
        np.testing.assert_allclose(picture[30, 40], (40, 90, 200), atol=12)
        np.testing.assert_array_equal(picture[70, 90], (40, 90, 200))

    in_a_server(test, bodies(picture=True))


def test_an_editor_that_opens_gets_the_solver_ready() -> None:
    begun: list[bool] = []

    async def test(server: Served) -> None:
        server.routes._warm_up = lambda: begun.append(True)
        foreign = await server.client.post("/physanimator/warm-up", headers={"Sec-Fetch-Site": "cross-site"})
        assert (foreign.status, begun) == (403, [])
        assert (await server.client.post("/physanimator/warm-up")).status == 204
        assert begun == [True]

    in_a_server(test)


def test_the_example_is_there_to_be_drawn_on() -> None:
    async def test(server: Served) -> None:
        answer = await server.client.get("/physanimator/example")
        assert answer.status == 200
        assert Image.open(io.BytesIO(await answer.read())).size == (1280, 720)

    in_a_server(test)


def test_without_a_picture_there_is_no_plate() -> None:
    async def test(server: Served) -> None:
        answer = await server.client.get(f"/physanimator/plate/{server.key}")
        assert answer.status == 409
        assert "Connect the illustration" in (await answer.json())["error"]

    in_a_server(test)


@pytest.mark.parametrize(
    ("changes", "status", "words"),
    [
        ({"scene": {**SCENE, "strokes": [{"radius": -1}]}}, 422, "strokes[0].radius: must be above 0 px. Got: -1"),
        ({"frames": 10**6}, 422, "frames must be a whole number from 1 to 1200"),
        ({"key": "0" * 64}, 404, "run the graph once"),
        ({"path": "/etc/passwd"}, 422, "an object with editor, frames, key, scene"),
    ],
)
def test_wrong_requests_are_answered_with_a_sentence(changes: dict[str, Any], status: int, words: str) -> None:
    async def test(server: Served) -> None:
        answer = await server.ask(**changes)
        assert answer.status == status
        assert words in (await answer.json())["error"]

    in_a_server(test)


OWN = "http://127.0.0.1:8188"


@pytest.mark.parametrize(
    ("headers", "status"),
    [
        ({}, 200),
        ({"Host": "127.0.0.1:8188", "Origin": OWN}, 200),
        ({"Host": "127.0.0.1:8188", "Origin": OWN, "Sec-Fetch-Site": "same-origin"}, 200),
        ({"Sec-Fetch-Site": "none"}, 200),
        ({"Sec-Fetch-Site": "same-site"}, 403),
        ({"Sec-Fetch-Site": "cross-site"}, 403),
        ({"Host": "127.0.0.1:8188", "Origin": "http://127.0.0.1:8000"}, 403),
        ({"Host": "127.0.0.1:8188", "Origin": "http://localhost:8188"}, 403),
        ({"Origin": "http://example.org"}, 403),
        ({"Origin": "https://proxied.example.org", "Sec-Fetch-Site": "same-origin"}, 200),
        ({"Origin": "null"}, 403),
        ({"Origin": ""}, 403),
        ({"Origin": "http://[::1"}, 403),
        ({"Content-Type": "text/plain"}, 415),
        ({"Content-Type": "application/x-www-form-urlencoded"}, 415),
    ],
)
def test_only_the_host_s_own_pages_are_answered(headers: dict[str, str], status: int) -> None:
    async def test(server: Served) -> None:
        content = {"Content-Type": "application/json"} | headers
        answer = await server.client.post("/physanimator/preview", data=json.dumps(server.body()), headers=content)
        await answer.read()
        assert answer.status == status
        mesh = await server.client.get(f"/physanimator/mesh/{server.key}", headers=headers)
        assert mesh.status == (200 if status == 415 else status)

    in_a_server(test)


@pytest.mark.parametrize("announced", [True, False])
def test_a_body_is_read_no_further_than_its_limit(announced: bool) -> None:
    sent = 0

    async def parts() -> AsyncIterator[bytes]:
        nonlocal sent
        while sent < 20 * MAX_REQUEST_BYTES:
            sent += 2**16
            yield b" " * 2**16

    async def test(server: Served) -> None:
        nonlocal sent
        data = io.BytesIO(b" " * (MAX_REQUEST_BYTES + 1)) if announced else parts()
        headers = {"Content-Type": "application/json"}
        answer = await server.client.post("/physanimator/preview", data=data, headers=headers)
        assert answer.status == 413
        assert "at most 4 MB" in (await answer.json())["error"]

    in_a_server(test)
    assert sent < 19 * MAX_REQUEST_BYTES


def test_a_body_that_never_ends_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(guard, "_BODY_SECONDS", 0.1)

    async def parts() -> AsyncIterator[bytes]:
        while True:
            yield b" "
            await asyncio.sleep(0.02)

    async def test(server: Served) -> None:
        headers = {"Content-Type": "application/json"}
        answer = await server.client.post("/physanimator/preview", data=parts(), headers=headers)
        assert answer.status == 413

    in_a_server(test)


def test_rig_points_of_bodies_that_are_not_there_shift_no_others() -> None:
    """The document has three; the first is of a body that is missing. A body that says so is held besides."""
    wave = {"motion": {"type": "wave", "amplitude": 8}, "region": {"type": "circle", "radius": 3}}
    points = [
        {"position": [5, 5], "body": 0, **wave},
        {"position": [22, 22], **wave},
        {"position": [40, 30], "body": 1, **wave},
    ]
    entries = [{"name": "tail"}, {"name": "hair"}, {"name": "cape", "attach": "top"}]
    scene = {**SCENE, "bodies": entries, "rig_points": points}
    (body,) = bodies().bodies
    named = PreviewBodies((replace(body, name="hair"), replace(body, name="cape")))

    async def test(server: Served) -> None:
        key = server.routes.store.put(named)
        records = await server.stream(scene=scene, key=key)
        header = json.loads(records[0][1])
        assert header["rig_points"] == 3
        assert header["points"] == [-1, 1, 2]

    in_a_server(test)


@pytest.mark.parametrize(
    ("attach", "top", "bottom"), [("found", 20, 26), ("top", 20, 26), ("bottom", 34, 40), ("none", 0, 0)]
)
def test_where_bodies_are_held_is_asked_for(attach: str, top: float, bottom: float) -> None:
    async def test(server: Served) -> None:
        answer = await server.client.get(f"/physanimator/holds/{server.key}/{attach}")
        (entry,) = await answer.json()
        assert (entry["body"], entry["name"]) == (0, "")
        if attach == "none":
            assert entry["points"] == []
            return
        (point,) = entry["points"]
        assert set(point) == {"position", "region"}
        down = [y for _, y in point["region"]["points"]]
        assert top - 8 <= min(down) <= max(down) <= bottom + 8

    in_a_server(test)


def test_sides_that_are_none_and_bodies_that_are_gone_are_refused() -> None:
    async def test(server: Served) -> None:
        answer = await server.client.get(f"/physanimator/holds/{server.key}/sideways")
        assert answer.status == 422
        assert "attach must be one of found, none, auto" in (await answer.json())["error"]
        assert (await server.client.get(f"/physanimator/holds/{'0' * 64}/found")).status == 404

    in_a_server(test)


def test_the_latest_request_of_an_editor_wins() -> None:
    async def test(server: Served) -> None:
        first = await server.ask(frames=1200, scene={**SCENE, "frame_rate": 1})
        head = await first.content.readexactly(8)
        records = await server.stream()
        assert records[-1][0] == END
        kind, payload = split_records(head + await first.read())[-1]
        assert (kind, json.loads(payload)) == (ERROR, {"error": "superseded"})

    in_a_server(test)


def test_a_client_that_goes_away_stops_its_simulation(monkeypatch: pytest.MonkeyPatch) -> None:
    ends: list[bytes] = []
    monkeypatch.setattr(routes.RecordQueue, "close", lambda _, last=b"": ends.append(last))

    async def test(server: Served) -> None:
        answer = await server.ask(frames=1200, scene={**SCENE, "frame_rate": 1})
        await answer.content.readexactly(8)
        assert len(server.routes.runs) == 1
        answer.close()
        await server.idle()
        assert [json.loads(payload)["error"] for _, payload in split_records(ends[0])] == ["The editor is gone."]

    in_a_server(test)


def test_more_editors_than_may_simulate_are_told_to_wait() -> None:
    async def test(server: Served) -> None:
        slow = {**SCENE, "frame_rate": 1}
        answers = [await server.ask(editor=str(k), frames=1200, scene=slow) for k in range(MAX_EDITORS)]
        late = await server.ask(editor="late")
        assert late.status == 429
        assert "busy" in (await late.json())["error"]
        for answer in answers:
            answer.close()
        await server.idle()
        assert (await server.stream(editor="late"))[-1][0] == END

    in_a_server(test)


def test_a_client_that_does_not_read_holds_the_simulation_back() -> None:
    async def test(server: Served) -> None:
        shown = 0
        encode = routes.RecordQueue.put

        def counted(queue: Any, data: bytes, check: Callable[[], None]) -> None:
            nonlocal shown
            shown += len(data)
            encode(queue, data, check)

        routes.RecordQueue.put = counted  # type: ignore[method-assign]
        try:
            answer = await server.ask(frames=1200, scene={**SCENE, "frame_rate": 240})
            before = -1
            while before != shown:
                before = shown
                await asyncio.sleep(0.3)
            assert shown < 14e6, "of 20 million bytes"
            assert len(server.routes.runs) == 1
            answer.close()
        finally:
            routes.RecordQueue.put = encode  # type: ignore[method-assign]

    in_a_server(test, bodies(columns=84, rows=50))


def test_a_client_that_never_reads_loses_its_place(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(routes, "_WRITE_SECONDS", 0.2)

    async def test(server: Served) -> None:
        answer = await server.ask(frames=1200, scene={**SCENE, "frame_rate": 240})
        await server.idle()
        answer.close()

    in_a_server(test, bodies(columns=84, rows=50))


def test_a_request_that_was_overtaken_gives_way(monkeypatch: pytest.MonkeyPatch) -> None:
    """The one that came first is checked for so long that the next one begins before it."""
    check, held = routes.preview_scene, threading.Event()

    def slow(request: Any, *of: Any) -> Any:
        if request.frames == 7:
            assert held.wait(PATIENCE)
        return check(request, *of)

    monkeypatch.setattr(routes, "preview_scene", slow)

    async def test(server: Served) -> None:
        first = asyncio.ensure_future(server.ask(frames=7))
        await asyncio.sleep(0.2)
        second = await server.ask(frames=1200, scene={**SCENE, "frame_rate": 1})
        await second.content.readexactly(8)
        held.set()
        records = split_records(await (await first).read())
        assert [json.loads(payload)["error"] for _, payload in records] == ["superseded"]
        assert len(server.routes.runs) == 1
        second.close()

    in_a_server(test)


def test_the_server_answers_while_it_simulates() -> None:
    async def test(server: Served) -> None:
        answer = await server.ask(frames=1200, scene={**SCENE, "frame_rate": 1})
        for _ in range(20):
            mesh = await server.client.get(f"/physanimator/mesh/{server.key}")
            assert mesh.status == 200
        assert len(server.routes.runs) == 1
        answer.close()

    in_a_server(test)


def test_a_failure_is_answered_without_its_secrets(monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(_: bytes) -> None:
        raise ZeroDivisionError("/home/secret")

    monkeypatch.setattr(routes, "read_request", fail)

    async def test(server: Served) -> None:
        answer = await server.ask()
        assert answer.status == 500
        assert "secret" not in await answer.text()
        assert "log" in (await answer.json())["error"]

    in_a_server(test)


numbers = st.integers() | st.floats() | st.sampled_from([0, -1, 1e308, float("nan"), float("inf"), 2**70])
anything = st.recursive(
    st.none() | st.booleans() | numbers | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5), inner, max_size=4),
    max_leaves=10,
)
mangled = st.dictionaries(st.sampled_from(["editor", "key", "frames", "scene", "extra"]), anything, max_size=2)
scenes = st.dictionaries(
    st.sampled_from(["strokes", "rig_points", "loop", "gravity", "paint", "contact", "wind", "frame_rate", "version"]),
    anything | numbers,
    max_size=2,
)
strokes = st.fixed_dictionaries(
    {"path": st.lists(st.lists(numbers, min_size=2, max_size=2), max_size=4)},
    optional={name: numbers for name in ("radius", "speed", "strength", "start", "end", "interval", "repeat")},
)
well_formed = st.fixed_dictionaries({"strokes": st.lists(strokes, max_size=3), "loop": st.none() | st.floats(0.1, 1)})
hostile = st.builds(lambda extra, scene: {"scene": SCENE | scene} | extra, mangled, scenes | well_formed)


@settings(deadline=None, max_examples=25, suppress_health_check=list(HealthCheck))
@given(requests=st.lists(hostile, min_size=1, max_size=12), seed=st.integers(0, 2**32))
def test_whatever_comes_at_once_is_answered_and_leaves_nothing_behind(
    requests: list[dict[str, Any]], seed: int
) -> None:
    """Some editors, some of whom go away at any time, and every answer complete or a sentence."""
    chance = random.Random(seed)

    async def one(server: Served, changes: dict[str, Any]) -> None:
        await asyncio.sleep(chance.random() * 0.05)
        body = {**server.body(editor=str(chance.randrange(6)), frames=chance.randrange(1, 40)), **changes}
        headers = {"Content-Type": "application/json"}
        answer = await server.client.post("/physanimator/preview", data=json.dumps(body), headers=headers)
        if chance.random() < 0.3:
            answer.close()
            return
        data = await answer.read()
        if answer.status == 200:
            records = split_records(data)
            assert records[0][0] in (HEADER, ERROR)
            assert records[-1][0] in (END, ERROR)
        else:
            assert answer.status in (404, 422, 429)
            assert json.loads(data)["error"]

    async def test(server: Served) -> None:
        await asyncio.wait_for(asyncio.gather(*(one(server, changes) for changes in requests)), PATIENCE)
        await server.idle()
        assert len(server.routes.store) == 1

    in_a_server(test)


def test_colliders_far_out_leave_the_preview_to_others() -> None:
    far = {"region": {"type": "polygon", "points": [[0, 0], [1e6, 1], [1e6, 60]]}}

    async def test(server: Served) -> None:
        scene = {**SCENE, "contact": {}, "colliders": [far, far]}
        answers = [await server.ask(editor=str(number % 3), scene=scene, frames=2) for number in range(10)]
        for answer in answers:
            answer.close()
        await server.idle()
        assert (await server.stream(editor="other"))[-1][0] == END

    in_a_server(test)


def test_what_is_prepared_for_nobody_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    begun, ended = threading.Event(), threading.Event()

    def endless(request: Any, *of: Any) -> Any:
        begun.set()
        try:
            while True:
                checkpoint()
                time.sleep(0.01)
        finally:
            ended.set()

    monkeypatch.setattr(routes, "preview_scene", endless)

    async def test(server: Served) -> None:
        asking = asyncio.ensure_future(server.ask())
        assert await asyncio.to_thread(begun.wait, PATIENCE)
        asking.cancel()
        await server.idle()
        assert ended.is_set()

    in_a_server(test)


def test_sizes_written_as_floats_are_counted() -> None:
    mask = {"type": "mask", "width": 16384.0, "height": 16384.0, "runs": [16384**2]}

    async def test(server: Served) -> None:
        for scene in ({"rig_points": [{"position": [0, 0], "region": mask}]}, {"paint": [{"region": mask}]}):
            answer = await server.ask(scene={**SCENE, **scene})
            assert answer.status == 422
            assert "at most 33,554,432 pixels" in (await answer.json())["error"]

    in_a_server(test)
