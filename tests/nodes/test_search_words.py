"""People find the nodes by words of their own."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from physanimator.nodes.search_words import SEARCH_WORDS, findable

SOUGHT = (
    "physics", "cloth", "hair", "jelly", "puppet", "soft body", "live2d", "wiggle", "sway", "cut out", "wind",
    "gravity", "animate", "psd", "pin", "collision", "rig", "skirt", "breeze", "mp4", "髪", "頭髮", "头发", "머리카락",
    "animate picture", "animate image",
)  # fmt: skip
"""What somebody types who does not know the names."""


@pytest.fixture(scope="module")
def schemas(standin: Any) -> list[Any]:
    return [node.GET_SCHEMA() for name, node in standin.known.items() if name.startswith("PhysAnimator_")]


def test_every_node_has_words(schemas: list[Any]) -> None:
    assert set(SEARCH_WORDS) == {schema.node_id for schema in schemas}
    for node_id, words in SEARCH_WORDS.items():
        assert len(words) >= 3, node_id


@pytest.mark.parametrize("word", SOUGHT)
def test_a_word_of_the_field_finds_a_node(schemas: list[Any], word: str) -> None:
    told = ["\n".join((one.display_name, one.description, *SEARCH_WORDS[one.node_id])).lower() for one in schemas]
    assert [each for each in told if word in each]


def test_names_that_other_packs_have_too_say_whose_they_are(schemas: list[Any]) -> None:
    common = ("Mask to Mesh", "Material", "Body", "Scene", "Render", "Simulate", "Wind", "Contact", "Load Layers")
    names = {schema.display_name for schema in schemas}
    assert not names & set(common)
    assert {f"{name} (PhysAnimator)" for name in common} <= names


class _Node:
    @classmethod
    def define_schema(cls) -> Any:
        return SimpleNamespace(node_id="PhysAnimator_Wind", search_aliases=[])

    @classmethod
    def GET_NODE_INFO_V1(cls) -> dict[str, Any]:
        return {"name": "PhysAnimator_Wind", **vars(cls.define_schema())}


class _NodeOfAnOlderHost:
    @classmethod
    def define_schema(cls) -> Any:
        return SimpleNamespace(node_id="PhysAnimator_Wind")

    GET_NODE_INFO_V1 = _Node.__dict__["GET_NODE_INFO_V1"]


def test_a_host_that_takes_words_gets_them_and_the_page_of_an_older_one_is_told() -> None:
    told = findable(findable(_Node)).define_schema().search_aliases
    assert set(told) == set(SEARCH_WORDS["PhysAnimator_Wind"])
    assert len(set(told)) == len(told)
    assert _Node.GET_NODE_INFO_V1()["search_aliases"] == told
    assert vars(findable(_NodeOfAnOlderHost).define_schema()) == {"node_id": "PhysAnimator_Wind"}
    assert _NodeOfAnOlderHost.GET_NODE_INFO_V1()["search_aliases"] == told
