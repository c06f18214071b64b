"""A real ComfyUI server with this checkout among its custom nodes.

The ComfyUI checkout is not touched: folders, database and custom nodes live in a temporary directory.
"""

from __future__ import annotations

import json
import os
import shlex
import signal
import socket
import subprocess
import time
import urllib.error
import urllib.parse
import urllib.request
import uuid
from pathlib import Path
from typing import Any

__all__ = ["PACK", "ROOT", "Host", "skip_without_its_nodes"]

ROOT = Path(__file__).resolve().parents[2]
PACK = "PhysAnimator"
STAND_INS = [Path(__file__).with_name(f"{name}_stand_in") for name in ("see_through", "wan_wrapper")]
"""Packs with the nodes of ComfyUI-See-through and ComfyUI-WanVideoWrapper, without their models."""
BROKEN_PACKS = {
    "fails_to_load": {"__init__.py": "raise RuntimeError('this pack cannot be loaded')\n"},
    "fails_when_asked": {
        "__init__.py": (
            "class Broken:\n"
            "    FUNCTION, RETURN_TYPES, CATEGORY = 'run', (), 'broken'\n"
            "    @classmethod\n"
            "    def INPUT_TYPES(cls): raise RuntimeError('this node cannot say what it takes')\n"
            "NODE_CLASS_MAPPINGS = {'Broken': Broken}\n"
            "WEB_DIRECTORY = './js'\n"
        ),
        "js/broken.js": "throw new Error('this page file cannot be run')\n",
    },
}
"""Packs that stand beside ours in every test: what fails in them must not fail here."""
_START_SECONDS = 180
_RUN_SECONDS = 900


class Host:
    """A running server and what can be asked of it.

    Attributes:
        url: of the server, without a trailing slash.
        folder: the temporary base directory.
        client: identity under which prompts are posted.
    """

    def __init__(self, checkout: Path, python: str, folder: Path) -> None:
        self.checkout, self.python, self.folder = checkout, python, folder
        self.client = uuid.uuid4().hex
        with socket.socket() as probe:
            probe.bind(("127.0.0.1", 0))
            self.port = probe.getsockname()[1]
        self.url = f"http://127.0.0.1:{self.port}"
        (folder / "custom_nodes").mkdir()
        (folder / "custom_nodes" / PACK).symlink_to(ROOT, target_is_directory=True)
        for stand_in in STAND_INS:
            (folder / "custom_nodes" / stand_in.name).symlink_to(stand_in, target_is_directory=True)
        for pack in filter(None, os.environ.get("COMFYUI_PACKS", "").split(os.pathsep)):
            (folder / "custom_nodes" / Path(pack).name).symlink_to(Path(pack).resolve(), target_is_directory=True)
        for pack, files in BROKEN_PACKS.items():
            for name, text in files.items():
                (folder / "custom_nodes" / pack / name).parent.mkdir(parents=True, exist_ok=True)
                (folder / "custom_nodes" / pack / name).write_text(text, encoding="utf-8")
        self.start()

    def start(self) -> None:
        """Start the server, at the same address as before if it has been stopped."""
        self._log = (self.folder / "server.log").open("ab")
        self._process = subprocess.Popen(
            [self.python, "main.py", "--cpu", "--port", str(self.port), "--disable-auto-launch", "--disable-api-nodes",
             "--base-directory", str(self.folder), "--database-url", f"sqlite:///{self.folder / 'comfyui.db'}",
             *shlex.split(os.environ.get("COMFYUI_ARGUMENTS", ""))],
            cwd=self.checkout, stdout=self._log, stderr=subprocess.STDOUT, start_new_session=True,
        )  # fmt: skip

    @property
    def log(self) -> str:
        """Everything the server has printed."""
        return (self.folder / "server.log").read_text(errors="replace")

    @property
    def stopped(self) -> bool:
        return self._process.poll() is not None

    def wait_until_ready(self) -> None:
        end = time.monotonic() + _START_SECONDS
        while time.monotonic() < end:
            if self._process.poll() is not None:
                raise RuntimeError(f"ComfyUI stopped while starting:\n{self.log[-4000:]}")
            try:
                self.get("/system_stats")
            except OSError:
                time.sleep(0.3)
            else:
                return
        raise RuntimeError(f"ComfyUI did not answer within {_START_SECONDS} s:\n{self.log[-4000:]}")

    def stop(self) -> None:
        self._process.send_signal(signal.SIGTERM)
        try:
            self._process.wait(15)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        self._log.close()

    def read(self, path: str) -> bytes:
        with urllib.request.urlopen(self.url + path, timeout=60) as answer:
            return answer.read()

    def get(self, path: str) -> Any:
        return json.loads(self.read(path))

    def post(self, path: str, data: dict[str, Any]) -> tuple[int, Any]:
        """Status and decoded body of the answer."""
        request = urllib.request.Request(
            self.url + path, json.dumps(data).encode(), {"Content-Type": "application/json"}
        )
        try:
            with urllib.request.urlopen(request, timeout=60) as answer:
                status, body = answer.status, answer.read()
        except urllib.error.HTTPError as error:
            with error:
                status, body = error.code, error.read()
        return status, json.loads(body) if body else None

    def queue(self, prompt: dict[str, Any]) -> str:
        """Post a prompt that must be accepted; its id."""
        status, answer = self.post("/prompt", {"prompt": prompt, "client_id": self.client})
        assert status == 200, answer
        return answer["prompt_id"]

    def wait(self, prompt_id: str) -> dict[str, Any]:
        """The history entry of a prompt, once it has ended one way or another."""
        end = time.monotonic() + _RUN_SECONDS
        while time.monotonic() < end:
            history = self.get(f"/history/{prompt_id}")
            if prompt_id in history:
                return history[prompt_id]
            time.sleep(0.1)
        raise AssertionError(f"prompt {prompt_id} did not end within {_RUN_SECONDS} s:\n{self.log[-4000:]}")

    def run(self, prompt: dict[str, Any]) -> dict[str, Any]:
        """Outputs of a prompt that must succeed, by node id."""
        entry = self.wait(self.queue(prompt))
        assert entry["status"]["status_str"] == "success", _raised(entry)
        return entry["outputs"]

    def error_of(self, prompt: dict[str, Any]) -> str:
        """What a prompt that must fail says: refused at once, or in the node that raised."""
        status, answer = self.post("/prompt", {"prompt": prompt, "client_id": self.client})
        if status != 200 or answer["node_errors"]:  # with 200 what does not need the refused node runs
            return json.dumps(answer)
        entry = self.wait(answer["prompt_id"])
        assert entry["status"]["status_str"] == "error", entry["status"]
        return _raised(entry)

    def view(self, saved: dict[str, str]) -> bytes:
        """A file that a node saved or previewed."""
        return self.read(f"/view?{urllib.parse.urlencode(saved)}")


def skip_without_its_nodes(host: Host, prompt: dict[str, Any]) -> None:
    """Skip the test where a host lacks a node of a prompt, as an older one or one without another pack does."""
    import pytest

    missing = {node["class_type"] for node in prompt.values()} - set(host.get("/object_info"))
    if missing:
        pytest.skip(f"this host has no {', '.join(sorted(missing))}")


def _raised(entry: dict[str, Any]) -> str:
    """What the failed node of a history entry said."""
    return next(data["exception_message"] for name, data in entry["status"]["messages"] if name == "execution_error")
