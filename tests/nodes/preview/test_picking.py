"""What an editor is shown while somebody picks: the cut that the node makes, what moves it, and the newest."""

from __future__ import annotations

import asyncio
import io
import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.nodes.preview import layers
from physanimator.nodes.preview.limits import MAX_PICKED_POINTS
from physanimator.nodes.preview.turns import Turns
from physanimator.physics.errors import Cancelled
from physanimator.rendering.artwork import ArtLayer, Artwork, save_psd
from PIL import Image
from served_previews import Served, in_a_server

PAPER, RED, BLUE = (235, 230, 220), (200, 40, 40), (40, 60, 200)
MOVE = {"preset": "auto", "wind": 1.0, "wind_angle": 0.0, "loop": 0.0, "frames": 12, "fps": 24.0}
POINTS = [{"x": 60, "y": 40}, {"x": 140, "y": 40, "part": 1}]


@pytest.fixture(scope="module")
def standin(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    from standin import StandIn, installed

    with installed():
        yield StandIn(tmp_path_factory.mktemp("picking"))


@pytest.fixture(scope="module")
def bars(standin: Any) -> str:
    drawn = np.full((120, 200, 3), PAPER, np.uint8)
    drawn[20:26, 30:170] = (60, 50, 40)
    drawn[26:100, 50:74], drawn[26:100, 130:154] = RED, BLUE
    Image.fromarray(drawn).save(standin.folder / "input" / "bars.png")
    return "bars.png"


def document(points: list[dict[str, Any]], **more: Any) -> dict[str, Any]:
    return {"version": 2, "width": 200, "height": 120, "query_points": points, **more}


def asked(picture: str | None, points: list[dict[str, Any]], **changes: Any) -> dict[str, Any]:
    usual = {"editor": "one", "alpha": False, "cleaning": {}, "move": None}
    return {**usual, "picture": picture, "points": document(points), **changes}


def mask_of(cut: dict[str, Any]) -> np.ndarray:
    painted = np.arange(len(cut["runs"])) % 2
    return np.repeat(painted, cut["runs"]).reshape(cut["height"], cut["width"]).astype(bool)


async def pick(server: Served, body: Any) -> tuple[int, Any]:
    answer = await server.client.post("/physanimator/pick", json=body)
    return answer.status, await answer.json()


def test_the_cut_is_the_very_mask_that_the_node_gives(standin: Any, bars: str) -> None:
    cleaning = {"box": "", "smallest_speck": 9, "largest_hole": 30, "smoothing": 1.0}
    prompt = {
        "load": {"class_type": "LoadImage", "inputs": {"image": bars}},
        "segment": {
            "class_type": "PhysAnimator_SegmentByPoints",
            "inputs": {"image": ["load", 0], "points": json.dumps(document(POINTS)), **cleaning},
        },
        "shapes": {"class_type": "MaskToImage", "inputs": {"mask": ["segment", 0]}},
        "seen": {"class_type": "PreviewImage", "inputs": {"images": ["shapes", 0]}},
    }
    outputs = standin.run(prompt)
    of_node = [np.asarray(Image.open(standin.file(saved)))[..., 0] > 127 for saved in outputs["seen"]["images"]]

    async def test(server: Served) -> None:
        status, found = await pick(server, asked(bars, POINTS, cleaning=cleaning))
        assert (status, found["width"], found["height"]) == (200, 200, 120)
        assert [cut["part"] for cut in found["cuts"]] == [0, 1]
        assert all(np.array_equal(mask_of(cut), mask) for cut, mask in zip(found["cuts"], of_node, strict=True))
        assert "key" not in found

    in_a_server(test)


def test_what_is_picked_is_simulated_as_the_node_does(bars: str) -> None:
    async def test(server: Served) -> None:
        bodies = [{"material": {"preset": "cloth"}}]
        body = asked(bars, POINTS, move=MOVE) | {"points": document(POINTS, bodies=bodies)}
        status, found = await pick(server, body)
        assert status == 200
        presets = [entry["material"]["name"] for entry in found["scene"]["bodies"]]
        assert presets == ["cloth", "hair"]
        assert found["scene"]["rig_points"]
        records = await server.stream(key=found["key"], scene=found["scene"], frames=found["frames"])
        assert json.loads(records[0][1])["unheld"] == []
        assert json.loads(records[-1][1])["largest_displacement"] > 0.5
        held = found["scene"] | {"rig_points": []}
        records = await server.stream(key=found["key"], scene=held, frames=3)
        assert json.loads(records[0][1])["unheld"] == [0, 1]
        again = await pick(server, body | {"move": MOVE | {"wind_angle": 90.0}})
        assert again[1]["key"] == found["key"]
        assert again[1]["scene"]["strokes"] != found["scene"]["strokes"]

    in_a_server(test)


def test_what_is_too_small_to_move_is_said_once_and_the_rest_moves(standin: Any) -> None:
    drawn = np.full((120, 200, 3), PAPER, np.uint8)
    drawn[20:100, 50:74], drawn[60, 150] = RED, BLUE
    Image.fromarray(drawn).save(standin.folder / "input" / "dot.png")
    bar, dot = {"x": 60, "y": 40}, {"x": 150, "y": 60}

    async def test(server: Served) -> None:
        status, found = await pick(server, asked("dot.png", [dot], move=MOVE))
        assert (status, len(found["cuts"]), mask_of(found["cuts"][0]).sum()) == (200, 1, 1)
        assert "key" not in found
        assert [
            each.startswith("The point on the part cut out hardly more than itself") for each in found["advice"]
        ] == [True]
        status, found = await pick(server, asked("dot.png", [dot, bar | {"part": 1}], move=MOVE))
        assert (status, len(found["cuts"]), len(found["scene"]["bodies"])) == (200, 2, 1)
        assert sum("hardly more than itself" in each for each in found["advice"]) == 1
        presets = [{}, {"material": {"preset": "cloth"}}]
        body = asked("dot.png", [], move=MOVE) | {"points": document([dot, bar | {"part": 1}], bodies=presets)}
        status, found = await pick(server, body)
        assert [entry["material"]["name"] for entry in found["scene"]["bodies"]] == ["cloth"]

    in_a_server(test)


def test_the_example_needs_no_file_and_nothing_else_can_be_named(standin: Any, bars: str, tmp_path: Path) -> None:
    Image.new("RGB", (20, 20), "white").save(standin.folder / "outside.png")
    (standin.folder / "input" / "text.png").write_text("no picture")
    Image.new("L", (4200, 4000)).save(standin.folder / "input" / "large.png")

    async def test(server: Served) -> None:
        size = {"width": 1280, "height": 720}
        points = document([{"x": 620, "y": 60}]) | size
        status, found = await pick(server, asked(None, []) | {"points": points})
        assert (status, found["width"]) == (200, 1280)
        for name in (
            "../outside.png",
            "gone.png",
            "",
            "a\0b",
            "a" * 5000,
            str(standin.folder / "outside.png"),
            "bars.png [temp]",
        ):
            status, found = await pick(server, asked(name, POINTS))
            assert status == 422, name
            assert "picture must be a file of the host's" in found["error"]
        for alpha in (False, True):
            status, found = await pick(server, asked("large.png", POINTS) | {"alpha": alpha})
            assert (status, "4200 x 4000 px" in found["error"]) == (422, True)
        status, found = await pick(server, asked("text.png", POINTS))
        assert (status, "can be read" in found["error"]) == (422, True)

    in_a_server(test)


def test_a_layered_file_is_shown_before_its_node_has_run(standin: Any) -> None:
    clear, red, blue = np.zeros((3, 20, 30, 4), np.uint8)
    red[:, :15], blue[:, 10:] = (*RED, 255), (*BLUE, 255)
    layers = ArtLayer("paper", red), ArtLayer("hair", blue), ArtLayer("notes", red + 1, visible=False)
    save_psd(Artwork(30, 20, layers, ()), standin.folder / "input" / "girl.psd")
    (standin.folder / "input" / "words.txt").write_text("no layers")
    (standin.folder / "secret.psd").write_bytes((standin.folder / "input" / "girl.psd").read_bytes())

    async def test(server: Served) -> None:
        answer = await server.client.get("/physanimator/artwork", params={"file": "girl.psd"})
        assert (answer.status, answer.content_type) == (200, "image/png")
        with Image.open(io.BytesIO(await answer.read())) as shown:
            pixels = np.asarray(shown.convert("RGBA"))
        assert pixels.shape == clear.shape
        assert (pixels[5, 3].tolist(), pixels[5, 12].tolist()) == ([*RED, 255], [*BLUE, 255])
        for name in ("../secret.psd", "words.txt", "gone.psd", "", ".", "a" * 5000):
            answer = await server.client.get("/physanimator/artwork", params={"file": name})
            assert (answer.status, len((await answer.json())["error"]) > 20) == (422, True), name

    in_a_server(test)


def bars_in_layers(names: tuple[str, str]) -> Artwork:
    paper = np.full((120, 200, 4), (*PAPER, 255), np.uint8)
    red, blue = (np.full((74, 24, 4), (*colour, 255), np.uint8) for colour in (RED, BLUE))
    layers = ArtLayer("Layer 0", paper), ArtLayer(names[0], red, 50, 26), ArtLayer(names[1], blue, 130, 26)
    return Artwork(200, 120, layers)


def test_of_a_layered_file_the_clicked_layer_is_cut_out_and_moves(standin: Any) -> None:
    save_psd(bars_in_layers(("Layer 1", "Layer 1")), standin.folder / "input" / "bars.psd")

    async def test(server: Served) -> None:
        status, found = await pick(server, asked("bars.psd", [], move=MOVE))
        assert (status, found["cuts"], "key" in found) == (200, [], False)
        points = [{"x": 140, "y": 40}]
        status, found = await pick(server, asked("bars.psd", points, move=MOVE | {"preset": "ribbon"}))
        assert status == 200
        (cut,) = found["cuts"]
        mask = mask_of(cut)
        assert (cut["part"], mask.sum(), mask[26:100, 130:154].all()) == (0, 74 * 24, True)
        assert [body["material"]["name"] for body in found["scene"]["bodies"]] == ["ribbon"]
        assert [(each["layer"], each["body"]) for each in found["drawn"]] == [(0, None), (1, None), (2, 0)]
        records = await server.stream(key=found["key"], scene=found["scene"], frames=found["frames"])
        assert json.loads(records[0][1])["unheld"] == []
        assert json.loads(records[-1][1])["largest_displacement"] > 0.5
        picture = await server.client.get(f"/physanimator/layer/{found['key']}/2")
        assert picture.status == 200
        status, found = await pick(server, asked("bars.psd", [{"x": 10, "y": 10}], move=MOVE))
        assert (found["cuts"], "Part 1: the layer Layer 0 fills" in found["advice"][0]) == ([], True)

    in_a_server(test)


def test_layers_that_move_by_name_are_cut_out_without_a_click(standin: Any) -> None:
    save_psd(bars_in_layers(("front hair", "thing")), standin.folder / "input" / "named.psd")

    async def test(server: Served) -> None:
        _, found = await pick(server, asked("named.psd", [], move=MOVE))
        assert ([cut["part"] for cut in found["cuts"]], len(found["scene"]["bodies"])) == ([-1], 1)
        _, found = await pick(server, asked("named.psd", [POINTS[1]], move=MOVE))
        assert [cut["part"] for cut in found["cuts"]] == [-1, 1]
        _, found = await pick(server, asked("named.psd", [{"x": 60, "y": 40, "positive": False}], move=MOVE))
        assert (found["cuts"], "key" in found) == ([], False)

    in_a_server(test)


def test_of_large_layers_the_cut_is_coarser_and_of_too_large_ones_there_is_none(
    standin: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    save_psd(bars_in_layers(("hair", "hair")), standin.folder / "input" / "large.psd")

    async def test(server: Served) -> None:
        monkeypatch.setattr(layers, "MAX_PICKED_SIZE", 120 * 200 // 2)
        _, found = await pick(server, asked("large.psd", [], move=MOVE))
        assert [(cut["width"], cut["height"]) for cut in found["cuts"]] == [(100, 60)] * 2
        assert mask_of(found["cuts"][0])[13:50, 25:37].all()
        monkeypatch.setattr(layers, "MAX_PICKED_PIXELS", 100)
        save_psd(bars_in_layers(("hair", "lock")), standin.folder / "input" / "larger.psd")
        status, found = await pick(server, asked("larger.psd", [], move=MOVE))
        assert (status, "too large to be cut while you click" in found["error"]) == (422, True)

    in_a_server(test)


def test_a_layered_file_of_one_layer_is_cut_as_a_flat_picture(standin: Any, bars: str) -> None:
    pixels = np.asarray(Image.open(standin.folder / "input" / bars).convert("RGBA"))
    save_psd(Artwork(200, 120, (ArtLayer("Background", pixels),)), standin.folder / "input" / "flat.psd")

    async def test(server: Served) -> None:
        assert (await pick(server, asked("flat.psd", [])))[1]["cuts"] == []
        _, of_psd = await pick(server, asked("flat.psd", POINTS))
        _, of_png = await pick(server, asked(bars, POINTS))
        assert of_psd["cuts"] == of_png["cuts"]

    in_a_server(test)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"editor": ""}, "editor"),
        ({"alpha": 1}, "alpha"),
        ({"points": []}, "points"),
        ({"points": document([{"x": 900, "y": 4}])}, "must lie inside the picture"),
        ({"points": document([{"x": 1 + i / 9, "y": 4} for i in range(MAX_PICKED_POINTS + 1)])}, "at most"),
        ({"points": document(POINTS, bodies=[{"material": {"preset": "stone"}}])}, "must be one of"),
        ({"cleaning": {"smoothing": -1}}, "smoothing"),
        ({"cleaning": {"box": "[1"}}, "box"),
        ({"cleaning": {"file": "x"}}, "cleaning"),
        ({"move": {}}, "move"),
        ({"move": MOVE | {"frames": 0}}, "frames"),
        ({"move": MOVE | {"wind": "strong"}}, "wind"),
        ({"move": MOVE | {"preset": "stone"}}, "preset"),
        ({"move": MOVE | {"fps": 0}}, "frame_rate"),
        ({"more": 1}, "the request"),
    ],
)
def test_a_wrong_request_is_told_in_a_sentence(bars: str, changes: dict[str, Any], told: str) -> None:
    async def test(server: Served) -> None:
        status, found = await pick(server, asked(bars, POINTS) | changes)
        assert status == 422
        assert told in found["error"]

    in_a_server(test)


def test_the_newest_wins_and_nobody_else_waits() -> None:
    async def run() -> list[str]:
        turns, told = Turns(), list[str]()
        begun, go = asyncio.Event(), asyncio.Event()

        async def work(name: str, order: int, editor: str = "one") -> None:
            try:
                async with turns.of(editor, order) as turn:
                    if name == "first":
                        begun.set()
                        await go.wait()
                    turn.check()
                    told.append(name)
            except Cancelled:
                told.append(f"not {name}")

        first = asyncio.create_task(work("first", 1))
        await begun.wait()
        others = [asyncio.create_task(work(name, order)) for name, order in (("second", 2), ("third", 3))]
        await work("of another editor", 4, "two")
        go.set()
        await asyncio.gather(first, *others)
        assert len(turns) <= 2
        return told

    assert asyncio.run(run()) == ["of another editor", "not first", "not second", "third"]
