"""Motions in which nothing can be seen to move: a sentence to show as a warning."""

from __future__ import annotations

import numpy as np

from .motion import Motion

__all__ = ["stillness"]

# What nobody sees: frames drawn with less differ by resampling alone [px].
_UNSEEN = 0.25
# Shorter trials end before the wind has come [s].
_LONG_ENOUGH = 0.5


def stillness(motion: Motion) -> list[str]:
    """A sentence where a motion of several frames shows nothing that anybody could see.

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.mesh import mesh_from_mask
        >>> from physanimator.physics.motion import Motion, stillness
        >>> from physanimator.physics.scene import Body
        >>> mesh = mesh_from_mask(np.pad(np.ones((40, 40)), 10), spacing=10)
        >>> motion = Motion((Body(mesh),), np.float32([mesh.vertices, mesh.vertices + (3, 0)]), frame_rate=24.0)
        >>> stillness(motion)
        []
    """
    moved = motion.positions - motion.positions[:1]
    farthest = float(np.hypot(moved[..., 0], moved[..., 1]).max(initial=0.0))
    if len(motion) < max(2, _LONG_ENOUGH * motion.frame_rate) or farthest >= _UNSEEN:
        return []
    what = f"nothing moves by more than {farthest:.2f} px" if farthest >= 0.01 else "nothing moves at all"
    return [
        f"{what} in {len(motion)} frames: is everything held, do strokes and wind"
        " reach the bodies, and are they strong and early enough?"
    ]
