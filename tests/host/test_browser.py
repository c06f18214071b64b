"""The published workflows in the host's own page, in Chromium."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from bar_graphs import core, moving_bar
from comfy_host import skip_without_its_nodes

ROOT = Path(__file__).resolve().parents[2]
NAMES = sorted(path.stem for path in (ROOT / "workflows" / "api").glob("*.json"))

# A loader of the host that names a file which is not here is marked by some frontends, and rightly so.
_GRAPH = """
() => app.graph.nodes.map((node) => ({
  id: node.id, type: node.type, title: node.title,
  broken: !LiteGraph.registered_node_types[node.type] || (!!node.has_errors && (node.type.startsWith('PhysAnimator_') ||
    !(node.widgets ?? []).some((widget) =>
      Array.isArray(widget.options?.values) && !widget.options.values.includes(widget.value)))),
  widgets: Object.fromEntries((node.widgets ?? []).map((widget) => [widget.name, widget.value])),
}))
"""
_ALERTS = "() => [...document.querySelectorAll('.p-toast-message, .p-dialog')].map((box) => box.innerText)"
_PROMPT = "async () => JSON.stringify((await app.graphToPrompt()).output)"
_FROM_TEMPLATES = """
async (name) => {
  const answer = await fetch(`/api/workflow_templates/PhysAnimator/${name}.json`);
  await app.loadGraphData(await answer.json(), true, true, name, {openSource: 'template'});
}
"""


def assert_opened_well(page: Any, name: str) -> None:
    api = json.loads((ROOT / "workflows" / "api" / f"{name}.json").read_text(encoding="utf-8"))
    nodes = {str(node["id"]): node for node in page.run(_GRAPH)}
    assert not [node["type"] for node in nodes.values() if node["broken"]]
    for key, described in api.items():
        shown = {"class_type": described["class_type"], "_meta": {"title": nodes[key]["title"]}}
        assert _title(shown) == _title(described)
        for input_name, value in described["inputs"].items() if _ours(described) else ():
            if not isinstance(value, list):
                assert nodes[key]["widgets"][input_name] == value, f"{nodes[key]['type']}.{input_name}"
    assert _spelt_alike(json.loads(page.run(_PROMPT))) == _spelt_alike(api)
    assert page.run(_ALERTS) == []
    assert page.problems == []


def _spelt_alike(prompt: dict[str, Any]) -> dict[str, Any]:
    """Ours as we give them. Of the host's own nodes only the links: newer hosts call some of them by other names, and
    give them more widgets, than 0.8.0."""
    return {
        key: {
            **node,
            "_meta": {"title": _title(node)},
            "inputs": {name: each for name, each in node["inputs"].items() if _ours(node) or isinstance(each, list)},
        }
        for key, node in prompt.items()
    }


def _title(node: dict[str, Any]) -> str:
    return str(node["_meta"]["title"]) if _ours(node) else ""


def _ours(node: dict[str, Any]) -> bool:
    return str(node["class_type"]).startswith("PhysAnimator_")


@pytest.fixture(params=NAMES)
def name(request: pytest.FixtureRequest, host: Any) -> str:
    """A workflow whose nodes this host has."""
    skip_without_its_nodes(host, json.loads((ROOT / "workflows" / "api" / f"{request.param}.json").read_text("utf-8")))
    return request.param


def test_a_workflow_file_opens(page: Any, name: str) -> None:
    page.load(json.loads((ROOT / "workflows" / f"{name}.json").read_text(encoding="utf-8")))
    assert_opened_well(page, name)


def test_a_template_opens(page: Any, name: str) -> None:
    page.run(_FROM_TEMPLATES, name)
    page.page.wait_for_timeout(500)
    assert_opened_well(page, name)


def test_every_node_can_be_added_by_hand(page: Any) -> None:
    page.run("() => app.graph.clear()")
    added = page.run("""() => Object.keys(LiteGraph.registered_node_types)
        .filter((type) => type.startsWith('PhysAnimator_'))
        .map((type) => { const node = LiteGraph.createNode(type); app.graph.add(node); return node.type; })""")
    schemas = json.loads((ROOT / "tests" / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))
    assert sorted(added) == sorted(schemas)
    assert page.problems == []


def test_a_dynamic_choice_survives_saving(page: Any) -> None:
    saved = page.run("""async () => {
        app.graph.clear();
        const node = LiteGraph.createNode('PhysAnimator_RigPoint');
        app.graph.add(node);
        const widget = (name) => node.widgets.find((one) => one.name === name);
        widget('region').value = 'polygon';
        widget('motion').value = 'wave';
        await new Promise((done) => setTimeout(done, 100));
        widget('motion.amplitude').value = 33;
        widget('body').value = 2;
        await app.loadGraphData(app.graph.serialize());
        const values = Object.fromEntries(app.graph.nodes[0].widgets.map((one) => [one.name, one.value]));
        return JSON.stringify(values);
    }""")
    values = json.loads(saved)
    assert (values["region"], values["motion"], values["motion.amplitude"], values["body"]) == (
        "polygon",
        "wave",
        33,
        2,
    )
    assert values["motion.period"] == 2
    assert page.problems == []


def test_another_preset_brings_its_own_values(page: Any) -> None:
    values = page.run("""async () => {
        app.graph.clear();
        const node = LiteGraph.createNode('PhysAnimator_Material');
        app.graph.add(node);
        const read = () => node.widgets.find((one) => one.name === 'preset.sway_frequency')?.value;
        const first = read();
        node.widgets.find((one) => one.name === 'preset').value = 'jelly';
        await new Promise((done) => setTimeout(done, 100));
        return [first, read()];
    }""")
    schemas = json.loads((ROOT / "tests" / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))
    options = schemas["PhysAnimator_Material"]["input"]["required"]["preset"][1]["options"]
    usual = {o["key"]: o["inputs"]["required"].get("sway_frequency", [0, {}])[1].get("default") for o in options}
    assert values == [usual["hair"], usual["jelly"]]


def test_advice_appears_as_a_toast(page: Any, host: Any) -> None:
    still = moving_bar(12) | {"seen": core("PreviewAny", source=["motion", 1])}
    still["scene"]["inputs"]["wind_strength"] = 0.0
    page.run("(prompt) => app.loadApiJson(prompt, 'advice')", still)
    page.page.wait_for_timeout(1000)
    page.run("() => app.queuePrompt(0)")
    # Frontends build toasts differently; what they say is the same.
    said = page.page.get_by_text("nothing moves at all in 12 frames")
    said.first.wait_for(timeout=60_000)
    assert said.first.is_visible()
    assert page.problems == []
    page.run("() => app.extensionManager.toast.removeAll?.()")


def test_what_several_runs_say_alike_is_one_toast(page: Any, host: Any) -> None:
    tell = """([title, sentence]) => app.api.dispatchEvent(
      new CustomEvent('physanimator.advice', { detail: { title, sentences: [sentence] } }))"""
    for title in ["Simulate", "Render", "Simulate"]:
        page.run(tell, [title, "it is said here in one toast for each node"])
        page.page.wait_for_timeout(400)
    toasts = page.page.locator(".p-toast-message, [data-toast-kind]")
    said = toasts.filter(has_text="it is said here in one toast for each node")
    assert said.count() == 2
    page.reload()
    page.run(tell, ["Simulate", "it is said here in one toast for each node"])
    page.page.wait_for_timeout(400)
    assert said.count() == 1, "it is said again once it has gone"
    page.reload()
