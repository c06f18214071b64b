"""Installs OpenCV for a ComfyUI host, where there is none; ComfyUI-Manager runs this after requirements.txt.

The distributions of OpenCV (opencv-python, opencv-contrib-python, and either of them -headless) put their files into
the same folder. So a cv2 that works is left alone, whatever its distribution and version: another extension may need
what only that one has.
"""

from __future__ import annotations

import subprocess
import sys

__all__ = ["main"]

_OPENCV = "opencv-python-headless>=4.9"
_INSTALLERS = ([sys.executable, "-m", "pip", "install"], ["uv", "pip", "install", "--python", sys.executable])


def main() -> int:
    """Install what is missing; the exit code."""
    if _imports_cv2():
        print("PhysAnimator: OpenCV is there and is left as it is")
        return 0
    for installer in _INSTALLERS:
        try:
            if subprocess.run([*installer, _OPENCV], check=False).returncode == 0 and _imports_cv2():
                return 0
        except OSError:  # there is no such program
            continue
    print(f"PhysAnimator: OpenCV could not be installed; install {_OPENCV} with {sys.executable}", file=sys.stderr)
    return 1


def _imports_cv2() -> bool:
    """Whether a fresh interpreter can use it: a broken one may end the process that imports it."""
    return (
        subprocess.run([sys.executable, "-c", "import cv2; cv2.imread"], capture_output=True, check=False).returncode
        == 0
    )


if __name__ == "__main__":
    sys.exit(main())
