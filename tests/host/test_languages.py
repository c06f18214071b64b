"""The pack in another language: what the host serves, and what its page shows."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
LANGUAGES = sorted(path.name for path in (ROOT / "locales").iterdir())

_SHOWN = """
async (type) => {
  const node = LiteGraph.createNode(type);
  app.graph.add(node);
  await new Promise((done) => setTimeout(done, 50));
  const shown = (widget) => widget.options?.getOptionLabel?.(widget.value);
  return {
    title: node.title,
    inputs: Object.fromEntries(node.inputs.map((slot) => [slot.name, slot.label ?? slot.localized_name ?? slot.name])),
    outputs: node.outputs.map((slot) => slot.label ?? slot.localized_name ?? slot.name),
    widgets: Object.fromEntries((node.widgets ?? []).map((widget) => [widget.name, {
      label: widget.label, tooltip: widget.tooltip, shown: shown(widget), value: widget.value,
    }])),
    category: node.constructor.category,
  };
}
"""
_OPENED = """
async (type) => {
  app.graph.clear();
  const node = LiteGraph.createNode(type);
  node.pos = [300, 300];
  app.graph.add(node);
  app.canvas.ds.scale = 1;
  app.canvas.ds.offset = [0, 0];
  app.canvas.selectNode(node);
  app.canvas.setDirty(true, true);
}
"""
_EDITOR = """
async () => {
  const node = LiteGraph.createNode('PhysAnimator_SceneEditor');
  app.graph.add(node);
  await new Promise((done) => setTimeout(done, 500));
  const { root } = node.physanimatorEditor;
  return {
    titles: [...root.querySelectorAll('button')].map((button) => button.title),
    captions: [...root.querySelectorAll('.physanimator-caption')].map((caption) => caption.textContent),
    options: [...root.querySelectorAll('option')].map((option) => [option.value, option.textContent]),
    text: root.innerText,
  };
}
"""

# Buttons and lists of a narrow picker that reach beyond it, or cut off their words.
_CUT = """
async () => {
  app.graph.clear();
  const node = LiteGraph.createNode('PhysAnimator_AnimateIllustration');
  app.graph.add(node);
  await new Promise((done) => setTimeout(done, 800));
  node.setSize([250, 800]);
  app.canvas.ds.scale = 1;
  app.canvas.setDirty(true, true);
  await new Promise((done) => setTimeout(done, 800));
  const { frame, root } = node.physanimatorEditor;
  const edge = frame.getBoundingClientRect();
  const seen = [...frame.querySelectorAll('button, select')].filter((one) => one.checkVisibility());
  const beyond = (one) => {
    const box = one.getBoundingClientRect();
    return box.left < edge.left - 1 || box.right > edge.right + 1 || one.scrollWidth > one.clientWidth + 1;
  };
  return [root.offsetWidth, seen.length, seen.filter(beyond).map((one) => one.outerHTML.slice(0, 120))];
}
"""


@pytest.fixture(scope="module", params=["ja", "zh-TW"])
def language(page: Any, request: Any) -> Iterator[str]:
    """The page in a language, and back in English afterwards."""
    _choose(page, request.param)
    yield request.param
    _choose(page, "en")


def _choose(page: Any, language: str) -> None:
    page.run("(language) => app.extensionManager.setting.set('Comfy.Locale', language)", language)
    page.page.wait_for_timeout(500)
    page.reload()
    page.run("() => app.graph.clear()")


def _node(language: str, name: str) -> Any:
    texts = json.loads((ROOT / "locales" / language / "nodeDefs.json").read_text(encoding="utf-8"))
    return texts[f"PhysAnimator_{name}"]


def _word(language: str, text: str) -> str:
    return json.loads((ROOT / "nodes" / "web" / "words" / f"{language}.json").read_text(encoding="utf-8"))[text]


@pytest.mark.parametrize("one", LANGUAGES)
def test_the_host_serves_our_texts(host: Any, one: str) -> None:
    served = host.get("/i18n")[one]
    ours = json.loads((ROOT / "locales" / one / "nodeDefs.json").read_text(encoding="utf-8"))
    assert {name: served["nodeDefs"][name] for name in ours} == ours
    assert served["nodeCategories"]["scene"]


def test_nodes_are_shown_in_the_language(page: Any, language: str) -> None:
    texts, shown = _node(language, "EnergyStroke"), page.run(_SHOWN, "PhysAnimator_EnergyStroke")
    assert shown["title"] == texts["display_name"]
    assert shown["inputs"]["strokes"] == texts["inputs"]["strokes"]["name"]
    assert shown["outputs"] == [texts["outputs"]["0"]["name"]]
    assert shown["widgets"]["radius"]["label"] == texts["inputs"]["radius"]["name"]
    assert shown["category"].split("/")[-1] == _word_of_menu(language)
    assert page.problems == []


def _word_of_menu(language: str) -> str:
    return json.loads((ROOT / "locales" / language / "main.json").read_text(encoding="utf-8"))["nodeCategories"][
        "scene"
    ]


def test_choices_keep_their_values_and_show_the_language(page: Any, language: str) -> None:
    kind = page.run(_SHOWN, "PhysAnimator_EnergyStroke")["widgets"]["kind"]
    assert (kind["value"], kind["shown"]) == ("wind", _word(language, "wind"))
    brought = page.run(_SHOWN, "PhysAnimator_Material")["widgets"]
    texts = _node(language, "Material")["inputs"]
    assert brought["preset"]["shown"] == _word(language, brought["preset"]["value"])
    assert brought["preset.damping"]["label"] == texts["preset_damping"]["name"]
    assert brought["preset.damping"]["tooltip"] in (None, texts["preset_damping"]["tooltip"])


def test_the_editor_speaks_the_language(page: Any, language: str) -> None:
    editor = page.run(_EDITOR)
    assert f"{_word(language, 'Undo')} (Ctrl+Z)" in editor["titles"]
    assert _word(language, "Gravity") in editor["captions"]
    assert ["vertex_force", _word(language, "vertex_force")] in editor["options"]
    assert _word(language, "Run this node") in editor["text"]
    assert page.problems == []


def test_a_narrow_picker_cuts_off_no_word(page: Any, language: str) -> None:
    across, seen, cut = page.run(_CUT)
    assert 200 < across < 260
    assert seen > 15
    assert cut == []


def test_help_is_shown_in_the_language(page: Any, language: str) -> None:
    page.problems.clear()
    text = (ROOT / "nodes" / "web" / "docs" / "PhysAnimator_Simulate" / f"{language}.md").read_text(encoding="utf-8")
    page.run(_OPENED, "PhysAnimator_Simulate")
    page.page.locator('[data-testid="info-button"]').first.click(timeout=10_000)
    page.page.get_by_text(text.split("\n\n")[1].replace("\n", " ")[:20]).first.wait_for(timeout=10_000)
    page.run("() => app.graph.clear()")  # help of what others put down is not asked for
    assert page.problems == []
