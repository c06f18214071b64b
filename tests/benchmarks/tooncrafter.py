"""The interpolation with random weights of full size: seconds a pair of keyframes, and memory.

    python tests/benchmarks/tooncrafter.py --json

Pairs are drawn on a GPU if there is one, in half precision, eager and compiled. On a CPU, where a pair would take
hours, two sampling steps are drawn, and the seconds of a pair are extrapolated from them; --steps says how many. Each
pair is led by sketches, and drawn at once from pictures to pictures, so that a step is two predictions of the UNet and
of the sketch encoder. --size tiny takes small networks. Memory is also counted, without a device, for each working
size and number of frames that are decoded together.
"""

from __future__ import annotations

import argparse
import json
import time
from typing import Any

import numpy as np
import source_tree  # loads this source tree as the package physanimator
import torch
from physanimator.rendering.inbetweens import Clip
from physanimator.rendering.networks.checkpoints import assign, build_without_storage
from physanimator.rendering.networks.image_encoder import ImageEncoder
from physanimator.rendering.networks.memory import bytes_of, peak_memory
from physanimator.rendering.networks.placement import Placement
from physanimator.rendering.tooncrafter import ToonCrafterOptions
from physanimator.rendering.tooncrafter.autoencoder import DualReferenceAutoencoder
from physanimator.rendering.tooncrafter.interpolator import ToonCrafterInterpolator
from physanimator.rendering.tooncrafter.models import ModelSizes, ToonCrafterModels
from physanimator.rendering.tooncrafter.resampler import ImageResampler
from physanimator.rendering.tooncrafter.sketch_encoder import SketchEncoder
from physanimator.rendering.tooncrafter.unet import InterpolationUNet
from torch._subclasses.fake_tensor import FakeTensorMode

random_svd = source_tree.helper("random_svd")
random_tooncrafter = source_tree.helper("random_tooncrafter")
LiveTensors = source_tree.helper("live_tensors").LiveTensors

GIB = 2**30
GAP = 15
DECODED_TOGETHER = (ToonCrafterOptions.decoded_together, 8, 16)
STAGES = ("picture encoder", "resampler", "encoding", "sampling", "decoding")
AREAS = {"512x320": (512, 320), "768x512": (768, 512), "128x64": (128, 64)}


def random_models(sizes: ModelSizes, dtype: torch.dtype) -> ToonCrafterModels:
    """All networks with random weights."""

    def made(build: Any, seed: int, kept: torch.dtype) -> Any:
        network = build_without_storage(build)
        assign(network, random_svd.random_weights(network, seed, dtype=kept), file="random", wanted="random")
        return network

    return ToonCrafterModels(
        made(lambda: InterpolationUNet(sizes.unet), 1, dtype),
        made(lambda: ImageResampler(sizes.resampler), 2, dtype),
        made(lambda: DualReferenceAutoencoder(sizes.autoencoder), 3, torch.float32),
        made(lambda: SketchEncoder(sizes.sketch), 4, dtype),
        made(lambda: ImageEncoder(sizes.image_encoder), 5, dtype),
        torch.randn(1, sizes.unet.text_tokens, sizes.unet.context_dim).to(dtype),
    )


def drawing(models: ToonCrafterModels, size: tuple[int, int], steps: int, device: torch.device) -> dict[str, Any]:
    """Seconds and peak memory of one pair, led by sketches."""
    width, height = size
    random = np.random.default_rng(0)
    keyframes = list(random.random((2, height, width, 3), dtype=np.float32))
    clip = Clip(keyframes, (0, GAP), sketches=list(random.random((GAP + 1, height, width), dtype=np.float32)))
    ends: list[float] = []

    def left() -> None:
        if device.type == "cuda":
            torch.cuda.synchronize(device)
        ends.append(time.perf_counter())

    options = ToonCrafterOptions(steps=steps, area=width * height)
    backend = ToonCrafterInterpolator(models, options=options, placement=Placement(device, left=left))
    if device.type == "cuda":
        torch.cuda.reset_peak_memory_stats(device)
    left()
    assert len(list(backend.in_betweens(clip, 0))) == GAP - 1
    stages = dict(zip(STAGES, np.diff(ends).tolist(), strict=True))
    step, usual = stages["sampling"] / steps, ToonCrafterOptions().steps
    found = {"seconds_of": stages, "steps": steps, "seconds_a_step": step}
    if steps != usual:
        found[f"seconds_with_{usual}_steps_extrapolated"] = ends[-1] - ends[0] + (usual - steps) * step
    return found | {"seconds": ends[-1] - ends[0], "peak_gib": peak_memory(device) / GIB}


def as_on_a_gpu(autoencoder: DualReferenceAutoencoder) -> None:
    """Let it normalise in single precision, which a GPU does in half precision too."""
    for module in autoencoder.modules():
        if isinstance(module, torch.nn.GroupNorm):
            module.register_forward_pre_hook(lambda _, given: (given[0].float(),))


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
        with LiveTensors(autoencoder) as encoding:
            references = autoencoder.encode(torch.empty(2, 3, height, width), together=1)[1]
        kept = sum(each.nbytes for each in references)
        decoding = {}
        as_on_a_gpu(autoencoder)
        for together in DECODED_TOGETHER:
            with LiveTensors(autoencoder) as live, torch.autocast("cpu", torch.bfloat16):
                autoencoder.decode(torch.empty(frames, 4, *latent), references, together=together)
            decoding[f"decoding, {together} together"] = live.peak + kept
    found = {
        "unet": bytes_of(unet),
        "sketch_encoder": bytes_of(sketch),
        "sampling": sampling.peak,
        "autoencoder": bytes_of(autoencoder),
        "encoding": encoding.peak,
        **decoding,
    }
    return {name: size / GIB for name, size in found.items()}


def pairs(models: ToonCrafterModels, device: torch.device, options: Any) -> dict[str, Any]:
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
    options.steps = options.steps or (ToonCrafterOptions().steps if on_gpu else 2)
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
