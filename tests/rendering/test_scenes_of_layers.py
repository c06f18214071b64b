"""Scenes of layered artwork: they find their parts again, name layers to lean on, and are written to be edited."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from physanimator.physics.document import scene_to_dict
from physanimator.physics.errors import InvalidInputError, SceneError
from physanimator.physics.scene import Contact, LayerRegion, advice
from physanimator.rendering.animation import Animation
from physanimator.rendering.artwork import ArtLayer, Artwork, flattened, save_psd
from physanimator.rendering.command import main
from physanimator.rendering.layer_pictures import layer_pictures
from physanimator.rendering.layers_of_scenes import masks_of_still_layers, planned_layers
from physanimator.rendering.options import LayerChoice, Timing, Touching
from physanimator.rendering.pipeline import animate

WIDTH, HEIGHT = 90, 70
PLACES = {"hair": (5, 5), "tail": (35, 5), "ribbon": (62, 5), "face": (5, 40), "thing": (35, 40), "arm": (62, 40)}
ALL = ["paper", "face", "tail", "arm", "hair", "thing", "ribbon"]


def layer(name: str, **more: Any) -> ArtLayer:
    if name == "paper":
        return ArtLayer(name, np.full((HEIGHT, WIDTH, 4), 255, np.uint8))
    left, top = PLACES[name]
    colour = (40 * list(PLACES).index(name), 90, 30, 255)
    return ArtLayer(name, np.full((24, 22, 4), colour, np.uint8), left, top, **more)


def artwork(names: Sequence[str]) -> Artwork:
    return Artwork(WIDTH, HEIGHT, tuple(map(layer, names)))


def animated(names: Sequence[str], **options: Any) -> Animation:
    return animate(artwork(names), timing=Timing(frames=2), spacing=8, **options)


def document() -> dict[str, Any]:
    made = scene_to_dict(animated(ALL).scene, meshes=False)
    made["bodies"][1]["material"] = {"preset": "jelly", "damping": 7}
    made["rig_points"] = [{"position": [10, 6], "body": 1}]
    return made


def test_a_scene_finds_its_layers_again_whatever_became_of_the_file() -> None:
    made = document()
    assert [body["name"] for body in made["bodies"]] == ["tail", "hair", "ribbon"]
    scene = animated(["paper", "ribbon", "hair", "face"], scene=made).scene
    assert [body.name for body in scene.bodies] == ["ribbon", "hair"]
    assert [body.layer for body in scene.bodies] == [0, 1]
    assert scene.bodies[1].material.damping == 7
    assert [point.body for point in scene.rig_points] == [1]
    assert scene.absent == ("tail",)
    assert any("tail" in line for line in advice(scene))


def test_a_scene_names_layers_whose_names_say_nothing_and_those_that_stand_still() -> None:
    made = {**document(), "still": ["ribbon"]}
    made["bodies"] = [{"name": "thing", "material": {"preset": "leaf"}}]
    made["rig_points"] = []
    animation = animated(ALL, scene=made)
    assert [body.name for body in animation.scene.bodies] == ["tail", "hair", "thing"]
    assert animation.scene.still == ("ribbon",)
    with_users_word = animated(ALL, scene=made, layers=LayerChoice(move=["ribbon"], still=["thing"]))
    assert [body.name for body in with_users_word.scene.bodies] == ["tail", "hair", "ribbon"]
    assert with_users_word.scene.absent == ("thing",)


def test_the_written_scene_gives_the_same_frames(tmp_path: Path) -> None:
    first = animated(ALL, layers=LayerChoice(still=["ribbon"], move=["thing=cloth"]))
    first.save_scene(tmp_path / "scene.json")
    written = json.loads((tmp_path / "scene.json").read_text("utf-8"))
    assert all("mesh" not in body for body in written["bodies"])
    second = animated(ALL, scene=written)
    assert [body.name for body in second.scene.bodies] == [body.name for body in first.scene.bodies]
    for one, other in zip(first.frames(), second.frames(), strict=True):
        np.testing.assert_array_equal(one, other)


def test_strands_follow_the_layer_that_has_them() -> None:
    made = document()
    for body in made["bodies"]:
        body["strands"] = body["name"] == "hair"
    scene = animated(["paper", "ribbon", "hair", "tail"], scene=made).scene
    assert [(body.name, body.strands) for body in scene.bodies] == [("ribbon", False), ("hair", True), ("tail", False)]


def test_a_scene_says_where_layers_are_held_and_in_which_order_they_lie(tmp_path: Path) -> None:
    made: dict[str, Any] = {**document(), "strokes": [], "rig_points": [], "order": ["hair", "face"]}
    made["bodies"] = [{"name": "hair", "attach": "bottom"}, {"name": "tail"}]
    over = replace(layer("face"), left=PLACES["hair"][0], top=PLACES["hair"][1] + 12)
    drawn = Artwork(WIDTH, HEIGHT, (layer("paper"), layer("tail"), over, layer("hair")))
    animation = animate(drawn, timing=Timing(frames=2), spacing=8, scene=made)
    scene, (frame, *_) = animation.scene, list(animation.frames())
    assert {scene.bodies[point.body].name for point in scene.rig_points if point.body is not None} == {"hair"}
    lowest = max(y for point in scene.rig_points for _, y in point.region.points)  # type: ignore[union-attr]
    assert lowest >= PLACES["hair"][1] + 23
    assert frame[22, 16].tolist() == over.pixels[0, 0, :3].tolist(), "the face lies over the hair"
    assert next(iter(animate(drawn, timing=Timing(frames=1), spacing=8).frames()))[22, 16, 0] == 0
    animation.save_scene(tmp_path / "scene.json")
    written = json.loads((tmp_path / "scene.json").read_text("utf-8"))
    assert written["order"] == ["hair", "face"]
    assert {body["name"]: body.get("attach") for body in written["bodies"]} == {"hair": "bottom", "tail": None}


def test_hidden_layers_stay_hidden_whatever_a_scene_says() -> None:
    hidden = replace(artwork(["paper", "hair"]), layers=(layer("paper"), layer("hair"), layer("thing", visible=False)))
    plans = planned_layers(hidden, document={"bodies": [{"name": "thing"}]})
    assert [plan.moves for plan in plans] == [False, True, False]


def test_still_layers_are_leant_on_by_name() -> None:
    animation = animated(ALL, touching=Touching(Contact(), ["arm", _box()]))
    first, second = animation.scene.colliders
    assert isinstance(first.region, LayerRegion)
    assert first.region.mask.sum() == 24 * 22
    assert first.region.mask[41, 63]
    assert not isinstance(second.region, LayerRegion)
    written = scene_to_dict(animation.scene, meshes=False)
    assert written["colliders"][0] == {"region": {"type": "layer", "name": "arm"}}
    again = animated(ALL, scene=written).scene
    np.testing.assert_array_equal(again.colliders[0].region.mask, first.region.mask)


def _box() -> np.ndarray:
    box = np.zeros((HEIGHT, WIDTH), bool)
    box[50:70, 0:30] = True
    return box


@pytest.mark.parametrize(("name", "got"), [("nobody", "Got: nobody"), ("hair", "Got: hair, which moves")])
def test_layers_that_cannot_be_leant_on_are_refused_with_those_that_can(name: str, got: str) -> None:
    known = "there are paper, face, arm, thing"
    with pytest.raises(InvalidInputError, match=rf"colliders\[0\] must be one that stands still; {known}. {got}"):
        animated(ALL, touching=Touching(Contact(), [name]))
    region = {"type": "layer", "name": name}
    with pytest.raises(SceneError, match=rf"colliders\[0\].region.name: must be one that stands still; {known}"):
        animated(ALL, scene={**document(), "contact": {}, "colliders": [{"region": region}]})
    flat = flattened(artwork(ALL))
    with pytest.raises(InvalidInputError, match=r"colliders\[0\] must be a mask where the picture is flat. Got: "):
        animate(flat, [_box()], timing=Timing(frames=2), touching=Touching(Contact(), [name]))


def test_many_colliders_of_one_layer_hold_one_mask() -> None:
    mask_of = masks_of_still_layers(artwork(ALL), [2])
    assert mask_of("arm").sum() == 24 * 22
    colliders = [{"region": {"type": "layer", "name": "arm"}}] * 50
    scene = animated(ALL, scene={**document(), "contact": {}, "colliders": colliders}).scene
    assert len({id(each.region.mask) for each in scene.colliders}) == 1


def test_the_command_writes_scenes_and_takes_layers_by_name(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    psd, scene, out = tmp_path / "girl.psd", tmp_path / "scene.json", str(tmp_path / "out.webp")
    save_psd(artwork(ALL), psd)
    usual = ["animate", str(psd), "-o", out, "--frames", "2", "--spacing", "8", "--quiet"]
    assert main([*usual, "--collider", "arm", "--save-scene", str(scene)]) == 0
    written = json.loads(scene.read_text("utf-8"))
    assert [body["name"] for body in written["bodies"]] == ["tail", "hair", "ribbon"]
    assert written["rig_points"]
    assert written["colliders"] == [{"region": {"type": "layer", "name": "arm"}}]
    capsys.readouterr()
    save_psd(artwork(["paper", "ribbon", "arm", "hair"]), psd)
    assert main([*usual, "--scene", str(scene)]) == 0
    assert "warning: the scene names a body that is no moving part: tail" in capsys.readouterr().err
    assert main([*usual, "--collider", "knee"]) == 2
    assert "--collider knee must be one that stands still; there are paper, arm. Got: knee" in capsys.readouterr().err
    assert main([*usual, "--save-scene", str(psd)]) == 2


def test_pictures_of_layers_give_the_artwork_and_stay_small() -> None:
    rng = np.random.default_rng(5)
    layers = tuple(
        replace(
            layer(name, opacity=opacity, blend=blend),
            pixels=rng.integers(0, 256, (30, 40, 4)).astype(np.uint8),
            left=left,
        )
        for name, left, opacity, blend in [
            ("face", -9, 1.0, "normal"), ("arm", 60, 0.5, "overlay"), ("hair", 30, 0.8, "normal"),
        ]
    )  # fmt: skip
    art = Artwork(WIDTH, HEIGHT, (layer("paper"), *layers))
    over = np.zeros((HEIGHT, WIDTH, 4))
    for each in layer_pictures(art, [3]):
        x, y, width, height = each.box
        pixels = np.zeros((HEIGHT + 20, WIDTH + 20, 4))
        pixels[y + 10 : y + 10 + height, x + 10 : x + 10 + width] = each.pixels / 255
        pixels = pixels[10:-10, 10:-10]
        alpha = pixels[..., 3:]
        over = np.concatenate([pixels[..., :3] * alpha, alpha], axis=2) + over * (1 - alpha)
    expected = flattened(art)[..., :3].astype(float)
    assert np.abs(over[..., :3] * 255 - expected).max() < 3
    small = layer_pictures(art, [3], most_pixels=500)
    assert sum(each.pixels.shape[0] * each.pixels.shape[1] for each in small) < 700
    for one, whole in zip(small, layer_pictures(art, [3]), strict=True):
        np.testing.assert_allclose(one.box, whole.box, atol=30)
        assert one.box[2] >= whole.box[2] - 8
