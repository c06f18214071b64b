"""The pack's workflows among the templates of the host's page."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
NAMES = sorted(path.stem for path in (ROOT / "workflows").glob("*.json"))

_LISTED = """
async () => {
  const { api } = await import('/scripts/api.js');
  const files = await api.getWorkflowTemplates();
  const groups = await api.getCoreWorkflowTemplates('en');
  return { files, groups: groups.filter((group) => group.moduleName !== 'default') };
}
"""
_KNOWN = "(types) => types.filter((type) => type in LiteGraph.registered_node_types)"
_FETCHED = """
async (name) => {
  const answer = await fetch(`/api/workflow_templates/PhysAnimator/${name}`);
  return [answer.status, answer.headers.get('content-type')];
}
"""
_CARDS = """
() => [...document.querySelectorAll('[data-testid^="template-workflow-"]')].map((card) => {
  const picture = card.querySelector('img');
  const shown = picture?.naturalWidth ? picture.src : '';
  return [card.dataset.testid.replace('template-workflow-', ''), card.innerText, shown];
})
"""


@pytest.fixture(scope="module")
def listed(page: Any) -> Any:
    return page.run(_LISTED)


def types_of(name: str) -> set[str]:
    ui = json.loads((ROOT / "workflows" / f"{name}.json").read_text(encoding="utf-8"))
    return {node["type"] for node in ui["nodes"]}


def test_they_are_one_group_with_the_quickstart_first(listed: Any) -> None:
    (group,) = [each for each in listed["groups"] if each["moduleName"] == "PhysAnimator"]
    assert "PhysAnimator" not in listed["files"]
    assert group["templates"][0]["name"] == "quickstart"
    assert all(each["title"] != each["name"] and len(each["description"]) > 30 for each in group["templates"])


def test_just_those_that_can_run_here_are_offered(page: Any, listed: Any) -> None:
    (group,) = [each for each in listed["groups"] if each["moduleName"] == "PhysAnimator"]
    offered = {each["name"] for each in group["templates"]}
    for name in NAMES:
        types = sorted(types_of(name))
        assert (name in offered) == (page.run(_KNOWN, types) == types), name


def test_thumbnails_and_graphs_are_served(page: Any) -> None:
    for name in NAMES:
        assert page.run(_FETCHED, f"{name}.webp")[0] == 200
        assert page.run(_FETCHED, f"{name}.jpg") == [200, "image/jpeg"]
        assert page.run(_FETCHED, f"{name}.json")[0] == 200


def test_a_search_for_the_packs_name_finds_them_all(page: Any, listed: Any) -> None:
    page.run("() => app.extensionManager.command.execute('Comfy.BrowseTemplates')")
    box = page.page.locator('.p-dialog input[type="text"], [role="dialog"] input').first
    box.wait_for(timeout=20_000)
    box.fill("physanimator")
    page.page.wait_for_timeout(2500)
    (group,) = [each for each in listed["groups"] if each["moduleName"] == "PhysAnimator"]
    found: dict[str, str] = {}
    pictures: set[str] = set()
    for _ in range(12):  # more come into sight as one scrolls
        cards = page.run(_CARDS)
        found |= {name: text for name, text, _ in cards}
        pictures |= {picture for _, _, picture in cards if picture}
        page.page.mouse.move(1100, 700)
        page.page.mouse.wheel(0, 1500)
        page.page.wait_for_timeout(300)
    problems = list(page.problems)
    page.reload()  # in some frontends Escape empties the search and leaves the dialog where it is
    assert set(found) >= {each["name"] for each in group["templates"]}
    titles = {each["name"]: each["title"] for each in group["templates"]}
    assert all(title in found[name] for name, title in titles.items())
    assert len(pictures) > 3
    assert problems == []
