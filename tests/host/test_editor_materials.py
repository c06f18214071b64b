"""Materials in the scene editor: chosen on the picture, changed in the panel, and seen to move otherwise."""

from __future__ import annotations

import json
from typing import Any

import pytest
from editor_page import EditorPage

WIND = {"kind": "wind", "path": [[300, 420], [1000, 420]], "radius": 400, "speed": 900, "strength": 4}
HAIR = (676, 310)
PIN = {
    "position": [790, 130],
    "region": {"type": "polygon", "points": [[490, 100], [970, 100], [970, 240], [490, 240]]},
}


@pytest.fixture(params=["litegraph", "vue"])
def editor(page: Any, request: pytest.FixtureRequest) -> EditorPage:
    page.problems.clear()
    page.page.set_default_timeout(10_000)
    opened = EditorPage.opened(page, request.param)
    opened.run_node()
    document = {"version": 2, "width": 1280, "height": 720, "strokes": [WIND], "rig_points": [PIN]}
    text = json.dumps(json.dumps(document))
    opened.ask(f"(node.widgets.find((one) => one.name === 'scene').value = {text}, true)")
    opened.wait("editor.live.measured.largest > 1")
    return opened


def choose(editor: EditorPage, field: str, value: str) -> None:
    editor.selector(f'[data-field="{field}"] select').select_option(value)


def moved(editor: EditorPage) -> float:
    """How far anything goes in the preview of what is in the document now [px]."""
    editor.page.page.wait_for_timeout(100)
    editor.wait("editor.live.measured.largest > 0")
    return float(editor.ask("editor.live.measured.largest"))


def test_stiffness_is_given_by_sway_by_young_or_by_lame_parameters(editor: EditorPage) -> None:
    before = moved(editor)
    assert editor.selector('[data-field="sway_frequency"] input[type="number"]').input_value() == "0.7"
    choose(editor, "stiffness", "Lame")
    (body,) = editor.value()["bodies"]
    assert body["material"].keys() == {"preset", "mu", "lambda"}
    assert body["material"]["lambda"] / body["material"]["mu"] == pytest.approx(1.5, rel=1e-5)
    assert moved(editor) == pytest.approx(before, rel=0.25)  # narrow joints apart, it is as stiff as its sway made it
    editor.type_into("mu", str(100 * body["material"]["mu"]))
    editor.type_into("lambda", "0")
    material = editor.value()["bodies"][0]["material"]
    assert (material["mu"], material["lambda"]) == (pytest.approx(100 * body["material"]["mu"]), 0)
    assert moved(editor) < before / 3
    choose(editor, "stiffness", "Young")
    material = editor.queued()["bodies"][0]["material"]
    assert material["youngs_modulus"] == pytest.approx(200 * body["material"]["mu"], rel=1e-5)
    assert material["poisson_ratio"] == 0
    assert material["sway_frequency"] is None
    choose(editor, "preset", "jelly")
    assert editor.value()["bodies"] == [{"material": {"preset": "jelly"}}]
    editor.focus()
    editor.keys("Control+z")
    assert editor.value()["bodies"][0]["material"] == material
    assert editor.page.problems == []


def test_a_click_on_a_body_shows_its_material_first(editor: EditorPage) -> None:
    editor.press("select")
    editor.ask("(editor.commands.seek(0), true)")
    first = "editor.inspector.root.querySelector('.physanimator-heading').textContent"
    assert editor.ask(first) == "Scene"
    editor.click(*HAIR)
    assert editor.ask(first) == "Material"
    assert editor.ask("editor.inspector.body.number") == 0
    editor.type_into("damping", "7")
    assert editor.value()["bodies"] == [{"material": {"preset": "hair", "damping": 7}}]
    editor.type_into("stretch_limit", "")
    assert editor.value()["bodies"][0]["material"]["stretch_limit"] is None
    editor.click(20, 700)
    assert editor.ask(first) == "Scene"


def test_the_scene_integrates_as_the_paper_writes(editor: EditorPage) -> None:
    editor.type_into("time_step", "0.001")
    choose(editor, "strokes_as", "force")
    assert (editor.value()["time_step"], editor.value()["strokes_as"]) == (0.001, "force")
    editor.page.page.get_by_text("time_step must be at most").first.wait_for()
