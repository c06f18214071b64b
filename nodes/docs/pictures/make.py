"""Makes the pictures of the pages again, with the commands that the pages show: ``python nodes/docs/pictures/make.py``.

Names of pages limit it: ``python nodes/docs/pictures/make.py hair gallery``. PhysAnimator must be installed, or its
folder's parent be in PYTHONPATH.
"""

from __future__ import annotations

import importlib.util
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from types import ModuleType

HERE = Path(__file__).resolve().parent
SITE = HERE.parent


def main(only: list[str]) -> None:
    """Run every command that is marked as making a picture, where its page's files lie."""
    reading = _commands_module()
    for page in reading.pages_of(SITE):
        marked = [each for each in reading.commands_of(page) if each.picture]
        if not marked or (only and page.stem not in only):
            continue
        with tempfile.TemporaryDirectory() as folder:
            for path in reading.files_of(page):
                shutil.copy(path, folder)
            for command in marked:
                print("+", *command.words, flush=True)
                subprocess.run([sys.executable, "-m", *command.words, "--quiet"], cwd=folder, check=True)
                shutil.copy(Path(folder, command.picture), HERE)


def _commands_module() -> ModuleType:
    spec = importlib.util.spec_from_file_location("page_commands", SITE / "made_from" / "commands.py")
    assert spec is not None
    assert spec.loader is not None
    sys.modules["page_commands"] = module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    main(sys.argv[1:])
