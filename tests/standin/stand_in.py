"""The stand-in as a test drives it, in the words of ``tests/host/comfy_host.py``."""

from __future__ import annotations

import asyncio
import copy
import importlib.util
import itertools
import json
import shutil
import sys
from pathlib import Path
from typing import Any

from .checking import checked_prompt
from .running import Kept, Run

__all__ = ["StandIn"]

_SEE_THROUGH = Path(__file__).resolve().parents[1] / "host" / "see_through_stand_in" / "__init__.py"
_EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example"
_PACK = "custom_nodes.PhysAnimator"
_KEPT = 48
"""Results that are kept, as by the host with ``--cache-lru``."""


class StandIn:
    """A host without a server; use it while the modules are ``installed``.

    Attributes:
        folder: with input, where the example's pictures are, output, temp and models.
        known: classes of nodes by name.
        progress: (node, done, total) of every step that a node has told, in this run.
        executed: the nodes that the last run has computed.
    """

    def __init__(self, folder: Path) -> None:
        import comfy.utils
        import folder_paths
        import server

        from . import core_nodes

        self.folder, self.known = folder, sys.modules["nodes"].NODE_CLASS_MAPPINGS
        folder_paths.use(folder)
        for picture in _EXAMPLE.glob("*.png"):
            shutil.copy(picture, folder / "input")
        self.server = server.PromptServer.instance
        self._numbers, self._kept = itertools.count(), dict[Any, Kept]()
        self._history: dict[str, Any] = {}
        self.progress: list[tuple[str, float, float]] = []
        self.executed: list[str] = []
        comfy.utils.PROGRESS_BAR_HOOK = self.progressed
        for kind in core_nodes.NODES:
            self.known[kind.GET_SCHEMA().node_id] = kind
        self._add_pack()
        self.known.update(_see_through())

    def _add_pack(self) -> None:
        import physanimator

        extension = asyncio.run(physanimator.comfy_entrypoint())
        for kind in asyncio.run(extension.get_node_list()):
            kind.RELATIVE_PYTHON_MODULE = _PACK
            self.known[kind.GET_SCHEMA().node_id] = kind

    def object_info(self, kind: str) -> dict[str, Any]:
        """What the host reports of a node, as JSON."""
        return json.loads(json.dumps(self.known[kind].GET_NODE_INFO_V1()))

    def post(self, prompt: dict[str, Any]) -> tuple[dict[str, Any], Run | None]:
        """Check a prompt as when it is posted: errors by node, and the run if any output can be made."""
        prompt = copy.deepcopy(prompt)
        for handler in self.server.on_prompt_handlers:
            handler({"prompt": prompt})
        checked = checked_prompt(prompt, self.known, f"prompt-{next(self._numbers)}")
        if not checked.outputs:
            return checked.errors, None
        run = Run(checked, self._kept)
        self._start(run, checked.outputs)
        return checked.errors, run

    def run(self, prompt: dict[str, Any]) -> dict[str, Any]:
        """What the nodes of a prompt that must succeed have shown, by node, as JSON."""
        errors, run = self.post(prompt)
        assert run is not None, errors
        assert not errors, errors
        return json.loads(json.dumps(run.shown))

    def error_of(self, prompt: dict[str, Any]) -> str:
        """What a prompt that must fail says: refused at once, or in the node that raised.

        Outputs of the prompt that do not need what is refused run all the same, as in the host.
        """
        try:
            errors, _ = self.post(prompt)
        except Exception as error:  # whatever a node raises
            return str(error)
        assert errors, "the prompt has run"
        return json.dumps(errors, ensure_ascii=False)

    def file(self, saved: dict[str, str]) -> Path:
        """A file that a node saved or previewed."""
        return self.folder / saved["type"] / saved["subfolder"] / saved["filename"]

    def view(self, saved: dict[str, str]) -> bytes:
        return self.file(saved).read_bytes()

    def _start(self, run: Run, outputs: list[str]) -> None:
        running = (0, run.prompt_id, run.prompt, {}, outputs)
        self.server.prompt_queue.running.append(running)
        self.progress.clear()
        try:
            for key in outputs:
                run.make(key)
        finally:
            self.server.prompt_queue.running.remove(running)
            others = {key: kept for key, kept in self._kept.items() if key not in run.kept}
            self._kept, self.executed = dict(list((others | run.kept).items())[-_KEPT:]), run.executed

    def progressed(self, done: float, total: float, preview: Any, node_id: str | None = None) -> None:
        self.progress.append((str(node_id), done, total))


def _see_through() -> dict[str, type]:
    """The nodes that stand in for those of ComfyUI-See-through."""
    spec = importlib.util.spec_from_file_location("see_through_stand_in", _SEE_THROUGH)
    assert spec is not None
    assert spec.loader is not None
    module = sys.modules[spec.name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.NODE_CLASS_MAPPINGS
