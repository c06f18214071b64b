"""What is written where nothing moves."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.composite import Background, background_of, usual_background
from physanimator.rendering.pictures import over


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("picture", Background()),
        (" Transparent ", Background("transparent")),
        ("parts", Background("parts")),
        ("skyblue", Background("picture", (135, 206, 235))),
        ("#8cf", Background("picture", (136, 204, 255))),
        ("#102030", Background("picture", (16, 32, 48))),
    ],
)
def test_names_and_colours(text: str, expected: Background) -> None:
    assert background_of(text) == expected
    assert expected.has_alpha == (expected.kind != "picture")


@pytest.mark.parametrize("text", ["", "pictures", "#12", "#11223344", "#1234", "rgba(1, 2, 3, 4)", "12", "x" * 1000])
def test_anything_else_is_refused_in_one_sentence(text: str) -> None:
    with pytest.raises(InvalidInputError, match=r"^background must be picture, transparent, parts, or a colour") as got:
        background_of(text)
    assert len(str(got.value)) < 200
    with pytest.raises(InvalidInputError, match="parts, layers, or a colour"):
        background_of(text, others=["layers"])


@pytest.mark.parametrize(
    ("transparent", "alpha", "parts", "kind"),
    [
        (False, True, False, "picture"),
        (False, True, True, "parts"),
        (False, False, False, "picture"),
        (True, True, False, "transparent"),
        (True, True, True, "transparent"),
        (True, False, True, "picture"),
    ],
)
def test_transparency_stays_where_the_file_can_hold_it(transparent: bool, alpha: bool, parts: bool, kind: str) -> None:
    assert usual_background(transparent_picture=transparent, file_has_alpha=alpha, parts=parts).kind == kind


@pytest.mark.parametrize("dtype", [np.uint8, np.float32])
def test_a_picture_over_a_colour(dtype: type) -> None:
    most = 255 if dtype == np.uint8 else 1
    image = np.zeros((2, 3, 4), dtype)
    image[0] = np.array([most, 0, 0, 0], dtype)  # hidden
    image[1, :, 1], image[1, :, 3] = most, np.array([most, most // 2 if most == 255 else 0.5, 0], dtype)
    shown = over(image, (0, 0, 255))
    assert shown.dtype == dtype
    assert (shown[0] == np.array([0, 0, most])).all()
    assert (shown[1, 0] == np.array([0, most, 0])).all()
    assert np.allclose(shown[1, 1] / most, [0, 0.5, 0.5], atol=0.003)
    opaque = image[..., :3]
    assert over(opaque) is opaque
