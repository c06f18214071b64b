"""Meshes of parts as the picture shows them, which is what the renderer moves."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...physics.errors import InvalidInputError
from ...physics.mesh import TriangleMesh, mesh_from_mask, refuse_noise
from ..pictures import as_float, is_transparent, over
from .regularisation import regular_mask

__all__ = ["part_mesh", "shown_part"]

_HALF = 0.5


def shown_part(image: NDArray[Any], mask: NDArray[Any]) -> NDArray[np.float32]:
    """A part as the renderer cuts it out: its mask with its edge where the picture has one.

    Args:
        image: RGB or straight RGBA, uint8 or float32 in 0 to 1, shape [h, w, 3] or [h, w, 4].
        mask: soft mask in 0 to 1, shape [h, w].

    Returns:
        Soft mask in 0 to 1, shape [h, w].
    """
    flat = as_float(over(image))
    if is_transparent(image):
        flat = np.dstack([flat, as_float(image)[..., 3]])
    return regular_mask(flat, np.asarray(mask, dtype=np.float32))


def part_mesh(
    image: NDArray[Any],
    mask: NDArray[Any],
    *,
    spacing: float | None = None,
    elements_across: int = 3,
    uniform: bool = False,
) -> TriangleMesh:
    """The mesh of a part as the picture shows it, so that all that is drawn moves with the mesh.

    A mask whose edge is where the picture has it gives the same mesh as without a picture.

    Args:
        image: see :func:`shown_part`.
        mask: soft mask in 0 to 1, shape [h, w].
        spacing: see :func:`~physanimator.physics.mesh.mesh_from_mask`.
        elements_across: see there.
        uniform: see there.

    Raises:
        InvalidInputError: the mask gives no mesh.

    Examples:
        >>> import numpy as np
        >>> from physanimator.rendering.matting import part_mesh
        >>> picture = np.full((60, 60, 3), 230, np.uint8)
        >>> picture[10:50, 10:50] = (200, 60, 40)
        >>> mesh = part_mesh(picture, np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> mesh.width, mesh.height
        (60, 60)
    """
    refuse_noise(np.asarray(mask, dtype=np.float32))  # in which the search for edges would take long
    meshed = partial(mesh_from_mask, spacing=spacing, elements_across=elements_across, uniform=uniform)
    shown = shown_part(image, mask)
    if ((shown > _HALF) == (np.asarray(mask) > _HALF)).all():
        return meshed(mask)
    try:
        return meshed(shown)
    except InvalidInputError:
        return meshed(mask)
