"""The node that goes the whole way, in the stand-in: what it takes, what it gives, and what it says."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.rendering.artwork import ArtLayer, Artwork, save_psd
from physanimator.rendering.pictures import read_clip
from PIL import Image

RED, BLUE, PAPER = (200, 40, 40), (40, 60, 200), (235, 230, 220)
USUAL = {"preset": "auto", "wind": 3.0, "wind_angle": 0.0, "loop": 0.0, "frames": 6, "fps": 12.0}
ON_RED, ON_BLUE = [60, 40, 1], [140, 40, 1, 1]


def core(node_type: str, /, **inputs: Any) -> dict[str, Any]:
    return {"class_type": node_type, "inputs": inputs}


def animate(picture: str, points: Any, **inputs: Any) -> dict[str, Any]:
    text = points if isinstance(points, str) else json.dumps(points)
    given = {"picture": picture, "points": text, **USUAL, **inputs}
    return {"animate": core("PhysAnimator_AnimateIllustration", **given)}


def seen(prompt: dict[str, Any]) -> dict[str, Any]:
    """The prompt with its frames and masks looked at."""
    return prompt | {
        "frames": core("PreviewImage", images=["animate", 0]),
        "shapes": core("MaskToImage", mask=["animate", 1]),
        "masks": core("PreviewImage", images=["shapes", 0]),
    }


def pictures(standin: Any, shown: dict[str, Any]) -> np.ndarray:
    return np.stack([np.asarray(Image.open(standin.file(saved))).astype(int) for saved in shown["images"]])


@pytest.fixture(scope="module")
def bars(standin: Any) -> str:
    """A picture of a red and a blue bar that hang from a beam, in the host's input folder."""
    drawn = np.full((120, 200, 3), PAPER, np.uint8)
    drawn[20:26, 30:170] = (60, 50, 40)
    drawn[26:100, 50:74], drawn[26:100, 130:154] = RED, BLUE
    Image.fromarray(drawn).save(standin.folder / "input" / "bars.png")
    return "bars.png"


def test_what_is_picked_moves_and_what_is_not_stands_still(standin: Any, bars: str) -> None:
    outputs = standin.run(seen(animate(bars, [ON_RED])))
    frames, (mask,) = pictures(standin, outputs["frames"]), pictures(standin, outputs["masks"])
    assert frames.shape == (6, 120, 200, 3)
    moved = np.abs(frames - frames[0]).sum(axis=3).max(axis=0)
    assert moved[30:100, 40:100].max() > 150
    assert moved[:, 120:].max() == 0
    assert mask[40, 60].min() > 250
    assert mask[40, 140].max() < 5


@pytest.mark.parametrize(
    ("size", "shown"), [((1280, 720), (960, 540)), ((60, 1200), (60, 1200)), ((9000, 16), (4096, 8))]
)
def test_of_long_pages_as_much_is_shown_as_can_be_seen(
    standin: Any, size: tuple[int, int], shown: tuple[int, int]
) -> None:
    drawn = np.full((*size[::-1], 3), PAPER, np.uint8)
    drawn[4:12, 10:40] = RED
    Image.fromarray(drawn).save(standin.folder / "input" / "long.png")
    outputs = standin.run(animate("long.png", [[20, 8, 1]], frames=2))
    frame = next(iter(read_clip(standin.file(outputs["animate"]["images"][0]))))
    assert frame.shape[1::-1] == shown


def test_it_shows_a_small_video_and_makes_no_batch_that_nobody_takes(standin: Any, bars: str) -> None:
    shown = standin.run(animate(bars, [ON_RED], frames=5))["animate"]
    (saved,) = shown["images"]
    assert (saved["type"], shown["animated"]) == ("temp", [True])
    clip = list(read_clip(standin.file(saved)))
    assert len(clip) == 5
    assert np.abs(clip[4].astype(int) - clip[0]).max() > 60
    assert standin.run(seen(animate(bars, [ON_RED], frames=5)))["frames"]["images"]
    assert "animate" in standin.executed  # its frames were not made before


def test_each_part_has_its_own_mask_and_preset(standin: Any, bars: str) -> None:
    points = {
        "version": 2,
        "width": 200,
        "height": 120,
        "query_points": [{"x": 60, "y": 40}, {"x": 140, "y": 40, "part": 1}],
        "bodies": [{"material": {"preset": "ribbon"}}, {"material": {"preset": "leaf"}}],
    }
    outputs = standin.run(seen(animate(bars, points, frames=12)))
    red, blue = pictures(standin, outputs["masks"])
    assert (red[40, 60].min() > 250, red[40, 140].max() < 5) == (True, True)
    assert (blue[40, 140].min() > 250, blue[40, 60].max() < 5) == (True, True)
    frames = pictures(standin, outputs["frames"])
    same = standin.run(seen(animate(bars, [ON_RED, ON_BLUE], preset="ribbon", frames=12)))
    other = pictures(standin, same["frames"])
    assert np.abs(frames[11, :, :110] - other[11, :, :110]).max() < 30
    assert np.abs(frames[11, :, 120:] - other[11, :, 120:]).max() > 60


def test_nothing_picked_is_said_before_anything_runs(standin: Any, bars: str) -> None:
    assert "click on what shall move" in standin.error_of(animate(bars, ""))
    empty = {"version": 2, "width": 200, "height": 120, "query_points": []}
    assert "click on what shall move" in standin.error_of(animate(bars, empty))
    assert "click on what shall move" in standin.error_of(animate("PhysAnimator example.png", ""))


@pytest.mark.parametrize(
    ("inputs", "told"),
    [
        ({"picture": "../bars.png"}, "picture must be a file of the host's input folder"),
        ({"picture": "none.png"}, "picture must be a file of the host's input folder"),
        ({"picture": "a" * 5000}, "picture must be a file of the host's input folder"),
        ({"points": "[" * 100_000}, "points must not be nested deeper"),
        ({"points": "[[1, 2, 3, 4, 5]]"}, "points"),
        ({"points": '{"version": 2, "query_points": [{"x": 60, "y": 40}], "width": 200, "height": 120,'
                    ' "bodies": [{"material": {"preset": "stone"}}]}'}, "bodies[0].material.preset: must be one of"),
        ({"preset": "stone"}, "preset"),
        ({"frames": 0}, "frames"),
        ({"wind": 1e9}, "wind"),
        ({"background": "colour", "background.colour": "no colour"}, "colour"),
        ({"scene": "no document"}, "scene"),
    ],
)  # fmt: skip
def test_what_it_does_not_take_is_refused(standin: Any, bars: str, inputs: dict[str, Any], told: str) -> None:
    prompt = animate(bars, [ON_RED])
    prompt["animate"]["inputs"] |= inputs
    assert told in standin.error_of(prompt)


def test_parts_on_the_same_pixels_have_the_names_that_the_node_shows(standin: Any, bars: str) -> None:
    told = standin.error_of(animate(bars, [[*ON_RED, 0], [*ON_RED[:2], 1, 2]]))
    assert told == "Part 1 and Part 3 must not be at the same pixel. Got: both at (60, 40)"


def test_what_is_too_small_to_move_is_said_in_the_words_of_who_clicked_and_the_rest_moves(standin: Any) -> None:
    drawn = np.full((120, 200, 3), PAPER, np.uint8)
    drawn[26:100, 50:74], drawn[60, 150] = RED, BLUE
    Image.fromarray(drawn).save(standin.folder / "input" / "dot.png")
    dot = [150, 60, 1]
    told = standin.error_of(animate("dot.png", [dot]))
    assert "cut out hardly more than itself" in told
    assert "mask" not in told
    outputs = standin.run(seen(animate("dot.png", [dot, [*ON_RED, 1]])))
    (mask,) = pictures(standin, outputs["masks"])
    assert mask[60, 60].all()
    assert not mask[60, 150].any()


def test_a_file_is_named_by_its_place_in_the_host_s_folders(standin: Any) -> None:
    (standin.folder / "input" / "broken.psd").write_bytes(b"no psd")
    for prompt in (animate("broken.psd", ""), animate("PhysAnimator example.png", "", scene="{}")):
        told = standin.error_of(prompt)
        assert str(standin.folder) not in told
    assert "input/broken.psd" in standin.error_of(animate("broken.psd", ""))


def test_masks_may_stand_in_for_points_and_a_connected_picture_for_the_file(standin: Any) -> None:
    prompt = animate("gone.png", "") | {
        "black": core("SolidMask", value=0.0, width=160, height=96),
        "white": core("SolidMask", value=1.0, width=24, height=64),
        "mask": core("MaskComposite", destination=["black", 0], source=["white", 0], x=60, y=16, operation="add"),
        "picture": core("MaskToImage", mask=["mask", 0]),
    }
    prompt["animate"]["inputs"] |= {"image": ["picture", 0], "masks": ["mask", 0]}
    outputs = standin.run(seen(prompt))
    frames = pictures(standin, outputs["frames"])
    assert np.abs(frames[5] - frames[0]).max() > 60
    (told,) = outputs["animate"]["physanimator_picture"]
    with Image.open(standin.file(told)) as shown:
        assert shown.size == (160, 96)
    prompt["animate"]["inputs"]["masks"] = ["black", 0]
    assert "mask 0 without any" in standin.error_of(prompt)


def test_a_picture_that_other_nodes_make_is_shown_before_anything_is_picked(standin: Any) -> None:
    prompt = animate("gone.png", "") | {"picture": core("EmptyImage", width=64, height=48, batch_size=1, color=200)}
    prompt["animate"]["inputs"]["image"] = ["picture", 0]
    assert "click on what shall move" in standin.error_of(prompt)
    name, told = standin.server.messages[-1]
    assert (name, told["node"]) == ("physanimator.picture", "animate")
    with Image.open(standin.file({key: told[key] for key in ("filename", "subfolder", "type")})) as shown:
        assert shown.size == (64, 48)


def test_a_scene_of_other_nodes_brings_what_moves(standin: Any) -> None:
    prompt = {
        "black": core("SolidMask", value=0.0, width=160, height=96),
        "white": core("SolidMask", value=1.0, width=24, height=64),
        "mask": core("MaskComposite", destination=["black", 0], source=["white", 0], x=60, y=16, operation="add"),
        "picture": core("MaskToImage", mask=["mask", 0]),
        "mesh": core("PhysAnimator_MaskToMesh", mask=["mask", 0], spacing=8.0, elements_across=2, mask_index=0),
        "body": core("PhysAnimator_Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="top"),
        "scene": core("PhysAnimator_AutomaticScene", bodies=["body", 0], wind_strength=3.0, wind_angle=0.0,
                      sway_by_size=True, frame_rate=12.0),
        "motion": core("PhysAnimator_Simulate", scene=["scene", 0], frames=6),
        "render": core("PhysAnimator_Render", image=["picture", 0], motion=["motion", 0]),
        "rendered": core("PreviewImage", images=["render", 0]),
    } | animate("gone.png", "")  # fmt: skip
    prompt["animate"]["inputs"] |= {"image": ["picture", 0], "scene": ["scene", 0]}
    outputs = standin.run(seen(prompt))
    assert np.array_equal(pictures(standin, outputs["frames"]), pictures(standin, outputs["rendered"]))


def test_a_scene_document_acts_on_what_is_picked(standin: Any, bars: str) -> None:
    document = {
        "version": 2,
        "width": 200,
        "height": 120,
        "frame_rate": 12,
        "rig_points": [
            {"position": [62, 30], "region": {"type": "circle", "radius": 14},
             "motion": {"type": "path", "times": [0, 0.4], "points": [[62, 30], [82, 30]]}}
        ],
    }  # fmt: skip
    calm = animate(bars, [ON_RED], wind=0.0)
    calm |= {
        "white": core("SolidMask", value=1.0, width=200, height=120),
        "mesh": core("PhysAnimator_MaskToMesh", mask=["white", 0], spacing=20.0, elements_across=2, mask_index=0),
        "body": core("PhysAnimator_Body", mesh=["mesh", 0], preset="ribbon", layer=0, attach="top"),
        "text": core("PhysAnimator_SceneFromJSON", bodies=["body", 0], scene=json.dumps(document)),
    }
    calm["animate"]["inputs"]["scene"] = ["text", 1]
    frames = pictures(standin, standin.run(seen(calm))["frames"])
    assert (frames[5, 30, 78] - PAPER)[1] < -100


def test_layers_move_by_their_names_without_a_click(standin: Any) -> None:
    prompt = animate("PhysAnimator example.png", "", frames=3) | {
        "layers": core("PhysAnimator_LoadLayers", file="PhysAnimator example.psd"),
    }
    prompt["animate"]["inputs"]["layers"] = ["layers", 0]
    prompt["layered"] = core("PhysAnimator_FrameAsLayers", motion=["animate", 2], frame=-1)
    prompt["saved"] = core("PhysAnimator_SaveLayers", layers=["layered", 0], filename_prefix="a", file_type="psd")
    outputs = standin.run(seen(prompt))
    frames = pictures(standin, outputs["frames"])
    assert np.abs(frames[2] - frames[0]).max() > 30
    assert Path(outputs["saved"]["text"][0]).exists()


@pytest.fixture(scope="module")
def layered(standin: Any) -> str:
    """The bars and their beam as layers whose names say nothing."""
    paper, beam = (np.full((120, 200, 4), (*PAPER, 255), np.uint8) for _ in range(2))
    beam[...] = (60, 50, 40, 255)
    red, blue = (np.full((74, 24, 4), (*colour, 255), np.uint8) for colour in (RED, BLUE))
    layers = [("Layer 0", paper, 0, 0), ("Layer 1", beam[20:26, 30:170], 30, 20), ("Layer 2", red, 50, 26)]
    made = [ArtLayer(*each) for each in [*layers, ("Layer 2", blue, 130, 26)]]
    save_psd(Artwork(200, 120, tuple(made)), standin.folder / "input" / "bars.psd")
    return "bars.psd"


def test_a_clicked_layer_moves_where_names_say_nothing(standin: Any, layered: str) -> None:
    assert "no layer moves by its name: click on what shall move" in standin.error_of(animate(layered, ""))
    told = standin.error_of(animate(layered, [[5, 5, 1]]))
    assert "Part 1: the layer Layer 0 fills the whole picture" in told
    outputs = standin.run(seen(animate(layered, [ON_BLUE], preset="ribbon")))
    frames, (mask,) = pictures(standin, outputs["frames"]), pictures(standin, outputs["masks"])
    moved = np.abs(frames - frames[0]).sum(axis=3).max(axis=0)
    assert (moved[30:100, 110:170].max() > 150, moved[:, :90].max()) == (True, 0)
    assert (mask[40, 140].min() > 250, mask[40, 60].max()) == (True, 0)


def test_layers_of_other_nodes_are_shown_so_that_they_can_be_clicked_on(standin: Any, layered: str) -> None:
    prompt = animate("gone.png", "") | {"layers": core("PhysAnimator_LoadLayers", file=layered)}
    prompt["animate"]["inputs"]["layers"] = ["layers", 0]
    assert "click on what shall move" in standin.error_of(prompt)
    name, told = standin.server.messages[-1]
    assert (name, told["node"]) == ("physanimator.picture", "animate")
    prompt["animate"]["inputs"]["points"] = json.dumps([ON_RED])
    frames = pictures(standin, standin.run(seen(prompt))["frames"])
    assert np.abs(frames - frames[0]).max() > 60


def test_it_can_be_interrupted(standin: Any, bars: str) -> None:
    import comfy.model_management

    stopped = standin.progressed

    def stop(*told: Any, **more: Any) -> None:
        stopped(*told, **more)
        comfy.model_management.interrupt_current_processing()

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("comfy.utils.PROGRESS_BAR_HOOK", stop)
        with pytest.raises(comfy.model_management.InterruptProcessingException):
            standin.run(animate(bars, [ON_RED], frames=300, wind_angle=33.0))
    assert len(standin.progress) < 20


def test_pixel_art_is_shown_with_its_very_colours(standin: Any, bars: str) -> None:
    (saved,) = standin.run(animate(bars, [ON_RED], pixel_art=True, frames=2))["animate"]["images"]
    first = next(iter(read_clip(standin.file(saved))))
    assert first[60, 60].tolist() == list(RED)


def test_a_transparent_background_is_shown_and_given(standin: Any, bars: str) -> None:
    outputs = standin.run(seen(animate(bars, [ON_RED], background="parts", frames=3)))
    frames = pictures(standin, outputs["frames"])
    assert frames.shape[3] == 4
    assert frames[0, 5, 5, 3] == 0
    (saved,) = outputs["animate"]["images"]
    assert Image.open(io.BytesIO(standin.view(saved))).format == "WEBP"
