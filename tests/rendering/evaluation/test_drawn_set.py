"""The bundled illustrations: whole, small, of scenes that fit them, and drawn by the programs beside them."""

from __future__ import annotations

import json
import sys
from pathlib import Path

import numpy as np
import pytest
from physanimator.physics.document import check_document
from physanimator.rendering.artwork import flattened, load_artwork
from physanimator.rendering.pictures import load_image, load_mask

SET = Path(__file__).resolve().parents[3] / "workflows" / "drawn_set"
NAMES = sorted(path.name for path in SET.iterdir() if (path / "scene.json").exists())


def picture(name: str) -> np.ndarray:
    (path,) = [*(SET / name).glob("illustration.png"), *(SET / name).glob("illustration.jpg")]
    return load_image(path)


def test_there_are_illustrations_of_different_kinds_in_small_files() -> None:
    assert len(NAMES) >= 6
    assert sum(path.stat().st_size for name in NAMES for path in (SET / name).iterdir()) < 1_700_000


@pytest.mark.parametrize("name", NAMES)
def test_masks_and_scene_fit_the_picture(name: str) -> None:
    image = picture(name)
    height, width = image.shape[:2]
    scene = json.loads((SET / name / "scene.json").read_text(encoding="utf-8"))
    check_document(scene)
    assert (scene["width"], scene["height"]) == (width, height)
    parts = {body["name"]: f"mask_{body['name'].replace(' ', '_')}.png" for body in scene["bodies"]}
    assert sorted(parts.values()) == sorted(path.name for path in (SET / name).glob("mask_*.png"))
    held = {rig["body"] for rig in scene.get("rig_points", ())}
    for number, (part, file) in enumerate(parts.items()):
        mask = load_mask(SET / name / file, width=width, height=height)
        assert mask.shape == (height, width), part
        assert 0.005 < mask.mean() < 0.4
        assert number in held or scene["bodies"][number].get("attach", "none") != "none", f"{part} is held by nothing"


def test_the_layers_of_the_banner_give_its_picture() -> None:
    artwork = load_artwork(SET / "banner" / "illustration.psd")
    assert [layer.name for layer in artwork.layers] == ["sky", "tower", "banner"]
    difference = np.abs(flattened(artwork)[..., :3].astype(float) - picture("banner"))
    assert difference.max() <= 3


def test_the_programs_draw_the_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.syspath_prepend(str(SET / "drawing"))
    for name in ("make", "paint", "banner"):
        monkeypatch.delitem(sys.modules, name, raising=False)
    import make  # type: ignore[import-not-found]

    make.make("banner", tmp_path, layered=False)
    drawn = load_image(tmp_path / "banner" / "illustration.png").astype(float)
    assert np.abs(drawn - picture("banner")).mean() < 0.5
    assert (tmp_path / "banner" / "scene.json").read_bytes() == (SET / "banner" / "scene.json").read_bytes()
    for name in ("make", "paint", "banner"):
        monkeypatch.delitem(sys.modules, name, raising=False)
