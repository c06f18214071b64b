"""Layers as bodies: which move, of what, behind what, and from one node to the next."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from physanimator.physics.document import check_document
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import Material, preset
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body, Held, pins
from physanimator.rendering.artwork import ArtLayer, Artwork, flattened
from physanimator.rendering.layer_bodies import LayerBodies, bodies_before, bodies_of_layers
from physanimator.rendering.moving_layers import LayerSource, moving_layers_of, told_layers

WIDTH, HEIGHT = 120, 90


def box(name: str, left: int, top: int, right: int, bottom: int, colour: int = 90, **more: object) -> ArtLayer:
    pixels = np.zeros((HEIGHT, WIDTH, 4), np.uint8)
    pixels[top:bottom, left:right] = (colour, 60, 160, 255)
    return ArtLayer(name, pixels, **more)  # type: ignore[arg-type]


def artwork() -> Artwork:
    """Paper, hair behind a face, a ribbon before it, and an arm in front of all."""
    return Artwork(
        WIDTH,
        HEIGHT,
        (
            box("paper", 0, 0, WIDTH, HEIGHT, 220),
            box("back hair", 20, 5, 90, 80, 130),
            box("face", 35, 15, 75, 50, 240),
            box("リボン", 60, 8, 110, 22, 200),
            box("arm", 10, 60, 100, 70, 250),
        ),
    )


def test_bodies_are_of_what_their_names_say_and_know_what_is_in_front() -> None:
    made = bodies_of_layers(artwork(), spacing=8)
    assert [body.name for body in made.bodies] == ["back hair", "リボン"]
    assert [vars(body.material) for body in made.bodies] == [vars(preset("hair")), vars(preset("ribbon"))]
    assert [source.index for source in made.sources] == [1, 3]
    hair, ribbon = made.bodies
    assert hair.cover is not None
    assert hair.cover[30, 50]
    assert hair.cover[65, 50]
    assert not hair.cover[12, 100], "the ribbon moves: it hides nothing for good"
    assert ribbon.cover is not None
    assert not ribbon.cover[12, 70]
    told = told_layers(made.plans).splitlines()
    assert [line.split(" (")[0] for line in told] == [
        "arm: stands still",
        "リボン: moves as ribbon",
        "face: stands still",
        "back hair: moves as hair",
        "paper: stands still",
    ]


def earlier(made: LayerBodies) -> list[tuple[LayerSource, Body, Held]]:
    """Bodies as another node has made them."""
    return list(zip(made.sources, made.bodies, made.attachments, strict=True))


@pytest.mark.parametrize("material", ["cloth", Material(density=0.5)])
def test_one_material_for_all_but_those_that_are_named_with_a_preset(material: Material | str) -> None:
    made = bodies_of_layers(artwork(), move=["face=jelly", "arm"], material=material, spacing=8)
    chosen = preset("cloth") if material == "cloth" else material
    materials = {body.name: vars(body.material) for body in made.bodies}
    jelly = vars(preset("jelly"))
    assert materials == {"back hair": vars(chosen), "face": jelly, "リボン": vars(chosen), "arm": vars(chosen)}


def test_a_second_choice_keeps_the_bodies_of_the_first() -> None:
    first = bodies_of_layers(artwork(), still=["リボン"], spacing=8)
    before = bodies_before(artwork(), earlier(first))
    assert list(before) == [1]
    both = bodies_of_layers(artwork(), move=["リボン=cloth"], spacing=5, before=before)
    assert [body.name for body in both.bodies] == ["back hair", "リボン"]
    assert both.bodies[0].mesh is first.bodies[0].mesh
    assert vars(both.bodies[1].material) == vars(preset("cloth"))
    assert both.bodies[0].cover is not None
    assert first.bodies[0].cover is not None
    assert first.bodies[0].cover[12, 80], "there the ribbon stood still"
    assert not both.bodies[0].cover[12, 80]
    with pytest.raises(InvalidInputError, match="move must be of layers that are no bodies yet"):
        bodies_of_layers(artwork(), move=["back hair"], before=before)


def test_what_was_asked_for_before_still_moves() -> None:
    first = bodies_of_layers(artwork(), move=["face"], still=["リボン"], spacing=8)
    before = bodies_before(artwork(), earlier(first))
    both = bodies_of_layers(artwork(), move=["リボン"], before=before)
    assert [body.name for body in both.bodies] == ["back hair", "face", "リボン"]
    assert [body.layer for body in both.bodies] == [0, 1, 2]


def test_what_does_not_belong_together_is_refused() -> None:
    made = bodies_of_layers(artwork(), spacing=8)
    other = replace(artwork(), layers=(*artwork().layers[:4], box("arm", 10, 60, 99, 70, 250)))
    with pytest.raises(InvalidInputError, match="layers of the same artwork"):
        bodies_before(other, earlier(made))
    with pytest.raises(InvalidInputError, match="bodies of layers and bodies of masks"):
        moving_layers_of([made.sources[0], None])
    with pytest.raises(InvalidInputError, match="bodies of layers and bodies of masks"):
        bodies_before(artwork(), [(None, made.bodies[0], "auto")])
    with pytest.raises(InvalidInputError, match="layers of one picture"):
        moving_layers_of([made.sources[0], LayerSource(other, 3)])
    with pytest.raises(InvalidInputError, match="a layer twice"):
        moving_layers_of([made.sources[0], made.sources[0]])
    assert moving_layers_of([None, None]) is None
    assert moving_layers_of([]) is None


def test_moving_layers_draw_the_artwork_and_the_lines_of_each() -> None:
    drawn = artwork()
    drawn.layers[2].pixels[47:49, 40:60, :3] = 20  # a mouth
    drawn.layers[1].pixels[30:32, 40:60, :3] = 20  # a strand behind the face
    made = bodies_of_layers(drawn, spacing=8)
    found = moving_layers_of(made.sources)
    assert found is not None
    rest = np.concatenate([body.mesh.vertices for body in made.bodies]).astype(np.float32)
    motion = Motion(made.bodies, np.stack([rest, rest + np.float32((6, 0))]), 24.0)
    assert np.array_equal(found.renderer(motion).frame(0), flattened(drawn)[..., :3])
    hair, ribbon = found.own_sketches()
    assert hair.shape == ribbon.shape == (HEIGHT, WIDTH)
    behind = found.sketch_behind(motion)
    assert behind.shape == (HEIGHT, WIDTH)
    assert behind[47:49, 45:55].min() < 0.5, "the mouth stands still"
    assert hair[30:32, 45:55].min() < 0.5, "the strand is known where the face hides it"
    assert ribbon[30:60, 10:50].min() == 1


def test_a_hidden_layer_that_is_asked_for_is_drawn() -> None:
    hidden = Artwork(WIDTH, HEIGHT, (*artwork().layers[:3], replace(artwork().layers[3], visible=False)))
    assert [body.name for body in bodies_of_layers(hidden, spacing=8).bodies] == ["back hair"]
    made = bodies_of_layers(hidden, move=["リボン"], spacing=8)
    assert made.sources[1].artwork.layers[3].visible
    assert made.parts.image[15, 100].tolist() == [200, 60, 160]


def test_a_finer_mesh_where_it_is_asked_for() -> None:
    usual = bodies_of_layers(artwork(), spacing=20, elements_across=1).bodies[1].mesh
    fine = bodies_of_layers(artwork(), spacing=20, elements_across=6).bodies[1].mesh
    assert len(fine.triangles) > 2 * len(usual.triangles)


def document(*entries: dict[str, Any], **more: Any) -> dict[str, Any]:
    return check_document({"version": 2, "width": WIDTH, "height": HEIGHT, "bodies": list(entries), **more})


def test_a_scene_document_says_what_moves_of_what_and_held_where() -> None:
    said = document(
        {"name": "face", "material": {"preset": "jelly", "damping": 7}, "attach": "left"},
        {"name": "back hair", "attach": "bottom"},
        still=["リボン"],
    )
    made = bodies_of_layers(artwork(), document=said, spacing=8, material="cloth")
    assert [body.name for body in made.bodies] == ["back hair", "face"]
    assert made.attachments == ("bottom", "left")
    assert [body.material.name for body in made.bodies] == ["cloth", "jelly"]
    assert made.bodies[1].material.damping == 7
    usual = bodies_of_layers(artwork(), spacing=8)
    assert usual.attachments == ("covered", "end")


def test_layers_change_places_as_a_scene_document_says() -> None:
    turned = bodies_of_layers(artwork(), document=document(order=["リボン", "face", "back hair"]), spacing=8)
    assert turned.sources[0].artwork.names == ("paper", "リボン", "face", "back hair", "arm")
    assert [body.name for body in turned.bodies] == ["リボン", "back hair"]
    cover = turned.bodies[0].cover
    assert cover is not None
    assert cover[30, 50], "the face is in front of the ribbon now"
    assert turned.parts.image[30, 50].tolist() == artwork().layers[1].pixels[30, 50, :3].tolist(), (
        "hair before the face"
    )
    again = bodies_of_layers(
        artwork(), document=document(), before=bodies_before(artwork(), earlier(turned)), spacing=8
    )
    assert [body.name for body in again.bodies] == ["back hair", "リボン"]
    assert again.bodies[1].mesh is turned.bodies[0].mesh


def test_what_a_document_holds_nowhere_stays_whole_and_free() -> None:
    made = bodies_of_layers(artwork(), document=document({"name": "back hair", "attach": "none"}), spacing=8)
    assert made.attachments[0] == "none"
    assert pins(made.bodies[0], 0, attach=made.attachments[0]) == []
