"""Line drawings from illustrations, without a network: a flow-based extended difference of Gaussians.

After Kang, Lee and Chui, "Flow-based image abstraction" (2009), and Winnemoeller, Kyprianidis and Olsen, "XDoG"
(2012). Three changes suit drawn art. Both Gaussians weigh the same, so that flat areas and even gradients answer with
0 at any brightness: black hair comes out as its contour, not as a black shape. And every colour channel is asked, so
that a contour between two colours of equal brightness is found too. And a line that fades is followed to its end, while
what is faint throughout is left out, as an edge detector with two thresholds does it (Canny, 1986).
"""

from __future__ import annotations

from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from ...physics.errors import require
from ..pictures import StructureTensor, as_float, as_picture

__all__ = ["cleaned", "extract_sketch"]

FloatImage = NDArray[np.float32]

# Width of the outer Gaussian over that of the inner one: close to a Laplacian of Gaussian (Marr and Hildreth, 1980).
_SURROUND = 1.6
# Answer to a black line of the nominal width on white: the shares of both Gaussians within it, erf(1 / sqrt 2) and
# erf(1 / (1.6 sqrt 2)).
_PEAK = 0.683 - 0.468
# Shares of the threshold above which a line is followed, and which it must reach somewhere. Canny advises a ratio of 2
# to 3; with 4, fading ends are followed further: half and twice either change the ink of the bundled example by a
# quarter at most, and sketches of noisy and compressed copies of it stay within 0.7 px of its own.
_FOLLOWED, _REACHED = 0.5, 2.0
# Brightness below which equal differences rather than equal ratios look equal. Half and twice of it change the ink of
# the bundled example by a tenth.
_DARK = 0.25


def extract_sketch(
    image: NDArray[Any],
    *,
    line_width: float = 2.0,
    threshold: float = 0.06,
    sharpness: float = 12.0,
    coherence: float = 3.0,
    smallest_speck: int = 24,
) -> FloatImage:
    """Dark lines on white paper.

    Args:
        image: RGB, uint8 or float in 0..1, shape [h, w, 3].
        line_width: width of the lines that answer most [px].
        threshold: how much darker than its surroundings a line must be, where 1 is black on white; higher leaves
            faint lines out. A line may fade to half of it, and must somewhere reach twice as much.
        sharpness: how fast a line turns from grey to black above the threshold.
        coherence: length over which lines are smoothed along their own direction [px]; 0 leaves them as they are.
        smallest_speck: connected lines of fewer pixels are left out [px^2].

    Returns:
        sketch, paper 1 and lines towards 0, float32, shape [h, w].

    Raises:
        InvalidInputError: the picture or a parameter is unusable.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.sketch import extract_sketch
        >>> picture = np.full((40, 40, 3), 255, np.uint8)
        >>> picture[:, 19:21] = 0
        >>> sketch = extract_sketch(picture)
        >>> bool(sketch[20, 20] < 0.2), float(sketch[20, 5])
        (True, 1.0)
    """
    picture = as_float(as_picture(image), exact=False)
    require("line_width", line_width, 0.5 <= line_width <= 50, "0.5 to 50 px")
    require("threshold", threshold, 0 < threshold < 1, "above 0 and below 1")
    require("sharpness", sharpness, 0 < sharpness < np.inf, "above 0")
    require("coherence", coherence, 0 <= coherence <= 20, "0 to 20 px")
    require("smallest_speck", smallest_speck, smallest_speck >= 0, "at least 0 px^2")
    # A Gaussian second derivative answers most to a bar of width 2 sigma.
    sigma = line_width / 2
    response = _darkness(_evened(picture), sigma)
    if coherence > 0:
        response = _smoothed_along_lines(response, _tangents(picture, 2 * sigma), coherence)
    density = np.tanh(np.maximum(response - _FOLLOWED * threshold, 0) * sharpness)
    return 1 - density * _lines(response, threshold, smallest_speck)


def cleaned(density: FloatImage, *, threshold: float, smallest_speck: int) -> FloatImage:
    """A sketch from the lines that someone else has drawn, by the same rules.

    Args:
        density: how dark, paper 0 and lines towards 1, shape [h, w].
        threshold: see :func:`extract_sketch`.
        smallest_speck: see :func:`extract_sketch`.

    Returns:
        sketch, paper 1 and lines towards 0, float32, shape [h, w].

    Raises:
        InvalidInputError: a parameter is unusable.
    """
    require("threshold", threshold, 0 < threshold < 1, "above 0 and below 1")
    require("smallest_speck", smallest_speck, smallest_speck >= 0, "at least 0 px^2")
    faintest = np.float32(_FOLLOWED * threshold)
    ink = np.clip((density - faintest) / (1 - faintest), 0, 1).astype(np.float32)
    return 1 - ink * _lines(density, threshold, smallest_speck)


def _evened(picture: FloatImage) -> FloatImage:
    """Tones compressed as the eye does it, 0..1, so that a line on a dark coat counts as one on a white shirt."""
    return cv2.log(picture + np.float32(_DARK)) * np.float32(1 / np.log1p(1 / _DARK))


def _blurred(picture: FloatImage, sigma: float) -> FloatImage:
    return cv2.GaussianBlur(picture, (0, 0), sigma, borderType=cv2.BORDER_REPLICATE)


def _darkness(picture: FloatImage, sigma: float) -> FloatImage:
    """How much darker each pixel is than its surroundings, in the channel where it is most, shape [h, w]."""
    difference = _blurred(picture, _SURROUND * sigma) - _blurred(picture, sigma)
    red, green, blue = cv2.split(difference)
    return np.maximum(np.maximum(red, green), blue) * np.float32(1 / _PEAK)


def _tangents(picture: FloatImage, sigma: float) -> FloatImage:
    """Unit vectors along the edges, from the smoothed structure tensor of all channels, shape [h, w, 2]."""
    xx, yy, xy = (np.zeros(picture.shape[:2], dtype=np.float32) for _ in range(3))
    for channel in cv2.split(picture):
        dx, dy = cv2.Sobel(channel, cv2.CV_32F, 1, 0), cv2.Sobel(channel, cv2.CV_32F, 0, 1)
        cv2.accumulateSquare(dx, xx)
        cv2.accumulateSquare(dy, yy)
        cv2.accumulateProduct(dx, dy, xy)
    xx, yy, xy = (_blurred(product, sigma) for product in (xx, yy, xy))
    return np.asarray(StructureTensor(xx, xy, yy).along)


def _smoothed_along_lines(response: FloatImage, tangents: FloatImage, length: float) -> FloatImage:
    """Gaussian mean of the response along the tangent, which closes gaps and removes specks without widening lines."""
    height, width = response.shape
    columns, rows = np.meshgrid(np.arange(width, dtype=np.float32), np.arange(height, dtype=np.float32))
    here = np.dstack([columns, rows])
    total, weights = response.copy(), 1.0
    for step in range(1, int(np.ceil(length)) + 1):
        weight = float(np.exp(-0.5 * (2 * step / length) ** 2))
        for side in (step, -step):
            there = here + np.float32(side) * tangents
            sample = cv2.remap(response, there, None, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
            total += np.float32(weight) * sample
        weights += 2 * weight
    return total / np.float32(weights)


def _lines(response: FloatImage, threshold: float, smallest: int) -> NDArray[np.bool_]:
    """True on connected lines that are large enough and somewhere dark enough, shape [h, w]."""
    followed = (response > _FOLLOWED * threshold).astype(np.uint8)
    _, labels, stats, _ = cv2.connectedComponentsWithStats(followed, connectivity=8)
    keep = np.zeros(len(stats), dtype=bool)
    keep[labels[response > _REACHED * threshold]] = True
    keep &= stats[:, cv2.CC_STAT_AREA] >= smallest
    keep[0] = False
    return keep[labels]
