"""Which nodes of the host and of other packs are named where clicks are not enough."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest
from physanimator.nodes.models import segmenter_advice


@pytest.fixture
def host(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Any:
    """A host's modules of nodes and folders; ``known`` fills its nodes."""
    paths = ModuleType("folder_paths")
    paths.models_dir, paths.folder_names_and_paths = str(tmp_path), {}  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "folder_paths", paths)

    def known(**names: str) -> None:
        fake = SimpleNamespace(NODE_CLASS_MAPPINGS=dict.fromkeys(names), NODE_DISPLAY_NAME_MAPPINGS=names)
        monkeypatch.setitem(sys.modules, "nodes", fake)

    known()
    return known


def test_a_host_without_such_nodes_names_our_own_network_and_where_its_model_belongs(host: Any, tmp_path: Path) -> None:
    host(KSampler="KSampler", SamplerCustom="Sampler", LatentUpscaleDetect="Detect", PhysAnimator_SAM_Segment="Ours")
    assert segmenter_advice() == (
        "Where points and colours are not enough, choose segment anything as backend (a model belongs into models/sams,"
        " see this node's help)."
    )
    (tmp_path / "sams").mkdir()
    (tmp_path / "sams" / "sam_vit_b_01ec64.pth").touch()
    assert segmenter_advice() == "Where points and colours are not enough, choose segment anything as backend."


def test_the_nodes_that_cut_are_named_as_the_host_shows_them(host: Any) -> None:
    host(SAM3_Detect="SAM3 Detect", SAM3_TrackPreview="Preview", Sam2Segmentation="", SAMModelLoader="Loader")
    assert segmenter_advice().endswith("or connect the mask of SAM3 Detect or Sam2Segmentation.")
