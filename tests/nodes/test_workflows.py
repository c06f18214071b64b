"""The workflow files against the schemas of the nodes, as a real host last reported them (node_schemas.json).

tests/host compares that report with the running host, and tests/host/export_workflows.py writes all of it anew.
"""

from __future__ import annotations

import ast
import json
from itertools import combinations
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image, ImageSequence

ROOT = Path(__file__).resolve().parents[2]
SCHEMAS: dict[str, Any] = json.loads(Path(__file__).with_name("node_schemas.json").read_text(encoding="utf-8"))
NAMES = sorted(path.stem for path in (ROOT / "workflows").glob("*.json"))
VALUE_TYPES = {"INT": (int,), "FLOAT": (int, float), "STRING": (str,), "COMBO": (str,), "BOOLEAN": (bool,)}
VIRTUAL = {"MarkdownNote", "Note"}


def ui_of(name: str) -> dict[str, Any]:
    return json.loads((ROOT / "workflows" / f"{name}.json").read_text(encoding="utf-8"))


def api_of(name: str) -> dict[str, Any]:
    return json.loads((ROOT / "workflows" / "api" / f"{name}.json").read_text(encoding="utf-8"))


def ours(api: dict[str, Any]) -> list[tuple[str, dict[str, Any]]]:
    return [(key, node) for key, node in api.items() if node["class_type"].startswith("PhysAnimator_")]


def inputs_of(schema: dict[str, Any], values: dict[str, Any]) -> dict[str, Any]:
    """Inputs of a node by name, with those that its dynamic combos bring under the chosen options."""
    found = {**schema["input"].get("required", {}), **schema["input"].get("optional", {})}
    for name, (kind, options) in list(found.items()):
        if kind == "COMFY_DYNAMICCOMBO_V3":
            brought = next(option["inputs"] for option in options["options"] if option["key"] == values[name])
            nested = {**brought.get("required", {}), **brought.get("optional", {})}
            found |= {f"{name}.{key}": value for key, value in nested.items()}
    return found


def saved_values(node: dict[str, Any]) -> dict[str, Any]:
    """Values of a node's widgets by name, from the list in which the frontend saves them."""
    values = list(node.get("widgets_values", []))
    if node["type"] not in SCHEMAS:
        names = [slot["name"] for slot in node.get("inputs", []) if "widget" in slot]
        for name in ("seed", "noise_seed"):
            if name in names:
                # The frontend's own widget beside a seed, which says how it goes on; it is no input.
                values.pop(names.index(name) + 1)
        return dict(zip(names, values, strict=True)) if names else {}
    saved: dict[str, Any] = {}
    _take(SCHEMAS[node["type"]]["input"], "", values, saved)
    assert values == []
    return saved


def _take(described: dict[str, Any], prefix: str, values: list[Any], saved: dict[str, Any]) -> None:
    for name, (kind, options) in {**described.get("required", {}), **described.get("optional", {})}.items():
        if kind in VALUE_TYPES or kind == "COMFY_DYNAMICCOMBO_V3":
            saved[prefix + name] = values.pop(0)
        if kind == "COMFY_DYNAMICCOMBO_V3":
            brought = next(option["inputs"] for option in options["options"] if option["key"] == saved[prefix + name])
            _take(brought, f"{prefix}{name}.", values, saved)


def ids_in_source() -> set[str]:
    """Every node_id that the sources pass to a schema."""
    found = set()
    for path in (ROOT / "nodes").glob("*_nodes.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.keyword) and node.arg == "node_id":
                assert isinstance(node.value, ast.Constant)
                found.add(node.value.value)
    return found


def test_the_report_knows_exactly_the_nodes_of_the_source() -> None:
    assert set(SCHEMAS) == ids_in_source()


def test_every_node_of_the_source_is_in_the_extension_s_list() -> None:
    tree = ast.parse((ROOT / "nodes" / "extension.py").read_text(encoding="utf-8"))
    listed = next(node.value for node in ast.walk(tree) if isinstance(node, ast.AnnAssign) and node.value)
    assert isinstance(listed, ast.List)
    assert len(listed.elts) == len(ids_in_source())


@pytest.mark.parametrize("node_id", sorted(SCHEMAS))
def test_every_node_has_a_help_page_that_names_its_inputs_and_outputs(node_id: str) -> None:
    page = (ROOT / "nodes" / "web" / "docs" / f"{node_id}.md").read_text(encoding="utf-8")
    schema = SCHEMAS[node_id]
    assert page.startswith(f"# {schema['display_name']}\n")
    for name in {**schema["input"].get("required", {}), **schema["input"].get("optional", {})}:
        assert name in page, f"{name} is not described"
    for name in schema["output_name"]:
        assert name in page, f"{name} is not described"


def test_no_help_page_without_a_node() -> None:
    assert {path.stem for path in (ROOT / "nodes" / "web" / "docs").glob("*.md")} == set(SCHEMAS)


def test_every_workflow_has_both_formats_and_a_thumbnail() -> None:
    assert NAMES
    assert sorted(path.stem for path in (ROOT / "workflows" / "api").glob("*.json")) == NAMES
    assert sorted(path.stem for path in (ROOT / "workflows").glob("*.jpg")) == NAMES


@pytest.mark.parametrize("ending", ["jpg", "webp"])
def test_no_two_thumbnails_look_alike(ending: str) -> None:
    """Who looks through the templates tells them apart: averaged over time, at the size of a stamp [grey levels]."""
    seen = {name: _stamp(ROOT / "workflows" / f"{name}.{ending}") for name in NAMES}
    differences = {(one, two): np.abs(seen[one] - seen[two]).mean() for one, two in combinations(NAMES, 2)}
    pair = min(differences, key=lambda each: differences[each])
    assert differences[pair] > 6, f"{' and '.join(pair)} differ by {differences[pair]:.1f}"


def _stamp(path: Path) -> NDArray[np.float64]:
    with Image.open(path) as clip:
        frames = [frame.convert("RGB").resize((32, 18), Image.Resampling.BOX) for frame in ImageSequence.Iterator(clip)]
    return np.mean([np.asarray(frame, dtype=np.float64) for frame in frames], axis=0)


@pytest.mark.parametrize("name", NAMES)
def test_api_inputs_exist_and_hold_usable_values(name: str) -> None:
    for key, node in ours(api_of(name)):
        values = node["inputs"]
        known = inputs_of(SCHEMAS[node["class_type"]], values)
        missing = set(SCHEMAS[node["class_type"]]["input"].get("required", {})) - set(values)
        assert not missing, f"node {key} lacks {missing}"
        for input_name, value in values.items():
            assert input_name in known, f"node {key} has an unknown input {input_name}"
            kind, options = known[input_name]
            if isinstance(value, list):
                continue
            if kind in VALUE_TYPES:
                assert isinstance(value, VALUE_TYPES[kind]), f"{key}.{input_name}: {value!r} is no {kind}"
            if "min" in options:
                assert options["min"] <= value <= options["max"], f"{key}.{input_name} = {value}"
            if kind == "COMBO":
                assert value in options["options"], f"{key}.{input_name} = {value}"


@pytest.mark.parametrize("name", NAMES)
def test_api_links_join_equal_types(name: str) -> None:
    api = api_of(name)
    for key, node in ours(api):
        known = inputs_of(SCHEMAS[node["class_type"]], node["inputs"])
        for input_name, value in node["inputs"].items():
            source = SCHEMAS.get(api[value[0]]["class_type"]) if isinstance(value, list) else None
            if source is not None:
                assert source["output"][value[1]] == known[input_name][0], f"{key}.{input_name}"


@pytest.mark.parametrize("name", NAMES)
def test_both_formats_are_the_same_graph(name: str) -> None:
    ui, api = ui_of(name), api_of(name)
    nodes = {str(node["id"]): node for node in ui["nodes"] if node["type"] not in VIRTUAL}
    assert {key: node["type"] for key, node in nodes.items()} == {key: node["class_type"] for key, node in api.items()}
    links = {link[0]: [str(link[1]), link[2]] for link in ui["links"]}
    for key, node in nodes.items():
        linked = {slot["name"]: links[slot["link"]] for slot in node.get("inputs", []) if slot.get("link") is not None}
        assert {**saved_values(node), **linked} == api[key]["inputs"], f"node {key} ({node['type']})"


@pytest.mark.parametrize("name", NAMES)
def test_links_of_the_ui_format_fit_its_nodes(name: str) -> None:
    ui = ui_of(name)
    nodes = {node["id"]: node for node in ui["nodes"]}
    for number, source, output, target, slot, kind in ui["links"]:
        assert number in nodes[source]["outputs"][output]["links"]
        assert nodes[target]["inputs"][slot]["link"] == number
        assert nodes[source]["outputs"][output]["type"] == kind
        assert nodes[target]["inputs"][slot]["type"] in (kind, "*")


@pytest.mark.parametrize("name", NAMES)
def test_no_two_nodes_overlap(name: str) -> None:
    title = 30
    boxes = [(node["pos"][0], node["pos"][1] - title, *node["size"]) for node in ui_of(name)["nodes"]]
    for index, (x, y, width, height) in enumerate(boxes):
        for left, top, across, down in boxes[:index]:
            apart = x >= left + across or left >= x + width or y >= top + down + title or top >= y + height + title
            assert apart, f"nodes at {(x, y)} and {(left, top)} overlap"


@pytest.mark.parametrize("name", NAMES)
def test_nothing_of_this_machine_is_in_the_files(name: str) -> None:
    text = json.dumps(ui_of(name)) + json.dumps(api_of(name))
    assert "127.0.0.1" not in text
    assert "/tmp" not in text
    assert "/home" not in text


def test_the_workflow_for_newer_hosts_is_the_quickstart_with_frames_between() -> None:
    api, shorter = api_of("frame_interpolation"), api_of("quickstart")
    added = {key: node for key, node in api.items() if key not in shorter}
    assert {node["class_type"] for node in added.values()} == {"FrameInterpolationModelLoader", "FrameInterpolate"}
    (drawn,) = (key for key, node in added.items() if node["class_type"] == "FrameInterpolate")
    (video,) = (node for node in api.values() if node["class_type"] == "CreateVideo")
    (scene,) = (node for node in api.values() if node["class_type"] == "PhysAnimator_AutomaticScene")
    assert video["inputs"]["images"] == [drawn, 0]
    assert api[api[drawn]["inputs"]["images"][0]]["class_type"] == "PhysAnimator_Render"
    assert video["inputs"]["fps"] == api[drawn]["inputs"]["multiplier"] * scene["inputs"]["frame_rate"]
    note = next(node for node in ui_of("frame_interpolation")["nodes"] if node["type"] == "MarkdownNote")
    assert "0.8.0 has not" in note["widgets_values"][0]


def test_the_workflow_for_see_through_lacks_nothing_but_that_pack() -> None:
    api = api_of("see_through")
    theirs = {key: node for key, node in api.items() if node["class_type"].startswith("SeeThrough_")}
    cores = {"CreateVideo", "SaveVideo", "PreviewAny"}
    assert {node["class_type"] for node in api.values()} - {node["class_type"] for node in theirs.values()} <= (
        set(SCHEMAS) | cores
    )
    (taken,) = [node for node in api.values() if node["class_type"] == "PhysAnimator_SeeThroughLayers"]
    source, output = taken["inputs"]["parts"]
    assert theirs[source]["class_type"] == "SeeThrough_PostProcess"
    assert output == 0
    ui = ui_of("see_through")
    carried = {link[5] for link in ui["links"] if str(link[3]) in api and str(link[1]) in theirs}
    assert "SEETHROUGH_PARTS" in carried
    (note,) = [node["widgets_values"][0] for node in ui["nodes"] if node["type"] == "MarkdownNote"]
    for told in ("ComfyUI-See-through", "MIT", "layerdiff3d", "marigold", "licences", "12 to 16 GB", "1280"):
        assert told in note


@pytest.mark.parametrize("name", ["wan_time_to_move", "wan_time_to_move_core"])
def test_time_to_move_has_the_published_steps_and_tells_what_it_needs(name: str) -> None:
    api = api_of(name)
    kinds = {key: node["class_type"] for key, node in api.items()}
    (given,) = [key for key, kind in kinds.items() if kind == "PhysAnimator_TimeToMove"]
    outputs = SCHEMAS["PhysAnimator_TimeToMove"]["output_name"]
    if name.endswith("core"):
        samplers = [node["inputs"] for node in api.values() if node["class_type"] == "KSamplerAdvanced"]
        assert [(each["start_at_step"], each["end_at_step"]) for each in samplers] == [(3, 7), (7, 18), (18, 10_000)]
        assert [each["add_noise"] for each in samplers] == ["enable", "disable", "disable"]
        assert {each["steps"] for each in samplers} == {50}
        assert {each["sampler_name"] for each in samplers} == {"euler"}
        held = api[samplers[0]["latent_image"][0]]["inputs"]
        assert held["mask"] == [given, outputs.index("free_latents")]
        assert kinds[api[samplers[1]["latent_image"][0]]["inputs"]["mask"][0]] == "SolidMask"
        needed = ("wan2.2_i2v_high_noise_14B_fp8_scaled", "No node pack")
    else:
        (led,) = [node["inputs"] for node in api.values() if node["class_type"] == "WanVideoAddTTMLatents"]
        assert (led["start_step"], led["end_step"]) == (3, 7)
        assert led["mask"] == [given, outputs.index("mask")]
        assert api[led["reference_latents"][0]]["inputs"]["image"] == [given, outputs.index("crude_animation")]
        start = api[led["embeds"][0]]["inputs"]
        assert start["start_image"] == [given, outputs.index("first_frame")]
        sizes = [start[side] for side in ("width", "height", "num_frames")]
        assert sizes == [[given, outputs.index(side)] for side in ("width", "height", "length")]
        needed = ("Wan2_2-I2V-A14B-HIGH_fp8", "ComfyUI-WanVideoWrapper")
    (note,) = [node["widgets_values"][0] for node in ui_of(name)["nodes"] if node["type"] == "MarkdownNote"]
    for told in (*needed, "Apache-2.0", "all countries", "14 GB", "not measured by us", "**3** to **7**", "2 and 5"):
        assert told in note


def test_the_workflow_for_layers_runs_at_once() -> None:
    api = api_of("layers")
    (load,) = [node for node in api.values() if node["class_type"] == "PhysAnimator_LoadLayers"]
    file = SCHEMAS["PhysAnimator_LoadLayers"]["input"]["required"]["file"][1]
    assert load["inputs"]["file"] == file["default"]
    assert (ROOT / "workflows" / "example" / "illustration.psd").stat().st_size < 2**20


@pytest.mark.parametrize("name", NAMES)
def test_nodes_say_which_pack_and_version_they_are_of(name: str) -> None:
    project = (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    ours = [node["properties"] for node in ui_of(name)["nodes"] if node["type"].startswith("PhysAnimator_")]
    assert ours
    for properties in ours:
        assert f'\nname = "{properties["cnr_id"]}"\nversion = "{properties["ver"]}"' in project
