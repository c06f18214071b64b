"""Layers picked by points: the layer that is seen at a point moves, or stands still."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from physanimator.rendering.artwork import ArtLayer, Artwork
from physanimator.rendering.options import LayerChoice, Timing
from physanimator.rendering.picked_layers import flat_picture, picked_layers
from physanimator.rendering.pipeline import animate

WIDTH, HEIGHT = 160, 120


def bar(name: str, left: int, colour: tuple[int, int, int], *, alpha: int = 255, **more: Any) -> ArtLayer:
    return ArtLayer(name, np.full((70, 24, 4), (*colour, alpha), np.uint8), left=left, top=20, **more)


PAPER = ArtLayer("Layer 0", np.full((HEIGHT, WIDTH, 4), (235, 230, 220, 255), np.uint8))
RED, BLUE = bar("Layer 1", 30, (200, 40, 40)), bar("Layer 1", 100, (40, 60, 200))
ART = Artwork(WIDTH, HEIGHT, (PAPER, RED, BLUE))
ON_RED, ON_BLUE = [40, 40, 1], [110, 40, 1, 1]


def moving(artwork: Artwork, points: Any, **more: Any) -> dict[str, str | None]:
    found = picked_layers(artwork, None if points is None else str(points), **more)
    return {plan.name: plan.preset for plan in found.plans if plan.moves}


def test_of_layers_of_one_name_the_clicked_one_moves() -> None:
    assert moving(ART, None) == {}
    assert moving(ART, [ON_BLUE]) == {"Layer 1 (2)": "hair"}
    assert moving(ART, [ON_RED, ON_BLUE], usual="cloth") == {"Layer 1": "cloth", "Layer 1 (2)": "cloth"}
    assert picked_layers(ART, str([ON_RED, ON_BLUE])).parts == {1: 0, 2: 1}


def test_a_material_of_a_part_stands_above_the_usual_one() -> None:
    points = [{"x": 40, "y": 40}, {"x": 110, "y": 40, "part": 1}]
    bodies = [{}, {"material": {"preset": "leaf"}}]
    document = {"version": 2, "width": WIDTH, "height": HEIGHT, "query_points": points, "bodies": bodies}
    found = picked_layers(ART, document, usual="ribbon")
    assert [plan.preset for plan in found.plans] == [None, "ribbon", "leaf"]


def test_clicks_add_to_names_and_beside_them_layers_stand_still() -> None:
    art = replace(ART, layers=(PAPER, replace(RED, name="front hair"), BLUE))
    assert moving(art, None) == {"front hair": "hair"}
    assert moving(art, [[110, 40, 1]]) == {"front hair": "hair", "Layer 1": "hair"}
    assert moving(art, [[40, 40, 0]]) == {}
    assert moving(art, [[40, 40, 0], [40, 60, 1]]) == {"front hair": "hair"}, "the last point counts"


def test_what_is_seen_is_picked() -> None:
    veil = bar("veil", 100, (0, 0, 0), alpha=30)
    shade = bar("shade", 100, (90, 90, 90), blend="multiply")
    hidden = bar("hidden", 100, (90, 90, 90), visible=False)
    art = replace(ART, layers=(*ART.layers, veil, shade, hidden))
    assert moving(art, [ON_BLUE]) == {"Layer 1 (2)": "hair"}
    alone = replace(ART, layers=(bar("veil", 100, (0, 0, 0), alpha=30), RED))
    assert moving(alone, [ON_BLUE]) == {"veil": "hair"}, "where nothing else is, what shines through is"


def test_a_backdrop_and_nothing_stand_still_and_are_told_of() -> None:
    found = picked_layers(ART, "[[10, 110]]")
    assert (found.moving, len(found.told)) == ([], 1)
    assert "Part 1: the layer Layer 0 fills the whole picture" in found.told[0]
    bare = replace(ART, layers=(RED, BLUE))
    assert picked_layers(bare, "[[10, 110]]").told == ("Part 1: there is no layer at 10, 110.",)


def test_an_artwork_of_one_layer_is_a_flat_picture() -> None:
    drawn = replace(ART, layers=(PAPER, replace(RED, visible=False)))
    flat = flat_picture(drawn)
    assert flat is not None
    assert np.array_equal(flat, PAPER.pixels[..., :3])
    assert flat_picture(ART) is None
    assert flat_picture(replace(ART, layers=(replace(RED, name="front hair"),))) is None, "it moves by its name"


@pytest.mark.parametrize("point", [ON_RED, ON_BLUE])
def test_the_picked_layer_alone_moves_and_uncovers_what_is_behind_it(point: list[int]) -> None:
    plans = picked_layers(ART, str([point])).plans
    animation = animate(ART, layers=LayerChoice(plans=plans), timing=Timing(frames=12))
    first, last = (np.asarray(frame).astype(int) for frame in (list(animation.frames())[k] for k in (0, -1)))
    moved = np.abs(last - first).sum(axis=2)
    own, other = (slice(20, 70), slice(90, 150)) if point is ON_RED else (slice(90, 150), slice(20, 70))
    assert moved[20:110, own].max() > 150
    assert moved[:, other].max() == 0
