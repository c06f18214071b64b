"""What moves by its name, and the user's word above it."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import PRESETS
from physanimator.rendering.artwork import ArtLayer, Artwork, moving_layers, rule_of

PIXELS = np.full((4, 4, 4), 255, np.uint8)


def art(*names: str, **values: object) -> Artwork:
    return Artwork(4, 4, tuple(ArtLayer(name, PIXELS, **values) for name in names))  # type: ignore[arg-type]


def moving(artwork: Artwork, **words: object) -> list[str]:
    return [plan.name for plan in moving_layers(artwork, **words) if plan.moves]  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "preset", "held"),
    [
        ("front hair", "hair", "top"),
        ("back hair-l", "hair", "covered"),
        ("hairf", "hair", "top"),
        ("hairb_2", "hair", "covered"),
        ("Hair_Back_01", "hair", "covered"),
        ("hair 02 back", "hair", "covered"),
        ("FrontHair", "hair", "top"),
        ("前髪", "hair", "top"),
        ("後ろ髪", "hair", "covered"),
        ("髪 後ろ", "hair", "covered"),
        ("横髪右", "hair", "top"),
        ("刘海", "hair", "top"),
        ("后发_1", "hair", "covered"),
        ("ツインテール左", "hair", "covered"),
        ("Ribbon (2)", "ribbon", "end"),
        ("リボン", "ribbon", "end"),
        ("丝带", "ribbon", "end"),
        ("hair bow", "ribbon", "end"),
        ("skirt", "cloth", "waist"),
        ("bottomwear", "cloth", "waist"),
        ("スカート", "cloth", "waist"),
        ("ｽｶｰﾄ", "cloth", "waist"),
        ("裙子", "cloth", "waist"),
        ("マント", "cloth", "covered"),
        ("cape", "cloth", "covered"),
        ("tail", "hair", "end"),
        ("尻尾", "hair", "end"),
        ("wings-r", "cloth", "end"),
        ("leaves", "leaf", "bottom"),
        ("scarf", "ribbon", "end"),
        ("マフラー", "ribbon", "end"),
        ("cat ears", "leaf", "bottom"),
    ],
)
def test_names_that_move(name: str, preset: str, held: str) -> None:
    rule = rule_of(name)
    assert (rule.moves, rule.preset, rule.held, rule.alternate) == (True, preset, held, False)
    assert preset in PRESETS


@pytest.mark.parametrize(
    "name",
    [
        *(
            "face",
            "eyewhite-l",
            "irides",
            "eyelash",
            "eyebrow",
            "eyewear",
            "ears-r",
            "earwear",
            "nose",
            "mouth",
            "neck",
        ),
        *(
            "neck",
            "topwear",
            "handwear",
            "legwear",
            "footwear",
            "headwear",
            "objects",
            "顔",
            "首",
            "耳",
            "目",
            "腕",
            "背景",
        ),
        *(
            "chair",
            "detail",
            "Layer 12",
            "hairpin",
            "髪飾り",
            "ヘアピン",
            "hair band",
            "cloud",
            "escape",
            "twinkle",
            "",
        ),
        *("blackboard", "paper", "レイヤー 3", "图层 1"),
    ],
)
def test_names_that_stand_still(name: str) -> None:
    rule = rule_of(name)
    assert (rule.moves, rule.preset, rule.alternate) == (False, None, False)


@pytest.mark.parametrize(
    ("name", "beside"),
    [
        ("eye_close", "irides"),
        ("eye_close-l", "eyewhite-l"),
        ("閉じ目", "瞳"),
        ("mouth_close", "mouth"),
        ("閉じ口", "口"),
    ],
)
def test_an_alternate_is_left_out_beside_its_open_form_only(name: str, beside: str) -> None:
    plan = moving_layers(art("face", name, beside))[1]
    assert (plan.shown, plan.moves) == (False, False)
    assert "another state" in plan.why
    assert moving_layers(art("face", name))[1].shown


def test_the_users_word_stands_above_the_table() -> None:
    artwork = art("face", "前髪", "skirt", "thing")
    assert moving(artwork) == ["前髪", "skirt"]
    assert moving(artwork, move=["thing", "FACE"], still=["skirt"]) == ["face", "前髪", "thing"]
    plans = moving_layers(artwork, move=["thing=jelly", "skirt=leaf"])
    assert [plan.preset for plan in plans] == [None, "hair", "leaf", "jelly"]


def test_two_layers_of_one_name_move_together_or_alone() -> None:
    artwork = art("thing", "thing")
    assert moving(artwork, move=["thing"]) == ["thing", "thing (2)"]
    assert moving(artwork, move=["thing (2)"]) == ["thing (2)"]


def test_what_is_hidden_or_empty_does_not_move_by_its_name() -> None:
    assert moving(art("hair", visible=False)) == []
    assert moving(Artwork(4, 4, (ArtLayer("hair", PIXELS[:0]), ArtLayer("hair", PIXELS * 0)))) == []
    assert moving(art("hair", blend="multiply")) == []


def test_wrong_words_of_the_user() -> None:
    with pytest.raises(InvalidInputError, match="there must be a layer wing; there are face, hair"):
        moving_layers(art("face", "hair"), move=["wing"])
    with pytest.raises(InvalidInputError, match="layer hair must either move or stand still"):
        moving_layers(art("face", "hair"), move=["hair"], still=["hair"])
    with pytest.raises(InvalidInputError, match="preset of layer hair must be one of"):
        moving_layers(art("face", "hair"), move=["hair=steel"])
