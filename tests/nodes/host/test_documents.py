"""One spelling for a scene document, and none for what is no document."""

from __future__ import annotations

import json

import pytest
from physanimator.nodes.host.documents import canonical_text

SCENE = '{"version":2,"width":160,"height":96,"strokes":[{"kind":"wind","path":[[0,40],[150,40.5]],"radius":60}]}'


@pytest.mark.parametrize(
    "text",
    [
        json.dumps(json.loads(SCENE), indent=4),
        json.dumps(dict(reversed(json.loads(SCENE).items()))),
        SCENE.replace("160", "160.0").replace("60}", "6e1}"),
        "\ufeff\n" + SCENE + "\n",
        SCENE.replace("wind", "w\\u0069nd"),
    ],
)
def test_spellings_of_one_scene_are_one_text(text: str) -> None:
    assert text != SCENE
    assert canonical_text(text) == canonical_text(SCENE)
    assert json.loads(canonical_text(text)) == json.loads(SCENE)


@pytest.mark.parametrize("change", [("40.5", "40.6"), ("wind", "repel"), ("[0,40],[150,40.5]", "[150,40.5],[0,40]")])
def test_another_scene_is_another_text(change: tuple[str, str]) -> None:
    assert canonical_text(SCENE.replace(*change)) != canonical_text(SCENE)


@pytest.mark.parametrize("text", ["", "{", '{"a": 1, "a": 2}', "[" * 5000 + "]" * 5000, '{"a": 1' + "0" * 6000 + "}"])
def test_what_cannot_be_read_stays_as_it_is(text: str) -> None:
    assert canonical_text(text) == text
