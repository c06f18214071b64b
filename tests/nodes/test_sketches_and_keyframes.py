"""Line drawings of other packs, and keyframes, in nodes that run in the stand-in."""

from __future__ import annotations

import hashlib
import json
from typing import Any

import numpy as np
import pytest
from bar_graphs import core, drawn_bar, ours
from PIL import Image


def grey(standin: Any, outputs: dict[str, Any], key: str) -> np.ndarray:
    return np.stack(
        [np.asarray(Image.open(standin.file(each)).convert("L")).astype(float) / 255 for each in outputs[key]["images"]]
    )


def lines_of(standin: Any, sketch: Image.Image, **options: Any) -> tuple[np.ndarray, list[str]]:
    """The bar's sketch, bent along, of a drawing in a file."""
    name = f"lines_{hashlib.sha256(sketch.tobytes()).hexdigest()}.png"  # what has a name of its own is not cached
    sketch.save(standin.folder / "input" / name)
    prompt = drawn_bar() | {
        "drawing": core("LoadImage", image=name),
        "flow": ours("OpticalFlow", motion=["motion", 0]),
        "bent": ours("WarpSketch", sketch=["drawing", 0], flow=["flow", 0], mode="layered", blur_sigma=0.0, **options),
        "seen_lines": core("PreviewImage", images=["bent", 0]),
    }
    outputs = standin.run(prompt)
    return grey(standin, outputs, "seen_lines"), outputs.get("bent", {}).get("advice", [])


@pytest.fixture
def drawing() -> np.ndarray:
    paper = np.full((96, 160), 255, np.uint8)
    paper[::12] = 0
    return paper


def test_light_lines_give_the_sketches_of_dark_ones(standin: Any, drawing: np.ndarray) -> None:
    dark, said = lines_of(standin, Image.fromarray(drawing))
    assert said == []
    light, said = lines_of(standin, Image.fromarray(255 - drawing))
    assert len(said) == 1
    assert "light lines on dark" in said[0]
    np.testing.assert_allclose(light, dark, atol=1 / 255)
    kept, said = lines_of(standin, Image.fromarray(255 - drawing), sketch_lines="dark on light")
    assert said == []
    assert np.abs(kept - dark).max() > 0.9
    np.testing.assert_allclose(lines_of(standin, Image.fromarray(255 - drawing), sketch_lines="light on dark")[0], dark)


def test_a_drawing_of_another_size_is_brought_to_the_illustration_s(standin: Any, drawing: np.ndarray) -> None:
    dark, _ = lines_of(standin, Image.fromarray(drawing))
    larger = Image.fromarray(drawing).resize((853, 512), Image.Resampling.NEAREST)
    found, _ = lines_of(standin, larger)
    assert found.shape == dark.shape
    assert np.abs(found - dark).mean() < 0.05
    with pytest.raises(Exception, match="of its proportions"):
        lines_of(standin, larger.resize((512, 512)))


def test_keyframes_stand_in_their_places(standin: Any) -> None:
    prompt = drawn_bar(9)
    given = {name: prompt["render"]["inputs"][name] for name in ("image", "motion")}
    form = {"frames": 17, "width": 160, "height": 96, "fit": "crop"}
    prompt |= {
        "keys": ours("Keyframes", **given, **form, keyframes="-1, 0, 8"),
        "told": core("PreviewAny", source=["keys", 1]),
        "pictures": core("PreviewImage", images=["keys", 0]),
        "clip": core("PreviewImage", images=["keys", 2]),
    }
    outputs = standin.run(prompt)
    assert outputs["told"]["text"] == ["0, 8, 16"]
    pictures, clip = grey(standin, outputs, "pictures"), grey(standin, outputs, "clip")
    assert (len(pictures), len(clip)) == (3, 17)
    np.testing.assert_array_equal(clip[[0, 8, 16]], pictures)
    assert np.abs(np.delete(clip, [0, 8, 16], axis=0) - 0.5).max() < 0.01
    assert np.abs(pictures[2] - pictures[0]).max() > 0.2
    with pytest.raises(Exception, match="keyframes must be frames of the clip, -17 to 16"):
        standin.run(prompt | {"keys": ours("Keyframes", **given, **form, keyframes="0, 40")})


def test_tracks_are_lists_of_points_of_one_length(standin: Any) -> None:
    """The form of LTXVDrawTracks, which makes as many frames as the longest list has points, and hides shorter ones."""
    prompt = drawn_bar(9)
    values = {
        "points": 5,
        "static_points": 0,
        "frames": 17,
        "width": 320,
        "height": 192,
        "fit": "crop",
        "weighting": 0.5,
    }
    prompt |= {
        "tracks": ours("Tracks", motion=["motion", 0], **values),
        "told": core("PreviewAny", source=["tracks", 1]),
    }
    (text,) = standin.run(prompt)["told"]["text"]
    tracks = json.loads(text)
    assert [len(track) for track in tracks] == [17] * 5
    assert all(set(point) >= {"x", "y"} for track in tracks for point in track)
