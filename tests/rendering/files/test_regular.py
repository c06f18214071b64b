"""Inputs that would be waited for are refused; what was handed over open is read."""

from __future__ import annotations

import os
import socket
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from physanimator.physics.errors import InvalidInputError
from physanimator.rendering.command import main
from physanimator.rendering.files import check_regular
from physanimator.rendering.metrics.learned.videoscore import PROMPT_FILE, _question
from physanimator.rendering.networks.checkpoints import read_checkpoint
from physanimator.rendering.pictures import load_image, load_mask
from physanimator.rendering.pictures.clip_reading import read_clip
from physanimator.rendering.segmentation.sam.weights import model_type_of

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
ROOT = Path(__file__).resolve().parents[3]


def _prompt_of(path: Path) -> str:
    path.rename(path.with_name(PROMPT_FILE))
    return _question(path.parent)


def _config_of(path: Path) -> str:
    path.rename(path.with_name("config.json"))
    return model_type_of(path.parent)


READERS: dict[str, Callable[[Path], Any]] = {
    "picture": load_image,
    "mask": lambda path: load_mask(path, width=8, height=8),
    "clip": lambda path: next(read_clip(path)),
    "picture of a clip": lambda path: next(read_clip(path.parent)),
    "checkpoint": lambda path: read_checkpoint(path, wanted="weights"),
    "config of a model": _config_of,
    "prompt of a model": _prompt_of,
}


@pytest.fixture
def writable(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where a pipe would be opened nonetheless, the test fails instead of waiting for ever."""
    really = os.mkfifo

    def opened_from_behind(path: Path) -> None:
        really(path)
        writer = subprocess.Popen([sys.executable, "-c", f"open({str(path)!r}, 'wb').close()"])
        writers.append(writer)

    writers: list[subprocess.Popen[bytes]] = []
    monkeypatch.setattr(os, "mkfifo", opened_from_behind)
    yield
    for writer in writers:
        writer.kill()
        writer.wait()


@pytest.mark.usefixtures("writable")
@pytest.mark.parametrize("reader", READERS)
def test_a_named_pipe_is_refused(tmp_path: Path, reader: str) -> None:
    os.mkfifo(tmp_path / "input.png")
    with pytest.raises(InvalidInputError, match=r"named pipe|is no file|no readable config"):
        READERS[reader](tmp_path / "input.png")


def test_devices_and_sockets_are_refused_and_other_things_left(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(InvalidInputError, match=r"plate must be a file. Got: /dev/zero, which is a device"):
        check_regular("/dev/zero", "plate")
    with socket.socket(socket.AF_UNIX) as server:
        server.bind("input")
    with pytest.raises(InvalidInputError, match="Got: input, which is a socket"):
        check_regular("input", "scene")
    for other in (".", "nothing", "a\0b", __file__):
        check_regular(other, "scene")


@pytest.mark.usefixtures("writable")
@pytest.mark.parametrize("option", ["IMAGE", "--mask", "--points", "--scene", "--plate", "--collider"])
def test_every_input_of_the_command(
    option: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    os.mkfifo("pipe")
    example = ROOT / "workflows" / "example"
    image, mask = str(example / "illustration.png"), str(example / "mask_cape.png")
    arguments = ["animate", "pipe" if option == "IMAGE" else image, "--mask", mask, "--output", "a.mp4"]
    with pytest.raises(SystemExit) as ended:
        raise SystemExit(main([*arguments, *([] if option == "IMAGE" else [option, "pipe"])]))
    assert ended.value.code == 2
    assert "must be a file. Got: pipe, which is a named pipe" in capsys.readouterr().err


def test_what_was_handed_over_open_is_read() -> None:
    reading, writing = os.pipe()
    try:
        check_regular(f"/dev/fd/{reading}", "scene")
    finally:
        os.close(reading)
        os.close(writing)
