"""Loops in nodes: in-betweens that lead back to the first keyframe."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from bar_graphs import drawn_bar, ours
from PIL import Image

FRAMES = 6


def shown(standin: Any, **interpolating: Any) -> tuple[np.ndarray, np.ndarray]:
    """What Render gives, and what Interpolate makes of it."""
    prompt = drawn_bar(FRAMES)
    loop = interpolating.pop("simulated", None)
    if loop is not None:
        prompt["motion"]["inputs"]["loop"] = loop
    prompt["between"] = ours(
        "Interpolate", images=["render", 0], images_are="all frames", backend="blend", **interpolating
    )
    prompt["filled"] = {**prompt["seen"], "inputs": prompt["seen"]["inputs"] | {"images": ["between", 0]}}
    outputs = standin.run(prompt)
    both = [
        np.stack([np.asarray(Image.open(standin.file(saved))).astype(int) for saved in outputs[key]["images"]])
        for key in ("seen", "filled")
    ]
    return both[0], both[1]


def test_a_clip_that_is_said_to_loop_closes(standin: Any) -> None:
    drawn, filled = shown(standin, every=3, loop="yes")
    assert filled.shape == drawn.shape
    for keyframe in (0, 3):
        np.testing.assert_array_equal(filled[keyframe], drawn[keyframe])
    np.testing.assert_allclose(filled[4], (2 * drawn[3] + drawn[0]) / 3, atol=1)
    np.testing.assert_allclose(filled[5], (drawn[3] + 2 * drawn[0]) / 3, atol=1)


@pytest.mark.parametrize("chosen", [{}, {"loop": "as the motion"}, {"loop": "no"}])
def test_without_a_motion_nothing_closes_by_itself(standin: Any, chosen: dict[str, str]) -> None:
    drawn, filled = shown(standin, every=3, **chosen)
    np.testing.assert_array_equal(filled[[0, 3, 5]], drawn[[0, 3, 5]])


@pytest.mark.parametrize(("chosen", "closes"), [({}, True), ({"loop": "no"}, False)])
def test_a_simulated_loop_closes_by_itself(standin: Any, chosen: dict[str, str], closes: bool) -> None:
    drawn, filled = shown(standin, every=4, motion=["motion", 0], simulated=0.5, **chosen)
    last = len(drawn) - 1
    assert len(filled) == len(drawn) == 6
    faded = np.abs(filled[last] - (drawn[4] + drawn[0]) / 2).max() <= 1
    assert faded == closes
    assert np.array_equal(filled[last], drawn[last]) != closes


def test_keyframes_alone_make_a_loop_of_as_many_gaps(standin: Any) -> None:
    prompt = drawn_bar(3)
    prompt["between"] = ours(
        "Interpolate", images=["render", 0], images_are="keyframes", every=4, backend="blend", loop="yes"
    )
    prompt["seen"]["inputs"]["images"] = ["between", 0]
    assert len(standin.run(prompt)["seen"]["images"]) == 12
    prompt["between"]["inputs"]["keyframes_at"] = "1,2,7"
    assert len(standin.run(prompt)["seen"]["images"]) == 11


def test_one_keyframe_is_no_loop(standin: Any) -> None:
    drawn, filled = shown(standin, every=9, keyframes_at="2", loop="yes")
    np.testing.assert_array_equal(filled, drawn)
