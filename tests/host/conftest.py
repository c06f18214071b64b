"""Starts a real ComfyUI once for all tests of this folder.

Set ``COMFYUI_PATH`` to a ComfyUI checkout and run pytest with the Python of its environment, or name that Python in
``COMFYUI_PYTHON``. ``COMFYUI_ARGUMENTS`` adds arguments, such as ``--front-end-root FOLDER`` for another frontend;
``COMFYUI_PACKS`` names folders of other packs that shall stand beside ours, such as ComfyUI-LTXVideo;
``CHROMIUM`` names the browser when it is not /usr/bin/chromium.
"""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

REASON = "set COMFYUI_PATH to a ComfyUI checkout (and COMFYUI_PYTHON to its Python) to test in a real host"


def _sibling(name: str) -> ModuleType:
    spec = importlib.util.spec_from_file_location(name, Path(__file__).with_name(f"{name}.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module
    spec.loader.exec_module(module)
    return module


comfy_host = _sibling("comfy_host")
browser = _sibling("browser")
editor_page = _sibling("editor_page")
_sibling("stamps")
_sibling("blueprints")
_sibling("frame_interpolation_graph")
_sibling("graphs")
_sibling("layer_graphs")
_sibling("paper_graphs")
_sibling("showcase_graphs")
_sibling("layered_files")
_sibling("time_to_move_graphs")
_sibling("video_model_graphs")
_sibling("more_video_model_graphs")


@pytest.fixture(scope="session")
def host(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    path = os.environ.get("COMFYUI_PATH")
    if not path:
        pytest.skip(REASON)
    checkout = Path(path).resolve()
    assert (checkout / "main.py").is_file(), f"COMFYUI_PATH must hold ComfyUI's main.py. Got: {checkout}"
    python = os.environ.get("COMFYUI_PYTHON", sys.executable)
    server = comfy_host.Host(checkout, python, tmp_path_factory.mktemp("comfyui"))
    try:
        server.wait_until_ready()
        yield server
    finally:
        server.stop()


@pytest.fixture(scope="session")
def page(host: Any) -> Iterator[Any]:
    """The host's page in Chromium; ``page.problems`` collects what its console complains about."""
    pytest.importorskip("playwright", reason="the browser tests need playwright in the host's environment")
    if not browser.EXECUTABLE.exists():
        pytest.skip(f"the browser tests need Chromium at {browser.EXECUTABLE}; set CHROMIUM to another place")
    with browser.opened(host.url) as opened:
        yield opened
