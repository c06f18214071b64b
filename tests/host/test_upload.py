"""The button of Load Layers in the page, and dropping files on the node."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from bar_graphs import core, ours
from layered_files import bust, write_ora
from PIL import Image

_ADD = """() => {
  app.graph.clear();
  const node = LiteGraph.createNode('PhysAnimator_LoadLayers');
  app.graph.add(node);
  return node.id;
}"""
_VALUE = "([id]) => app.graph.getNodeById(id).widgets.find((one) => one.name === 'file').value"
_PRESS = "([id]) => app.graph.getNodeById(id).widgets.find((one) => one.type === 'button').callback()"
_DROP = """async ([id, name]) => {
  const data = new DataTransfer();
  data.items.add(new File([new Uint8Array([1, 2, 3])], name));
  const event = new DragEvent('drop', { dataTransfer: data });
  const node = app.graph.getNodeById(id);
  return [node.onDragOver(new DragEvent('dragover', { dataTransfer: data })), node.onDragDrop(event)];
}"""


@pytest.fixture
def node(page: Any) -> int:
    page.problems.clear()
    return page.run(_ADD)


def choose(page: Any, node: int, *files: Path) -> str:
    """Press the button and choose files; the value of the widget afterwards."""
    before = page.run(_VALUE, [node])
    with page.page.expect_file_chooser() as chooser:
        page.run(_PRESS, [node])
    chooser.value.set_files([str(file) for file in files])
    page.page.wait_for_function(f"([id, before]) => ({_VALUE})([id]) !== before", arg=[node, before], timeout=10_000)
    return page.run(_VALUE, [node])


def test_a_layered_file_is_uploaded_and_chosen(host: Any, page: Any, node: int, tmp_path: Path) -> None:
    write_ora(tmp_path / "胸像.ora", bust())
    value = choose(page, node, tmp_path / "胸像.ora")
    assert value == "胸像.ora"
    saved = page.run("() => app.graph.serialize().nodes[0].widgets_values")
    assert saved == ["胸像.ora"], "the button is not saved"
    prompt = {"load": ours("LoadLayers", file=value), "seen": core("PreviewImage", images=["load", 1])}
    assert len(host.run(prompt)["seen"]["images"]) == 1
    (host.folder / "input" / value).unlink()
    assert page.problems == []


def test_pictures_chosen_together_become_a_folder(host: Any, page: Any, node: int, tmp_path: Path) -> None:
    places = [tmp_path / "1 paper.png", tmp_path / "2 ribbon.png"]
    for place, (_, pixels) in zip(places, bust(), strict=False):
        Image.fromarray(pixels).save(place)
    value = choose(page, node, *places)
    page.page.wait_for_timeout(500)
    assert value.startswith("layers_")
    prompt = {"load": ours("LoadLayers", file=value), "seen": core("PreviewImage", images=["load", 1])}
    host.run(prompt)
    assert sorted(each.name for each in (host.folder / "input" / value).iterdir()) == [each.name for each in places]


def test_what_is_dropped_is_taken_only_if_it_is_layered(page: Any, node: int) -> None:
    assert page.run(_DROP, [node, "dropped.psd"]) == [True, True]
    page.page.wait_for_function(f"([id]) => ({_VALUE})([id]) === 'dropped.psd'", arg=[node], timeout=10_000)
    assert page.run(_DROP, [node, "film.mp4"]) == [True, False]
