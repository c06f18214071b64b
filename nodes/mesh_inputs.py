"""How finely masks and layers are meshed, as inputs."""

from __future__ import annotations

from comfy_api.latest import io

from .host import default_of

__all__ = ["mesh_inputs"]


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
            " and takes longer.",
        ),
        io.Int.Input(
            "elements_across",
            default=default_of(mesh_from_mask, "elements_across"),
            min=1,
            max=20,
            tooltip="How many triangles thin strands get across, where the spacing alone would give fewer.",
        ),
    ]
