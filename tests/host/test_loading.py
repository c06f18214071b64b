"""The pack as the host loads it."""

from __future__ import annotations

import json
import re
import subprocess
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
SCHEMAS = json.loads((ROOT / "tests" / "nodes" / "node_schemas.json").read_text(encoding="utf-8"))

_AWAIT_ENTRYPOINT = """
import asyncio, importlib.util, json, sys
spec = importlib.util.spec_from_file_location("pack", ROOT + "/__init__.py", submodule_search_locations=[ROOT])
pack = sys.modules["pack"] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(pack)
heavy = [name for name in ("torch", "taichi", "cv2", "diffusers", "scipy", "comfy_api") if name in sys.modules]
async def ids():
    extension = await pack.comfy_entrypoint()
    return [node.GET_SCHEMA().node_id for node in await extension.get_node_list()]
print(json.dumps({"heavy": heavy, "ids": asyncio.run(ids()),
                  "late": [name for name in ("taichi", "diffusers", "jsonschema") if name in sys.modules]}))
"""


def nodes_of(host: Any) -> dict[str, Any]:
    return {name: info for name, info in host.get("/object_info").items() if name.startswith("PhysAnimator_")}


def inputs_of(described: dict[str, Any]) -> list[tuple[str, Any]]:
    """Every input with its options, those inside dynamic combos included."""
    found = []
    for name, (kind, options) in {**described.get("required", {}), **described.get("optional", {})}.items():
        found.append((name, options))
        if kind == "COMFY_DYNAMICCOMBO_V3":
            for option in options["options"]:
                found += inputs_of(option["inputs"])
    return found


def tracebacks(log: str) -> list[str]:
    """Every traceback of a log, from its first line to the exception."""
    return re.findall(r"Traceback \(most recent call last\):\n(?:[ \t].*\n)+.*", log)


def test_a_traceback_is_found_whole() -> None:
    frames = '  File "/packs/PhysAnimator/nodes/extension.py", line 3, in <module>\n    import missing\n'
    log = f"before\nTraceback (most recent call last):\n{frames}ImportError: missing\nafter PhysAnimator\n"
    (found,) = tracebacks(log)
    assert found.endswith("ImportError: missing")
    assert "PhysAnimator" in found
    assert tracebacks(log.replace("Traceback", "No trace")) == []


def test_the_log_says_that_the_pack_was_loaded_and_nothing_worse(host: Any) -> None:
    started = host.log.split("To see the GUI go to")[0]
    about_us = [line for line in started.splitlines() if re.search("physanimator", line, re.IGNORECASE)]
    assert [line for line in about_us if re.search(r"[\d.]+ seconds: ", line)]
    assert not [line for line in about_us if re.search("failed|error|warning|cannot|skip", line, re.IGNORECASE)]
    assert not [told for told in tracebacks(started) if "physanimator" in told.lower()], "others' are theirs to mend"


def test_the_entrypoint_gives_every_node_and_loads_nothing_heavy_too_early(host: Any) -> None:
    code = f"ROOT = {str(ROOT)!r}\n{_AWAIT_ENTRYPOINT}"
    done = subprocess.run([host.python, "-c", code], cwd=host.checkout, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    told = json.loads(done.stdout.splitlines()[-1])
    assert sorted(told["ids"]) == sorted(SCHEMAS)
    assert told["heavy"] == []
    assert told["late"] == []


def _without_advanced(told: Any) -> Any:
    if isinstance(told, dict):
        return {key: _without_advanced(value) for key, value in told.items() if key != "advanced"}
    return [_without_advanced(value) for value in told] if isinstance(told, list) else told


def test_the_recorded_schemas_are_those_of_this_host(host: Any) -> None:
    # Newer hosts tell more of every node than 0.8.0, which has written the record, and which inputs are advanced.
    told = {
        name: _without_advanced(_without_files(host, {key: node[key] for key in SCHEMAS.get(name, node)}))
        for name, node in nodes_of(host).items()
    }
    assert told == SCHEMAS, "run tests/host/export_workflows.py"


def _without_files(host: Any, report: dict[str, Any]) -> dict[str, Any]:
    """A report as if no other test had put files into the input folder."""
    files = {path.name for path in (host.folder / "input").iterdir()}
    for _, options in (value for group in report["input"].values() for value in group.values() if len(value) > 1):
        if "others_too" in options:
            options["options"] = [name for name in options["options"] if name not in files]
    return report


def test_every_input_and_output_has_a_tooltip(host: Any) -> None:
    for name, info in nodes_of(host).items():
        assert info["description"], name
        assert info["category"].split("/")[0] == "PhysAnimator", name
        for input_name, options in inputs_of(info["input"]):
            assert len(options.get("tooltip") or "") > 5, f"{name}.{input_name}"
        assert len(info["output"]) == len(info["output_tooltips"])
        assert all(info["output_tooltips"]), name


def test_every_number_has_bounds_a_step_and_a_default(host: Any) -> None:
    for name, info in nodes_of(host).items():
        for input_name, options in inputs_of(info["input"]):
            if isinstance(options.get("default"), int | float) and not isinstance(options["default"], bool):
                assert options["min"] <= options["default"] <= options["max"], f"{name}.{input_name}"


def test_help_pages_are_served(host: Any) -> None:
    for name in nodes_of(host):
        page = host.read(f"/extensions/PhysAnimator/docs/{name}.md").decode()
        assert page == (ROOT / "nodes" / "web" / "docs" / f"{name}.md").read_text(encoding="utf-8")


def test_templates_are_offered_with_their_thumbnails(host: Any) -> None:
    names = sorted(path.stem for path in (ROOT / "workflows").glob("*.json"))
    assert sorted(host.get("/api/workflow_templates")["PhysAnimator"]) == names
    for name in names:
        served = host.get(f"/api/workflow_templates/PhysAnimator/{name}.json")
        assert served == json.loads((ROOT / "workflows" / f"{name}.json").read_text(encoding="utf-8"))
        assert host.read(f"/api/workflow_templates/PhysAnimator/{name}.jpg")[:3] == b"\xff\xd8\xff"


_COUNT_CHECKS = """
import importlib.util, json, sys
spec = importlib.util.spec_from_file_location("pack", ROOT + "/__init__.py", submodule_search_locations=[ROOT])
pack = sys.modules["pack"] = importlib.util.module_from_spec(spec)
spec.loader.exec_module(pack)
import numpy as np
from pack.nodes import scene_editor_nodes, scene_nodes
from pack.nodes.host.wires import MaskedBody
from pack.physics.document import checking
from pack.physics.mesh import TriangleMesh
from pack.physics.scene import Body
checked, original = [], checking._check_version
checking._check_version = lambda data: checked.append(data) or original(data)
scene_editor_nodes.warm_up = lambda contact: None
mesh = TriangleMesh(np.array([(0.0, 0.0), (10.0, 0.0), (10.0, 10.0)]), np.array([[0, 1, 2]]), 64, 48)
bodies = (MaskedBody(Body(mesh), np.zeros((48, 64)), "auto"),)
counts = []
for number, node in enumerate((scene_nodes.SceneFromJSON, scene_editor_nodes.SceneEditor)):
    text = json.dumps({"version": 2, "width": 64 + number, "height": 48})
    assert node.validate_inputs(scene=text) is True
    assert node.execute(scene=text, bodies=bodies) is not None
    counts.append(len(checked))
print(json.dumps(counts))
"""


def test_nodes_check_a_document_once(host: Any) -> None:
    code = f"ROOT = {str(ROOT)!r}\n{_COUNT_CHECKS}"
    done = subprocess.run([host.python, "-c", code], cwd=host.checkout, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout.splitlines()[-1]) == [1, 2]
