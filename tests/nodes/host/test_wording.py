"""What the person at the browser is told: parts by their names, files by their place in the host's folders."""

from __future__ import annotations

import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from physanimator.nodes.host.wording import in_users_words, parts_named, placed_errors, with_known_places
from physanimator.physics.errors import InvalidInputError, MeshingError, SceneError


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    from standin import StandIn, installed

    with installed():
        yield StandIn(tmp_path_factory.mktemp("wording")).folder


@pytest.mark.parametrize(
    ("below", "said"),
    [
        ("input/girl.psd", "input/girl.psd"),
        ("input/sub folder/girl.psd", "input/sub folder/girl.psd"),
        ("output/a.png", "output/a.png"),
        ("models/checkpoints/x.safetensors", "models/checkpoints/x.safetensors"),
        ("models/loras/x.safetensors", "models/loras/x.safetensors"),
        ("custom_nodes/pack/a.json", "ComfyUI/custom_nodes/pack/a.json"),
        ("input", "input"),
        ("inputs/girl.psd", "ComfyUI/inputs/girl.psd"),
    ],
)
def test_a_path_begins_with_the_host_s_folder(folder: Path, below: str, said: str) -> None:
    text = f"artwork must be a readable file. Got: {folder / below}, which is none"
    assert with_known_places(text) == f"artwork must be a readable file. Got: {said}, which is none"
    quoted = f"Got: {str(folder / below)!r}"
    assert with_known_places(quoted) == f"Got: '{said}'"


def test_other_paths_stay_as_they_are(folder: Path) -> None:
    for path in ("/elsewhere/input/girl.psd", f"/elsewhere{folder}/input/girl.psd", f"{folder}2/input/girl.psd"):
        assert with_known_places(f"Got: {path}") == f"Got: {path}"


def test_a_path_behind_a_link_is_known_too(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    import folder_paths

    link = folder.parent / "link"
    os.symlink(folder, link)
    monkeypatch.setattr(folder_paths, "base_path", str(link))
    assert with_known_places(f"{folder / 'input' / 'a.png'}") == "input/a.png"


@pytest.mark.parametrize("kind", [InvalidInputError, MeshingError, lambda text: SceneError("", text)])
def test_errors_keep_their_kind(folder: Path, kind: Any) -> None:
    with pytest.raises(type(kind("")), match=r"^Got: input/a\.png$"), placed_errors():
        raise kind(f"Got: {folder / 'input' / 'a.png'}")


@pytest.mark.parametrize(
    ("said", "heard"),
    [
        ("masks[0]: the mask is too small", "Part 1: the mask is too small"),
        ("masks[1] must have white", "Part 4 must have white"),
        ("bodies[1] (part 4) has one part", "Part 4 has one part"),
        ("masks[2]: there is none", "masks[2]: there is none"),
        ("masks must leave some background", "the parts must leave some background"),
        ("points must be a list", "points must be a list"),
    ],
)
def test_parts_have_the_names_that_the_editor_shows(said: str, heard: str) -> None:
    with pytest.raises(InvalidInputError) as caught, parts_named(["Part 1", "Part 4"]):
        raise InvalidInputError(said)
    assert str(caught.value) == heard


def test_bodies_are_counted_as_nodes_count_them() -> None:
    assert in_users_words("bodies[2] (hair) covers 93 %") == "Body 2 (hair) covers 93 %"
    assert in_users_words("rig_points[0] touches no body: nothing") == "Rig point 0 touches no body: nothing"
    assert in_users_words("strokes[0].speed must be above 0") == "strokes[0].speed must be above 0"
