"""What layers can hold, in a real host: many, of one name, of 16 bits, none; and the host's own layer nodes."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import pytest
from bar_graphs import core, ours
from layered_files import HEIGHT, WIDTH, bust, filled, moved_layers, write_ora
from PIL import Image


def pictures(host: Any, outputs: dict[str, Any], key: str) -> np.ndarray:
    files = outputs[key]["images"]
    return np.stack([np.asarray(Image.open(io.BytesIO(host.view(each))).convert("RGB")) for each in files]).astype(int)


def failure(host: Any, prompt: dict[str, Any]) -> str:
    entry = host.wait(host.queue(prompt))
    (message,) = [each[1] for each in entry["status"]["messages"] if each[0] == "execution_error"]
    return str(message["exception_message"])


def bodies(**changes: Any) -> dict[str, Any]:
    usual = {"layers": ["load", 0], "move": "", "still": "", "preset": "by name", "spacing": 8.0, "elements_across": 2,
             "strands": True}  # fmt: skip
    return ours("ArtworkToBodies", **(usual | changes))


@pytest.fixture(scope="module")
def file(host: Any) -> str:
    write_ora(host.folder / "input" / "held" / "bust.ora", bust())
    return "held/bust.ora"


def needs(host: Any, *nodes: str) -> None:
    missing = set(nodes) - set(host.get("/object_info"))
    if missing:
        pytest.skip(f"this host has no {', '.join(sorted(missing))}")


def test_sixty_layers_move_and_are_told_of(host: Any) -> None:
    strips = [(f"plank {n}", filled((4 * n, 90, 120), 2 * n, 0, 2 * n + 8, HEIGHT)) for n in range(57)]
    write_ora(host.folder / "input" / "held" / "many.ora", [bust()[0], *strips, *bust()[1:3]])
    outputs = host.run(moved_layers("held/many.ora", frames=3))
    frames = pictures(host, outputs, "seen")
    assert np.abs(frames[0] - pictures(host, outputs, "flat")[0]).max() <= 1
    assert len(outputs["report"]["text"][0].splitlines()) == 60


def test_layers_of_one_name_are_told_apart(host: Any) -> None:
    twice = [bust()[0], ("hair", bust()[1][1]), ("hair", bust()[3][1])]
    write_ora(host.folder / "input" / "held" / "twice.ora", twice)
    load = ours("LoadLayers", file="held/twice.ora")
    prompt = {"load": load, "bodies": bodies(still="hair (2)"), "report": core("PreviewAny", source=["bodies", 2])}
    (report,) = host.run(prompt)["report"]["text"]
    assert report.splitlines()[:2] == ["hair (2): stands still (asked for)", "hair: moves as hair (the name says hair)"]


def test_sixteen_bits_stay(host: Any) -> None:
    import cv2

    folder = host.folder / "input" / "held" / "deep"
    folder.mkdir()
    ramp = np.full((HEIGHT, WIDTH, 4), 65535, np.uint16)
    ramp[..., :3] = 20000 + np.arange(WIDTH)[None, :, None]
    hair = np.zeros((HEIGHT, WIDTH, 4), np.uint16)
    hair[10:80, 40:90] = (5001, 30001, 60001, 65535)
    for name, pixels in (("1 paper", ramp), ("2 hair", hair)):
        assert cv2.imwrite(str(folder / f"{name}.png"), pixels)
    prompt = moved_layers("held/deep", frames=2) | {
        "save": ours("SaveLayers", layers=["load", 0], filename_prefix="deep/bust", file_type="psb"),
        "path": core("PreviewAny", source=["save", 0]),
    }
    outputs = host.run(prompt)
    from psd_tools import PSDImage

    saved = PSDImage.open(outputs["path"]["text"][0])
    assert saved.depth == 16
    assert [layer.name for layer in saved] == ["paper", "hair"]
    red = saved[0].numpy()[0, :, 0] * 65535
    assert np.abs(red - (20000 + np.arange(WIDTH))).max() < 1, "finer than 8 bits"
    assert np.abs(pictures(host, outputs, "seen")[0] - pictures(host, outputs, "flat")[0]).max() <= 1


@pytest.mark.parametrize(
    ("layers", "changes", "sentence"),
    [
        ([("glass", np.zeros((HEIGHT, WIDTH, 4), np.uint8))], {}, "at least one layer with something on it"),
        (
            [("face", filled((1, 2, 3), 5, 5, 50, 50))],
            {},
            'give them on the command line as --move "face". Got the layers, from back to front: "face"',
        ),
        (bust(), {"move": "hairr"}, "there must be a layer hairr"),
        (bust(), {"move": "face", "still": "face"}, "layer face must either move or stand still"),
        (bust(), {"move": "face=granite"}, "the preset of layer face must be one of hair"),
    ],
    ids=["empty", "still", "unknown", "both", "granite"],
)
def test_what_cannot_move_is_said_in_a_sentence(
    host: Any, layers: list[Any], changes: dict[str, Any], sentence: str
) -> None:
    write_ora(host.folder / "input" / "held" / "odd.ora", layers)
    prompt = {"load": ours("LoadLayers", file="held/odd.ora"), "bodies": bodies(**changes)}
    assert sentence in failure(host, prompt | {"report": core("PreviewAny", source=["bodies", 2])})


def test_no_layers_at_all_are_refused(host: Any) -> None:
    text = core("PrimitiveString", value="no layers")
    prompt = {"load": text, "bodies": bodies(), "report": core("PreviewAny", source=["bodies", 2])}
    status, _ = host.post("/prompt", {"prompt": prompt, "client_id": host.client})
    assert status == 400


def test_a_batch_of_one_picture_and_a_mask_for_all(host: Any) -> None:
    layers = ours("LayersFromImageBatch", images=["many", 0], names="", white_is="transparent", masks=["mask", 0])
    prompt = {
        "many": core("EmptyImage", width=64, height=48, batch_size=3, color=0x40A020),
        "mask": core("SolidMask", value=0.25, width=64, height=48),
        "load": layers,
        "bodies": bodies(move="layer 2=cloth"),
        "report": core("PreviewAny", source=["bodies", 2]),
        "seen": core("PreviewImage", images=["load", 1]),
    }
    outputs = host.run(prompt)
    assert outputs["report"]["text"][0].splitlines()[1] == "layer 2: moves as cloth (asked for)"
    assert np.abs(pictures(host, outputs, "seen")[0, 0, 0] - (0x40, 0xA0, 0x20)).max() <= 1
    wrong = prompt | {"mask": core("SolidMask", value=0.25, width=32, height=48)}
    assert "masks must be of the pictures' size, 64 x 48 px. Got: 32 x 48 px" in failure(host, wrong)


def test_the_host_s_own_layer_nodes_take_ours_and_give_theirs(host: Any, file: str) -> None:
    needs(host, "AddLayer", "ImageCompositor")
    added = core("AddLayer", layers=["load", 0], image=["red", 0], mask=["clear", 0], name="スカート", x=100, y=50,
                 opacity=1.0, blend_mode="normal", rotation=0.0, width=0, height=0, z_index=0, flip_h=False,
                 flip_v=False)  # fmt: skip
    prompt = moved_layers(file, frames=4, layers=["added", 0]) | {
        "red": core("EmptyImage", width=40, height=40, batch_size=1, color=0xD02060),
        "clear": core("SolidMask", value=0.0, width=40, height=40),
        "added": added,
        "theirs": core("ImageCompositor", layers=["added", 0], compositor={}),
        "seen_theirs": core("PreviewImage", images=["theirs", 0]),
        "seen_ours": core("PreviewImage", images=["bodies", 1]),
    }
    outputs = host.run(prompt)
    theirs, own = pictures(host, outputs, "seen_theirs")[0], pictures(host, outputs, "seen_ours")[0]
    assert own.shape == (HEIGHT, WIDTH, 3)
    assert np.abs(theirs - own).max() <= 2
    assert own[70, 120].tolist() == [0xD0, 0x20, 0x60], "what the host adds lies on top"
    assert "スカート: moves as cloth" in outputs["report"]["text"][0]
    assert np.abs(pictures(host, outputs, "seen")[0] - own).max() <= 1


def test_layers_of_the_host_without_a_canvas(host: Any) -> None:
    needs(host, "AddLayer")
    place = {"opacity": 1.0, "blend_mode": "normal", "rotation": 0.0, "width": 0, "height": 0, "z_index": 0,
             "flip_h": False, "flip_v": False}  # fmt: skip
    prompt = {
        "paper": core("EmptyImage", width=120, height=80, batch_size=1, color=0x203040),
        "strip": core("EmptyImage", width=30, height=70, batch_size=1, color=0xD0A060),
        "first": core("AddLayer", image=["paper", 0], name="paper", x=0, y=0, **place),
        "load": core("AddLayer", layers=["first", 0], image=["strip", 0], name="ribbon", x=100, y=20, **place),
        "bodies": bodies(),
        "report": core("PreviewAny", source=["bodies", 2]),
        "seen": core("PreviewImage", images=["bodies", 1]),
    }
    outputs = host.run(prompt)
    assert pictures(host, outputs, "seen").shape == (1, 90, 130, 3)
    assert outputs["report"]["text"][0].startswith("ribbon: moves as ribbon")
