"""The interpolation with random weights of full size: seconds a pair of keyframes, and memory.

    python tests/benchmarks/tooncrafter.py --json

Pairs are drawn on a GPU if there is one, in half precision, eager and compiled. On a CPU, where a pair would take the
better part of an hour, --steps says how many sampling steps are really measured; the seconds of a pair follow from
them. --size tiny takes small networks. Memory is also counted, without a device, for each working size.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from typing import Any

import numpy as np
import source_tree  # loads this source tree as the package physanimator
import torch
from live_tensors import LiveTensors
from physanimator.rendering.checkpoints import assign, build_without_storage
from physanimator.rendering.inbetweening import Clip
from physanimator.rendering.svd.image_encoder import ImageEncoder
from physanimator.rendering.svd.memory import bytes_of, peak_memory
from physanimator.rendering.svd.placement import Placement
from physanimator.rendering.tooncrafter.autoencoder import DualReferenceAutoencoder
from physanimator.rendering.tooncrafter.interpolator import ToonCrafterInterpolator
from physanimator.rendering.tooncrafter.models import InterpolationModels, ModelSizes
from physanimator.rendering.tooncrafter.options import InterpolationOptions
from physanimator.rendering.tooncrafter.resampler import ImageResampler
from physanimator.rendering.tooncrafter.sketch_encoder import SketchEncoder
from physanimator.rendering.tooncrafter.unet import InterpolationUNet
from torch._subclasses.fake_tensor import FakeTensorMode

random_svd = sys.modules["random_svd"] = source_tree.helper("random_svd")
random_tooncrafter = source_tree.helper("random_tooncrafter")

GIB = 2**30
GAP = 15
AREAS = {"512x320": (512, 320), "768x512": (768, 512), "128x64": (128, 64)}


def random_models(sizes: ModelSizes, dtype: torch.dtype) -> InterpolationModels:
    """All networks with random weights."""

    def made(build: Any, seed: int, kept: torch.dtype) -> Any:
        network = build_without_storage(build)
        assign(network, random_svd.random_weights(network, seed, dtype=kept), file="random", wanted="random")
        return network

    return InterpolationModels(
        made(lambda: InterpolationUNet(sizes.unet), 1, dtype),
        made(lambda: ImageResampler(sizes.resampler), 2, dtype),
        made(lambda: DualReferenceAutoencoder(sizes.autoencoder), 3, torch.float32),
        made(lambda: SketchEncoder(sizes.sketch), 4, dtype),
        made(lambda: ImageEncoder(sizes.image_encoder), 5, dtype),
        torch.randn(1, sizes.unet.text_tokens, sizes.unet.context_dim).to(dtype),
    )


def drawing(models: InterpolationModels, size: tuple[int, int], steps: int, device: torch.device) -> dict[str, float]:
    """Seconds and peak memory of one pair, led by sketches."""
    width, height = size
    random = np.random.default_rng(0)
    keyframes = list(random.random((2, height, width, 3), dtype=np.float32))
    clip = Clip(keyframes, (0, GAP), sketches=list(random.random((GAP + 1, height, width), dtype=np.float32)))
    marks: list[float] = []
    options = InterpolationOptions(steps=steps, area=width * height)
    backend = ToonCrafterInterpolator(
        models, options=options, placement=Placement(device), watch=lambda _: marks.append(time.perf_counter())
    )
    if device.type == "cuda":
        torch.cuda.reset_peak_memory_stats(device)
    began = time.perf_counter()
    assert len(list(backend.in_betweens(clip, 0))) == GAP - 1
    seconds = time.perf_counter() - began
    found = {"seconds": seconds, "peak_gib": peak_memory(device) / GIB}
    if len(marks) > 1:
        usual = InterpolationOptions().steps
        step = float(np.median(np.diff(marks)))
        found |= {"seconds_a_step": step, f"seconds_with_{usual}_steps": seconds + (usual - steps) * step}
    return found


def counted_memory(size: tuple[int, int], sizes: ModelSizes) -> dict[str, float]:
    """What full-size networks need in half precision, counted without a device [GiB]."""
    (width, height), half, frames = size, torch.float16, sizes.unet.temporal_length
    latent = (height // 8, width // 8)

    def empty(*shape: int) -> torch.Tensor:
        return torch.empty(shape, dtype=half)

    with FakeTensorMode(), torch.no_grad():
        unet, sketch = InterpolationUNet(sizes.unet), SketchEncoder(sizes.sketch)
        for network in (unet, sketch):
            tensors = {name: empty(*each.shape) for name, each in network.state_dict().items()}
            network.load_state_dict(tensors, assign=True)
        tokens = sizes.unet.text_tokens + frames * sizes.unet.image_tokens_per_frame
        context, timestep = empty(1, tokens, sizes.unet.context_dim), torch.zeros(1, dtype=torch.long)
        with LiveTensors(unet, sketch) as sampling:
            control = sketch(empty(frames, 4, *latent), empty(frames, 1, height, width), timestep, context)
            unet(empty(1, 8, frames, *latent), timestep, context, timestep, control)
        autoencoder = DualReferenceAutoencoder(sizes.autoencoder)
        references = autoencoder.encode(torch.empty(2, 3, height, width))[1]
        with LiveTensors(autoencoder) as decoding:
            autoencoder.decode(torch.empty(frames, 4, *latent), references)
    found = {
        "unet": bytes_of(unet),
        "sketch_encoder": bytes_of(sketch),
        "sampling": sampling.peak,
        "autoencoder": bytes_of(autoencoder),
        "decoding": decoding.peak // 2,  # half of what single precision needs
    }
    return {name: size / GIB for name, size in found.items()}


def pairs(models: InterpolationModels, device: torch.device, options: Any) -> dict[str, Any]:
    """Figures of a pair in each size, eager and, on a GPU, compiled."""
    found = {}
    for compiled in (False, True)[: 2 if device.type == "cuda" and not options.no_compile else 1]:
        if compiled:
            models.unet.compile()
            if models.sketch is not None:
                models.sketch.compile()
        for area in options.areas:
            if compiled:
                drawing(models, AREAS[area], 2, device)
            kind = "compiled" if compiled else "eager"
            found[f"{area}, {kind}"] = drawing(models, AREAS[area], options.steps, device)
    return found


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", choices=["full", "tiny"], default="full", help="of the networks")
    parser.add_argument("--areas", choices=list(AREAS), nargs="+", help="default: by device and networks")
    parser.add_argument("--steps", type=int, help="sampling steps that are measured; default: 50 on a GPU, 2 on a CPU")
    parser.add_argument("--dtype", choices=["float16", "bfloat16", "float32"], help="default: float16 on a GPU")
    parser.add_argument("--no-compile", action="store_true", help="leave out compiled networks")
    parser.add_argument("--only-count", action="store_true", help="count memory, draw nothing")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    options = parser.parse_args()
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    on_gpu = device.type == "cuda"
    usual = ["128x64"] if options.size == "tiny" else ["512x320", "768x512"] if on_gpu else ["512x320"]
    options.areas = options.areas or usual
    options.steps = options.steps or (InterpolationOptions().steps if on_gpu else 2)
    dtype = getattr(torch, options.dtype or ("float16" if on_gpu else "float32"))
    sizes = ModelSizes() if options.size == "full" else random_tooncrafter.TINY
    result: dict[str, Any] = {
        "device": torch.cuda.get_device_name(device) if on_gpu else f"cpu, {torch.get_num_threads()} threads",
        "torch": torch.__version__,
        "networks": options.size,
        "dtype": str(dtype).removeprefix("torch."),
        "steps": options.steps,
        "counted_memory_gib": {name: counted_memory(size, sizes) for name, size in AREAS.items()},
    }
    if not options.only_count:
        result["pairs"] = pairs(random_models(sizes, dtype), device, options)
    print(json.dumps(result, indent=2) if options.json else result)


if __name__ == "__main__":
    main()
