"""Line drawings: lines where there are lines, paper where there is none."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.sketch import cleaned, extract_sketch

HEIGHT, WIDTH = 80, 120


def page(colour: tuple[int, int, int] = (255, 255, 255)) -> NDArray[np.uint8]:
    return np.full((HEIGHT, WIDTH, 3), colour, np.uint8)


def test_a_black_line_on_white_paper_comes_out_as_that_line() -> None:
    image = page()
    image[:, 60:62] = 0
    sketch = extract_sketch(image)
    assert sketch.dtype == np.float32
    assert sketch.shape == (HEIGHT, WIDTH)
    assert (sketch[:, 60:62] < 0.1).all()
    assert (sketch[:, :57] == 1).all()
    assert (sketch[:, 65:] == 1).all()


@pytest.mark.parametrize("colour", [(255, 255, 255), (0, 0, 0), (120, 60, 200), (255, 220, 180)])
def test_flat_colour_is_white_paper(colour: tuple[int, int, int]) -> None:
    assert (extract_sketch(page(colour)) == 1).all()


def test_an_even_gradient_is_white_paper() -> None:
    image = np.broadcast_to(np.linspace(0.2, 0.9, WIDTH, dtype=np.float32)[None, :, None], (HEIGHT, WIDTH, 3))
    assert (extract_sketch(image) == 1).all()


def test_a_black_shape_becomes_its_contour() -> None:
    image = page()
    image[20:60, 30:90] = 0
    sketch = extract_sketch(image)
    assert (sketch[25:55, 40:80] == 1).all()
    assert (sketch[25:55, 30] < 0.2).all()


def test_colours_of_equal_brightness_are_told_apart() -> None:
    image = page((230, 60, 60))
    image[:, 60:] = (30, 130, 230)
    assert extract_sketch(image)[:, 58:62].min(axis=1).max() < 0.2


def test_a_line_on_a_dark_coat_is_found() -> None:
    image = page((50, 50, 60))
    image[:, 60:62] = (20, 20, 25)
    assert (extract_sketch(image)[:, 60] < 0.5).all()


def test_specks_are_left_out_and_kept_on_demand() -> None:
    image = page()
    image[30:32, 30:32] = 100
    assert (extract_sketch(image) == 1).all()
    assert extract_sketch(image, smallest_speck=0)[30, 30] < 0.5


def test_coherence_closes_a_gap_in_a_line() -> None:
    image = page()
    image[39:41] = 0
    image[:, 60:63] = 255
    assert extract_sketch(image, coherence=6)[39, 61] < 0.5 < extract_sketch(image, coherence=0)[39, 61]


def test_a_higher_threshold_leaves_faint_lines_out() -> None:
    image = page()
    image[39:41] = 170
    assert extract_sketch(image)[39, 60] < 0.5
    assert (extract_sketch(image, threshold=0.4) == 1).all()


def test_a_line_that_fades_is_followed_to_its_end_and_one_that_is_faint_throughout_is_not() -> None:
    image = page()
    fading = np.linspace(120, 245, 80).astype(np.uint8)
    image[19:21, 20:100] = fading[None, :, None]
    image[59:61, 60:100] = fading[None, 40:, None]
    sketch, faint = extract_sketch(image), extract_sketch(image, threshold=0.15)
    assert (sketch[19:21, 22:94] < 0.99).all()
    assert (faint[19:21, 22:80] < 0.99).all()
    assert (faint[55:65] == 1).all()


def test_a_drawing_from_elsewhere_is_cleaned_by_the_same_rules() -> None:
    density = np.full((HEIGHT, WIDTH), 0.02, np.float32)
    density[20, 10:100] = np.linspace(0.9, 0.05, 90)
    density[40, 10:100] = 0.05
    density[60:62, 60:62] = 1
    sketch = cleaned(density, threshold=0.06, smallest_speck=24)
    assert sketch[20, 10] < 0.15
    assert (sketch[20, 10:100] < 1).all()
    assert (sketch[30:] == 1).all()


def test_float_pictures_give_the_same_sketch() -> None:
    image = cv2.circle(page((200, 180, 160)), (60, 40), 20, (40, 20, 60), 2)
    np.testing.assert_allclose(extract_sketch(image), extract_sketch(image.astype(np.float32) / 255), atol=1e-4)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"line_width": 0}, "line_width must be"),
        ({"threshold": 0}, "threshold must be"),
        ({"sharpness": -1}, "sharpness must be"),
        ({"coherence": -1}, "coherence must be"),
        ({"smallest_speck": -1}, "smallest_speck must be"),
    ],
)
def test_bad_parameters(changes: dict[str, float], message: str) -> None:
    with pytest.raises(InvalidInputError, match=message):
        extract_sketch(page(), **changes)


def test_a_grey_picture_is_refused() -> None:
    with pytest.raises(InvalidInputError, match=r"image must be an RGB picture of shape \[h, w, 3\]"):
        extract_sketch(np.zeros((10, 10), np.uint8))
