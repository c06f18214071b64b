"""The stand-in of ``tests/standin`` against a real host, which is the authority."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).resolve().parents[2]
SURFACE = ROOT / "tests" / "standin" / "surface.py"
VIDEO = ["CreateVideo", "SaveVideo", "SaveAnimatedWEBP"]
PICTURES = ["EmptyImage", "ImageBatch", "ImageScale", "ImageStitch", "LoadImage", "PreviewImage", "RepeatImageBatch"]
MASKS = ["FeatherMask", "ImageToMask", "InvertMask", "MaskComposite", "MaskToImage", "SolidMask"]


def surface(host: Any, *arguments: str, names: Any = None) -> dict[str, Any]:
    done = subprocess.run(
        [host.python, str(SURFACE), *arguments], input=json.dumps(names), cwd=host.checkout, capture_output=True,
        text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


@pytest.fixture(scope="module")
def both(host: Any) -> tuple[dict[str, Any], dict[str, Any]]:
    """What the stand-in offers, and the same names in the host."""
    ours = surface(host, str(SURFACE.with_name("host")))
    known = ("--cpu", "--base-directory", str(host.folder))
    theirs = surface(host, str(host.checkout), *known, names=ours["names"])
    return ours["told"], theirs["told"]


def test_the_host_has_every_name_of_the_stand_in(both: tuple[dict[str, Any], dict[str, Any]]) -> None:
    ours, theirs = both
    assert len(ours) > 80
    assert [name for name, told in theirs.items() if told == "missing"] == []


def test_whatever_the_stand_in_takes_the_host_takes_too(both: tuple[dict[str, Any], dict[str, Any]]) -> None:
    """By the same names, in the same order, with the same defaults; what newer hosts add may be left out."""
    ours, theirs = both
    for name, parameters in ours.items():
        known = theirs[name]
        if parameters is None or known is None:
            continue
        takes_more = [each for each, (kind, _) in known.items() if kind.startswith("VAR_")]
        for each, told in parameters.items():
            assert known.get(each, told if takes_more else None) == told, f"{name}({each})"
        shared = [each for each in known if each in parameters]
        assert shared == [each for each in parameters if each in known], name
        added = {each: told for each, told in known.items() if each not in parameters and each not in takes_more}
        assert all(default != "required" for _, default in added.values()), f"{name}: {added}"


_BRINGS_INPUTS = "COMFY_DYNAMICCOMBO_V3"


@pytest.mark.parametrize("name", [*VIDEO, *PICTURES, *MASKS, "PreviewAny"])
def test_the_stand_in_s_nodes_have_the_inputs_and_outputs_of_the_host_s(host: Any, name: str, tmp_path: Path) -> None:
    standin = pytest.importorskip("standin")
    told = host.get("/object_info")[name]
    with standin.installed():
        import folder_paths
        from standin import core_nodes

        folder_paths.use(tmp_path)
        (ours,) = [kind.GET_NODE_INFO_V1() for kind in core_nodes.NODES if kind.GET_SCHEMA().node_id == name]
    assert told["output"][: len(ours["output"])] == ours["output"]  # newer hosts give more
    assert ours["output_node"] == told["output_node"]
    for group in ("required", "optional"):
        for key, (kind, options) in ours["input"].get(group, {}).items():
            theirs = told["input"].get(group, {}).get(key)
            if theirs is None or theirs[0] == _BRINGS_INPUTS:  # a newer host's choice brings inputs that stood alone
                assert _BRINGS_INPUTS in {each[0] for each in told["input"][group].values()}, key
                continue
            assert (theirs[0] if isinstance(theirs[0], str) else "COMBO") == kind, key
            found = theirs[1] if len(theirs) > 1 else {}
            for option in ("default", "min", "step"):
                assert found.get(option, options.get(option)) == options.get(option, found.get(option)), (
                    f"{key}: {option}"
                )
    missing = set(told["input"].get("required", {})) - set(ours["input"]["required"])
    assert not missing, f"the host wants {missing}"
