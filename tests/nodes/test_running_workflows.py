"""Every published workflow, run whole in the stand-in: few frames, and without what needs model files."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from standin import published

ROOT = Path(__file__).resolve().parents[2]
API: dict[str, Any] = {
    path.stem: json.loads(path.read_text(encoding="utf-8")) for path in (ROOT / "workflows" / "api").glob("*.json")
}
NAMES = sorted(set(API) - {"frame_interpolation"})  # it needs nodes that the oldest host has not
FRAMES = 5
GUESSED = ("quickstart",)
"""Where what is behind the moving parts is painted; elsewhere the example's own plate saves time."""
LENGTHS = {
    "seamless_loop": 36,
    "anisora_inbetweens": 13,
    "ltx_lines": 13,
    "ltx_tracks": 7,
    "wan_loop": 1,
    "differential_diffusion": 13,
    "inpaint_plate": 1,
    "wan_first_last_frame": 1,
    "wan_lines": 13,
    "wan_time_to_move": 13,
    "wan_time_to_move_core": 13,
    "wan_tracks": 7,
    "wan_vace": 13,
}
SIZES = {
    "anisora_inbetweens": (480, 832),
    "ltx_lines": (512, 960),
    "ltx_tracks": (342, 640),
    "wan_loop": (480, 832),
    "differential_diffusion": (352, 640),
    "wan_first_last_frame": (480, 832),
    "wan_lines": (480, 832),
    "wan_time_to_move": (464, 832),
    "wan_time_to_move_core": (464, 832),
    "wan_tracks": (370, 640),
    "wan_vace": (480, 832),
}


PATHS = ("ltx_tracks", "wan_tracks")
WITH_GREY = ("anisora_inbetweens",)
"""Where a model is given a clip that is grey between its keyframes."""


def frames_of(path: Path) -> np.ndarray:
    import av

    with av.open(str(path)) as container:
        return np.stack([frame.to_ndarray(format="rgb24") for frame in container.decode(video=0)]).astype(np.int16)


@pytest.mark.parametrize("name", NAMES)
def test_a_workflow_runs_whole_and_writes_its_video(standin: Any, name: str) -> None:
    frames = 13 if name in SIZES else FRAMES
    prompt = published.shortened(API[name], frames, plate=name not in GUESSED)
    outputs = standin.run(prompt)
    (save,) = [key for key, node in prompt.items() if node["class_type"] == "SaveVideo"]
    (saved,) = outputs[save]["images"]
    video = frames_of(standin.file(saved))
    assert video.shape == (LENGTHS.get(name, FRAMES), *SIZES.get(name, (720, 1280)), 3)
    if len(video) > 1 and name not in PATHS:  # which shows paths, that reach far only in a long clip
        changed = (np.abs(video[len(video) // 2 :] - video[0]) > 8).any(axis=-1).mean(axis=(1, 2)).max()
        most = 1.0 if name in WITH_GREY else 0.25
        assert 2e-5 < changed <= most, "something moves, and the picture as a whole stays"
    shown = [each for told in outputs.values() for each in told.get("images", [])]
    assert all(standin.file(each).stat().st_size > 0 for each in shown)


def test_what_is_described_is_what_was_exported(standin: Any) -> None:
    """Nobody has changed a node or a description and left the workflow's files behind."""
    for name, describe in published.DESCRIBED.items():
        described = published.prompt_of(describe(), standin.known)
        both = (_unnamed(prompt, standin.known) for prompt in (described, API[name]))
        assert next(both) == next(both), f"run tests/host/export_workflows.py {name}"


def _unnamed(prompt: dict[str, Any], known: dict[str, type]) -> list[Any]:
    """The nodes of a prompt, whatever they are called, in one order; in place of a link what it comes from.

    Optional inputs that are as they begin are left out: a file that was exported before they were there runs the same.
    """
    found = []
    for node in prompt.values():
        inputs = published.without_beginnings(known[node["class_type"]], node["inputs"])
        told = {
            name: (prompt[value[0]]["class_type"], value[1]) if isinstance(value, list) else _plain(value)
            for name, value in sorted(inputs.items())
        }
        found.append((node["class_type"], told))
    return sorted(found, key=str)


def _plain(value: Any) -> Any:
    """The host's page writes 1 for 1.0."""
    return float(value) if isinstance(value, int) and not isinstance(value, bool) else value
