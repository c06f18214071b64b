"""How finely masks and layers are meshed, as inputs."""

from __future__ import annotations

from comfy_api.latest import io

from .host import default_of

__all__ = ["mesh_inputs", "spacing_advice", "spacing_of"]


def mesh_inputs(what: str) -> list[io.Input]:
    """The inputs ``spacing`` and ``elements_across``.

    Args:
        what: is meshed.
    """
    from ..physics.mesh import mesh_from_mask

    return [
        io.Float.Input(
            "spacing",
            default=0.0,
            min=0.0,
            max=512.0,
            step=0.5,
            tooltip=f"Length of the triangles' edges [px]; 0 chooses one that suits {what}. Smaller bends more finely"
            " and takes longer; below 2 it is 2.",
        ),
        io.Int.Input(
            "elements_across",
            default=default_of(mesh_from_mask, "elements_across"),
            min=1,
            max=20,
            tooltip="How many triangles thin strands get across, where the spacing alone would give fewer.",
        ),
    ]


def spacing_of(spacing: float) -> float | None:
    """The spacing that a mesh takes, from the input's value: a widget has no gap between 0 and the least.

    Args:
        spacing: of the input [px].

    Returns:
        In px; None to have one chosen.
    """
    from ..physics.mesh import LEAST_SPACING

    return max(spacing, LEAST_SPACING) if spacing else None


def spacing_advice(spacing: float) -> list[str]:
    """What to tell of a spacing that is taken as another; see :func:`spacing_of`."""
    from ..physics.mesh import LEAST_SPACING

    if not 0 < spacing < LEAST_SPACING:
        return []
    return [f"spacing is taken as {LEAST_SPACING:g} px, the least that a mesh can have. Got: {spacing:g} px"]
