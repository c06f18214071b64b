"""PhysAnimator: one still illustration becomes an animation driven by physics.

Importing this package has no effect beyond the names below: the host and the tests both import it, and
everything heavy is loaded when first needed.
"""

from __future__ import annotations

from typing import Any

__version__ = "0.1.0"

WEB_DIRECTORY = "./nodes/web"

__all__ = ["WEB_DIRECTORY", "__version__", "comfy_entrypoint"]


async def comfy_entrypoint() -> Any:
    """Return the node extension to a ComfyUI host (V3 entry point, called once at start-up)."""
    import importlib.util

    if importlib.util.find_spec("cv2") is None:
        raise ImportError("PhysAnimator needs OpenCV: run its install.py with the Python that runs ComfyUI")
    from .nodes.extension import PhysAnimatorExtension

    return PhysAnimatorExtension()
