"""Layers in the scene editor: the list of them, what moves, and the picture in layers under the pen."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from editor_page import CANVASES, EditorPage
from PIL import Image

_EXAMPLE = Path(__file__).resolve().parents[2] / "workflows" / "example" / "illustration.png"
_BUILD = """
async () => {
  app.graph.clear();
  app.nodeOutputs = {};
  const add = (type, x, y) => {
    const node = LiteGraph.createNode(type);
    node.pos = [x, y];
    app.graph.add(node);
    return node;
  };
  const load = add('PhysAnimator_LoadLayers', -1300, 0);
  const editor = add('PhysAnimator_SceneEditor', 0, 0);
  const slot = (slots, name) => slots.findIndex((one) => one.name === name);
  load.connect(slot(load.outputs, 'layers'), editor, slot(editor.inputs, 'layers'));
  return editor.id;
}
"""
NAMES = [
    "plant", "ribbon", "front hair", "face", "collar", "body", "skirt", "arms", "cape", "back hair", "background",
]  # fmt: skip
FACE = (400, 150, 500, 270)
HAIR = (640, 220, 800, 360)
ARMS = (320, 500, 372, 590)
MOVING = ["back hair", "cape", "skirt", "front hair", "ribbon", "plant"]


@pytest.fixture(scope="module", params=sorted(CANVASES))
def canvas(request: pytest.FixtureRequest) -> str:
    return request.param


@pytest.fixture
def editor(page: Any, canvas: str) -> EditorPage:
    page.problems.clear()
    page.page.set_default_timeout(10_000)
    EditorPage.choose_canvas(page, canvas)
    opened = EditorPage(page, page.run(_BUILD))
    opened.look()
    opened.run_node()
    opened.wait("editor.live.player.layered !== null")
    return opened


def film(editor: EditorPage) -> np.ndarray:
    """What WebGL shows, RGB."""
    editor.page.page.wait_for_timeout(400)
    box = editor.selector(".physanimator-stage").bounding_box()
    shot = editor.page.page.screenshot(clip=box)
    return np.asarray(Image.open(io.BytesIO(shot)).convert("RGB")).astype(int)


def held(editor: EditorPage) -> set[str]:
    """Names of the layers that have pins of their own."""
    document = editor.value()
    return {document["bodies"][point["body"]]["name"] for point in document.get("rig_points", []) if "body" in point}


def run_again(editor: EditorPage) -> None:
    """Run the node, which need not offer it by a button."""
    editor.ask("Object.assign(editor.live.run, {earlier: true}) && editor.options.onRun() && 0")
    editor.wait("editor.live.run && !editor.live.run.earlier && editor.live.mesh !== null")


def names(editor: EditorPage) -> list[str]:
    return editor.selector("[data-layer]").all_text_contents()


def test_the_list_shows_the_layers_from_front_to_back(editor: EditorPage) -> None:
    assert names(editor) == NAMES
    for name in NAMES:
        assert editor.selector(f'[data-moves="{name}"]').is_checked() == (name in MOVING)
    assert editor.selector('[aria-label="Layers"]').is_visible()
    assert editor.selector('input[aria-label="ribbon moves"]').count() == 1
    editor.wait("editor.live.measured.drawn > 0")
    assert editor.page.problems == []


def test_what_moves_is_switched_by_name_and_undone(editor: EditorPage) -> None:
    editor.selector('[data-moves="ribbon"]').click()
    assert editor.value()["still"] == ["ribbon"]
    assert [body["name"] for body in editor.value()["bodies"]] == [name for name in MOVING if name != "ribbon"]
    editor.selector('[data-moves="arms"]').click()
    assert editor.value()["bodies"][-1] == {
        "name": "arms",
        "material": {"preset": "hair"},
        "attach": "auto",
    }
    editor.selector('[data-preset="arms"]').select_option("jelly")
    assert editor.queued()["bodies"][-1] == {"name": "arms", "material": {"preset": "jelly"}, "attach": "auto"}
    editor.run_node()
    editor.wait("editor.live.mesh?.names.includes('arms')")
    assert "arms" in held(editor), "the run has found where it is held"
    assert editor.ask("editor.live.mesh.names") == ["back hair", "cape", "arms", "skirt", "front hair", "plant"]
    editor.focus()
    editor.keys("Control+z", "Control+z", "Control+z")
    assert "arms" not in held(editor)
    assert not editor.value().get("still")
    assert editor.selector('[data-moves="ribbon"]').is_checked()
    assert editor.page.problems == []


def test_a_layer_is_selected_in_the_list_and_in_the_picture(editor: EditorPage) -> None:
    editor.press("select")
    editor.click(1090, 500)
    assert editor.ask("editor.chosen") == "plant"
    assert editor.selector('[data-layer="plant"]').get_attribute("aria-pressed") == "true"
    editor.selector('[data-layer="cape"]').click()
    assert editor.ask("editor.live.outlineOf(editor.chosenLayer.index).mesh.triangles.length") > 0
    editor.keys("ArrowDown")
    assert editor.ask("editor.chosen") == "back hair"
    assert editor.selector('[data-layer="back hair"]').evaluate("(one) => one === document.activeElement")
    assert editor.ask("Boolean(node.graph)")


def test_still_layers_are_drawn_over_moving_ones_and_can_be_hidden(editor: EditorPage) -> None:
    editor.ask("editor.commands.run('items')")  # the pins would be seen
    editor.wait("editor.live.playback.frames.length > 0")
    editor.ask("editor.commands.seek(0)")
    rest = film(editor)
    away = difference(editor, rest, FACE)
    assert away < 12
    editor.selector('[data-eye="face"]').click()
    assert editor.selector('[data-eye="face"]').get_attribute("aria-pressed") == "false"
    assert difference(editor, film(editor), FACE) > away + 20
    assert editor.value() == editor.shown()  # it is only a look
    editor.selector('[data-eye="face"]').click()
    np.testing.assert_allclose(film(editor), rest, atol=3)
    # The skirt moves behind the arms, which stand still and are seen through nothing.
    assert difference(editor, rest, ARMS) < 12
    editor.selector('[data-eye="arms"]').click()
    assert difference(editor, film(editor), ARMS) > 20


def test_layers_are_held_from_the_start_and_their_pins_are_moved_and_put_back(editor: EditorPage) -> None:
    assert held(editor) == set(MOVING)
    found = editor.value()["rig_points"]
    editor.wait("editor.live.measured.drawn > 0")
    editor.wait("editor.live.playback.frames.length > 30")
    assert editor.ask("editor.live.measured.largest") < 1, "nothing acts, and all is held"
    editor.press("select")
    bodies = editor.value()["bodies"]
    number = next(n for n, point in enumerate(found) if bodies[point["body"]]["name"] == "skirt")
    x, y = found[number]["position"]
    editor.drag((x, y), (x + 30, y))
    assert editor.value()["rig_points"][number]["position"][0] > x + 15
    for number in range(len(found)):
        editor.ask(f"editor.select({{list: 'rig_points', index: {len(found) - 1 - number}}})")
        editor.press("delete")
    assert editor.value()["rig_points"] == []
    run_again(editor)
    editor.wait("editor.live.playback.frames.length > 0")
    assert editor.value()["rig_points"] == [], "what was taken away stays away"
    editor.press("hold")
    editor.wait("editor.document.rig_points.length > 0")
    again = editor.value()["rig_points"]
    assert [point["region"] for point in again] == [point["region"] for point in found]
    assert editor.queued()["rig_points"] == again
    assert editor.page.problems == []


def test_where_a_layer_is_held_is_chosen_in_the_list(editor: EditorPage) -> None:
    editor.selector('[data-layer="cape"]').click()
    choice = editor.selector('[data-attach="cape"]')
    assert choice.input_value() == "end"
    before = editor.value()["rig_points"]
    choice.select_option("bottom")
    editor.wait("editor.document.bodies.find((one) => one.name === 'cape').attach === 'bottom'")
    number = [body["name"] for body in editor.value()["bodies"]].index("cape")
    lowest = [max(y for _, y in point["region"]["points"]) for point in own(editor, number)]
    assert max(lowest) > max(y for point in before if point["body"] == number for _, y in point["region"]["points"])
    choice.select_option("none")
    editor.wait("editor.document.bodies.find((one) => one.name === 'cape').attach === 'none'")
    assert own(editor, number) == []
    run_again(editor)
    assert own(editor, number) == [], "it is held nowhere"
    editor.focus()
    editor.keys("Control+z", "Control+z")
    assert editor.value()["rig_points"] == before
    assert choice.input_value() == "end"


def own(editor: EditorPage, number: int) -> list[dict[str, Any]]:
    return [point for point in editor.value()["rig_points"] if point.get("body") == number]


def test_layers_are_put_in_another_order(editor: EditorPage) -> None:
    editor.ask("editor.commands.run('items')")  # the pins would be seen
    editor.wait("editor.live.playback.frames.length > 0")
    editor.ask("editor.commands.seek(0)")
    assert difference(editor, looked_at(editor), HAIR) < 12
    editor.selector('[data-layer="background"]').click()
    editor.page.page.keyboard.press("Alt+ArrowUp")
    moved = [*NAMES[:-2], "background", "back hair"]
    assert names(editor) == moved
    assert editor.value()["order"] == moved[::-1]
    assert editor.selector('[data-layer="background"]').evaluate("(one) => one === document.activeElement")
    editor.selector('[data-place="front background"]').click()
    editor.selector('[data-place="back background"]').click()
    assert names(editor) == moved
    assert difference(editor, looked_at(editor), HAIR) > 30, "the hair is behind the sky"
    run_again(editor)
    editor.wait("editor.live.player.layered !== null")
    assert names(editor) == moved
    assert difference(editor, looked_at(editor), HAIR) > 30
    line = editor.selector('[data-layer="back hair"]').bounding_box()
    target = editor.selector('[data-layer="background"]').bounding_box()
    mouse = editor.page.page.mouse
    mouse.move(line["x"] + 20, line["y"] + line["height"] / 2)
    mouse.down()
    mouse.move(line["x"] + 20, target["y"] + 4, steps=5)
    mouse.up()
    assert names(editor) == NAMES
    assert difference(editor, looked_at(editor), HAIR) < 12
    assert editor.page.problems == []


def looked_at(editor: EditorPage) -> np.ndarray:
    """The picture at rest, without the outline of a layer that is selected."""
    editor.ask("editor.choose('')")
    editor.ask("editor.commands.seek(0)")
    return film(editor)


def difference(editor: EditorPage, seen: np.ndarray, box: tuple[int, int, int, int]) -> float:
    """How far a part of what is seen is from the example's picture, of 255, at the best place within a pixel."""
    left, top, right, bottom = box
    x0, y0 = map(round, _corner(editor, left, top))
    x1, y1 = map(round, _corner(editor, right, bottom))
    expected = Image.open(_EXAMPLE).convert("RGB").crop(box).resize((x1 - x0, y1 - y0), Image.Resampling.BOX)
    meant, steps = np.asarray(expected).astype(int), (-1, 0, 1)
    places = [seen[y0 + down : y1 + down, x0 + across : x1 + across] for down in steps for across in steps]
    return min(float(np.abs(place - meant).mean()) for place in places)


def _corner(editor: EditorPage, x: float, y: float) -> tuple[float, float]:
    """Where a pixel of the picture is, from the corner of the stage."""
    box = editor.selector(".physanimator-stage").bounding_box()
    across, down = editor.place(x, y)
    return across - box["x"], down - box["y"]
