"""Calls nodes of the host and ours in one process, where a graph would need model files; prints what came out as JSON.

cd COMFYUI; its/python in_the_hosts_python.py CHECKOUT
"""

from __future__ import annotations

import importlib.util
import json
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

ROOT = Path(sys.argv.pop(1))
sys.path.insert(0, str(Path.cwd()))

import torch  # noqa: E402
from comfy.cli_args import args  # noqa: E402

args.cpu = True


def ours(name: str) -> Any:
    """A module of this pack."""
    if "physanimator" not in sys.modules:
        places = [str(ROOT)]
        spec = importlib.util.spec_from_file_location(
            "physanimator", ROOT / "__init__.py", submodule_search_locations=places
        )
        assert spec is not None
        assert spec.loader is not None
        sys.modules["physanimator"] = module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    return importlib.import_module(f"physanimator.{name}")


class Vae:
    """Means of squares of 8 px, every fourth frame."""

    latent_channels = 16

    def spacial_compression_encode(self) -> int:
        return 8

    def encode(self, pixels: torch.Tensor) -> torch.Tensor:
        small = torch.nn.functional.avg_pool2d(pixels.movedim(-1, 1), 8)[::4]
        return small.mean(1, keepdim=True).repeat(1, 16, 1, 1).movedim(0, 1)[None]


def keyframes() -> dict[str, Any]:
    """First and last frame by the host's node and by ours: what samplers are given."""
    from comfy_extras.nodes_wan import WanFirstLastFrameToVideo

    torch.manual_seed(0)
    both, words = torch.rand(2, 48, 64, 3), [[torch.zeros(1, 2, 4), {"pooled": 1}]]
    size = {"width": 64, "height": 48, "length": 17, "batch_size": 1}
    theirs = WanFirstLastFrameToVideo.execute(words, words, Vae(), **size, start_image=both[:1], end_image=both[1:])
    node = ours("nodes.keyframe_nodes").WanKeyframes
    found = node.execute(words, words, Vae(), **size, keyframes=both, indices="0, -1")
    three = node.execute(words, words, Vae(), **size, keyframes=torch.rand(3, 48, 64, 3), indices="0, 8, 16")
    pairs = list(zip(theirs.args[:2], found.args[:2], strict=True))
    alike = [
        float((a[0][1][name] - b[0][1][name]).abs().max())
        for a, b in pairs
        for name in ("concat_latent_image", "concat_mask")
    ]
    mask = three.args[0][0][1]["concat_mask"]
    return {
        "difference": max(alike),
        "names": [sorted(each[0][0][1]) for each in (theirs.args, found.args)],
        "latents": [list(each.args[2]["samples"].shape) for each in (theirs, found)],
        "mask": list(mask.shape),
        "known": (mask[0, :, :, 0, 0].T == 0).int().tolist(),
    }


class Sam3:
    """Finds the same squares in every picture."""

    def __init__(self, squares: int) -> None:
        self.squares = squares
        self.model = SimpleNamespace(get_dtype=lambda: torch.float32, diffusion_model=self.found)

    def found(self, frame: torch.Tensor, **others: Any) -> dict[str, list[torch.Tensor]]:
        height, width = others["orig_size"]
        masks = torch.full((self.squares, height // 4, width // 4), -5.0)
        boxes = torch.zeros(self.squares, 4)
        for number in range(self.squares):
            left = 3 + 8 * number
            masks[number, 4:10, left : left + 6] = 5.0
            boxes[number] = torch.tensor([4 * left, 16, 4 * left + 24, 40])
        return {"boxes": [boxes], "scores": [torch.full((self.squares,), 4.0)], "masks": [masks]}


def segments() -> dict[str, Any]:
    """Masks of SAM3 Detect in our nodes."""
    import comfy.model_management
    from comfy_extras.nodes_sam3 import SAM3_Detect

    comfy.model_management.load_model_gpu = lambda model: None
    host, animated = ours("nodes.host"), ours("nodes.animated_inputs")
    words = [
        [
            torch.zeros(1, 2, 4),
            {"sam3_multi_cond": [{"cond": torch.zeros(1, 2, 4), "attention_mask": None, "max_detections": 9}]},
        ]
    ]
    told: dict[str, Any] = {}
    for squares, apart in ((2, True), (2, False), (0, True), (0, False)):
        masks = SAM3_Detect.execute(
            Sam3(squares), torch.rand(1, 64, 96, 3), words, refine_iterations=0, individual_masks=apart
        ).args[0]
        name = f"{squares} {'apart' if apart else 'together'}"
        told[name] = {"shape": list(masks.shape)}
        for what, take in (
            ("mesh", lambda masks=masks: [host.mask_of(masks)]),
            ("parts", lambda masks=masks: animated._masks_of(masks)),
        ):
            try:
                told[name][what] = [int((each > 0.5).sum()) for each in take()]
            except ValueError as error:
                told[name][what] = str(error)
    return told


print(
    json.dumps(
        {
            "keyframes": keyframes(),
            "segments": segments() if importlib.util.find_spec("comfy_extras.nodes_sam3") else None,
        }
    )
)
