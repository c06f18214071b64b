"""ComfyUI's LAYERS and See-through's parts, as their own nodes make them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
import torch
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.artwork import (
    ArtLayer,
    Artwork,
    flattened,
    from_layers_dictionary,
    from_see_through,
    to_layers_dictionary,
)


def drawn(height: int = 4, width: int = 6, count: int = 1) -> torch.Tensor:
    pixels = np.random.default_rng(1).integers(0, 256, (count, height, width, 3)) / 255
    return torch.tensor(pixels, dtype=torch.float32)


def document(**item: Any) -> dict[str, Any]:
    return {"version": 1, "canvas": (20, 16), "layers": [{"type": "raster", "image": drawn(), "z_index": 0, **item}]}


def only(value: dict[str, Any]) -> ArtLayer:
    (layer,) = from_layers_dictionary(value).layers
    return layer


def test_the_plainest_document() -> None:
    artwork = from_layers_dictionary({"layers": [{"image": drawn()}]})
    assert (artwork.width, artwork.height, artwork.names) == (6, 4, ("layer 1",))
    assert np.array_equal(artwork.layers[0].pixels[..., :3], np.rint(drawn()[0].numpy() * 255))


def test_order_is_that_of_z_index_and_then_of_the_list() -> None:
    layers = [{"image": drawn(), "name": name, "z_index": z} for name, z in (("c", 5), ("a", -1), ("d", 5), ("b", 0))]
    assert from_layers_dictionary({"layers": layers}).names == ("a", "b", "c", "d")


def test_a_mask_is_transparent_where_it_is_white() -> None:
    mask = torch.zeros(1, 4, 6)
    mask[:, :, 3:] = 1
    layer = only(document(mask=mask, x=2, y=-1))
    assert layer.box == (2, -1, 5, 3)
    assert layer.pixels[..., 3].min() == 255


def test_a_batch_is_a_layer_each() -> None:
    artwork = from_layers_dictionary(document(image=drawn(count=3), name="hair"))
    assert artwork.names == ("hair 1", "hair 2", "hair 3")


def test_mirrored_scaled_and_turned() -> None:
    own = only(document()).pixels
    assert np.array_equal(only(document(flip_h=True)).pixels, own[:, ::-1])
    assert np.array_equal(only(document(flip_v=True)).pixels, own[::-1])
    large = only(document(w=12, h=8, x=1))
    assert large.box == (1, 0, 13, 8)
    quarter = only(document(rotation=math.pi / 2, x=4, y=5))
    assert quarter.box == (5, 4, 9, 10)  # around the same middle
    assert np.array_equal(quarter.pixels, np.rot90(own, -1))  # clockwise
    half = only(document(rotation=math.pi))
    assert np.array_equal(half.pixels, own[::-1, ::-1])


def test_modes_and_what_is_not_drawn() -> None:
    assert only(document(blend_mode="linear-dodge", opacity=0.25)).blend == "add"
    artwork = from_layers_dictionary(document(blend_mode="hard-mix", name="glow"))
    assert artwork.warnings == ("layer glow: blend mode hard-mix is drawn as normal",)


def test_values_between_levels_get_16_bits() -> None:
    assert only(document(image=torch.full((1, 4, 6, 4), 0.4995))).pixels.dtype == np.uint16


def test_without_a_canvas_it_is_as_large_as_what_lies_on_it() -> None:
    layers = [{"image": drawn(), "x": 10, "y": 3}, {"image": drawn(), "x": -30, "y": -30}]
    artwork = from_layers_dictionary({"layers": layers})
    assert (artwork.width, artwork.height) == (16, 7)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"image": None}, "image must"),
        ({"image": torch.zeros(4, 6, 3)}, r"image must have shape \[b, h, w, 3 or 4\]"),
        ({"image": torch.full((1, 4, 6, 3), float("nan"))}, "finite"),
        ({"type": "vector"}, "type must be raster"),
        ({"opacity": float("nan")}, "opacity must be a number"),
        ({"x": float("inf")}, "x must be a number"),
        ({"w": 10**9}, "w must be a number of at most"),
        ({"w": 200_000, "h": 200_000}, "what is placed must have"),
        ({"rotation": float("inf")}, "rotation must be an angle"),
        ({"mask": torch.zeros(4)}, "mask must have shape"),
    ],
)
def test_wrong_layers(change: dict[str, Any], said: str) -> None:
    with pytest.raises(InvalidInputError, match=said):
        from_layers_dictionary(document(**change))


@pytest.mark.parametrize("value", [None, [], {}, {"layers": 3}, {"layers": [], "version": 2}])
def test_wrong_documents(value: object) -> None:
    with pytest.raises(InvalidInputError):
        from_layers_dictionary(value)


def test_more_layers_than_comfyui_takes() -> None:
    layer = ArtLayer("a", np.full((1, 1, 4), 255, np.uint8))
    with pytest.raises(InvalidInputError, match=r"at most 50, which is what ComfyUI takes. Got: 51"):
        to_layers_dictionary(Artwork(4, 4, (layer,) * 51))


def test_parts_of_see_through() -> None:
    red, blue = np.uint8([255, 0, 0, 255]), np.uint8([0, 0, 255, 255])
    parts = {
        "front hair": {"img": np.tile(red, (4, 4, 1)), "xyxy": [2, 1, 6, 5], "depth_median": 0.2},
        "back hair": {"img": np.tile(blue, (4, 4, 1)), "xyxy": np.array([0, 0, 4, 4]), "depth_median": np.float32(0.7)},
    }
    artwork = from_see_through({"frame_size": (8, 9), "tag2pinfo": parts})
    assert (artwork.width, artwork.height, artwork.names) == (9, 8, ("back hair", "front hair"))
    assert artwork.layers[1].box == (2, 1, 6, 5)
    picture = flattened(artwork)
    assert picture[2, 3].tolist() == red.tolist()
    assert picture[0, 0].tolist() == blue.tolist()


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"img": np.zeros((4, 4, 3), np.uint8)}, r"part hair must be uint8 of shape \[h, w, 4\]"),
        ({"img": None}, "part hair must"),
        ({"xyxy": ["a", 2]}, "part hair: xyxy must be numbers"),
        ({"xyxy": 3}, "part hair: xyxy must be numbers"),
        ({"depth_median": "far"}, "part hair: depth_median must be a number"),
    ],
)
def test_wrong_parts(change: dict[str, Any], said: str) -> None:
    part = {"img": np.zeros((4, 4, 4), np.uint8), "xyxy": [0, 0, 4, 4], "depth_median": 0.5, **change}
    with pytest.raises(InvalidInputError, match=said):
        from_see_through({"frame_size": (8, 8), "tag2pinfo": {"hair": part}})
    with pytest.raises(InvalidInputError):
        from_see_through({"frame_size": (8,), "tag2pinfo": {}})
