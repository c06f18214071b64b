"""PhysAnimator: one still illustration becomes an animation driven by physics.

Importing this package has no effect beyond the names below: the host and the tests both import it, and
everything heavy is loaded when first needed.
"""

from __future__ import annotations

from typing import Any


def _version() -> str:
    """What pyproject.toml says, where it lies beside this file; else what pip has written from it."""
    import re
    from pathlib import Path

    try:
        project = Path(__file__).with_name("pyproject.toml").read_text(encoding="utf-8")
    except OSError:
        from importlib.metadata import version

        return version("physanimator")
    found = re.search(r'^version = "([^"]+)"', project, re.MULTILINE)
    return found[1] if found else "unknown"


__version__ = _version()

WEB_DIRECTORY = "./nodes/web"

__all__ = ["WEB_DIRECTORY", "__version__", "comfy_entrypoint"]


async def comfy_entrypoint() -> Any:
    """Return the node extension to a ComfyUI host (V3 entry point, called once at start-up)."""
    import importlib.util

    if importlib.util.find_spec("cv2") is None:
        raise ImportError("PhysAnimator needs OpenCV: run its install.py with the Python that runs ComfyUI")
    from .nodes.extension import PhysAnimatorExtension

    return PhysAnimatorExtension()
