"""Nodes are found in the host's own search by words that are not in their names, in hosts and pages of any age."""

from __future__ import annotations

from typing import Any

import pytest

_SHOWN = """
(name) => [...document.querySelectorAll('[role="option"], [data-testid="node-search-result"], .p-autocomplete-option')]
  .some((one) => one.innerText.includes(name))
"""


@pytest.mark.parametrize(
    ("word", "name"),
    [
        ("wiggle", "Animate Illustration"),
        ("live2d", "Rig Point"),
        ("soft body", "Body"),
        ("cut out", "Segment by Points"),
    ],
)
def test_a_word_of_the_field_shows_the_node(page: Any, word: str, name: str) -> None:
    page.reload()  # frontend 1.35.9 opens its search every other time
    page.problems.clear()
    page.run("() => { app.graph.clear(); }")
    page.page.mouse.click(1200, 600, click_count=2, delay=20)
    page.page.wait_for_timeout(1000)
    page.page.keyboard.type(word)
    page.page.wait_for_function(_SHOWN, arg=name, timeout=15_000)
    page.page.keyboard.press("Escape")
    page.page.wait_for_timeout(500)
    # The list of frontend 1.35.9 cannot be closed without an error of its own.
    assert [one for one in page.problems if "physanimator" in one.lower()] == []


def test_every_node_brings_its_words(host: Any) -> None:
    told = {name: node for name, node in host.get("/object_info").items() if name.startswith("PhysAnimator_")}
    assert len(told) > 30
    assert [name for name, node in told.items() if len(node.get("search_aliases", ())) < 3] == []
