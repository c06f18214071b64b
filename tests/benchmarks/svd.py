"""The renderer by Stable Video Diffusion, random weights of full size: loading in every format, seconds and memory.

    python tests/benchmarks/svd.py --json
    python tests/benchmarks/svd.py --no-loading --modes animation plain diffusers --frames 14 --json

Files are written to a temporary folder (13 GB) and each format is loaded in a process of its own, as each mode of
drawing clips is (see svd_clips.py). Memory that only maps a file is not counted: the system can take it back. Clips are
drawn on a GPU if there is one; on a CPU, where they would take hours, with small networks, and only --size full draws
them with the real ones there too.
"""

from __future__ import annotations

import argparse
import json
import multiprocessing
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import source_tree  # loads this source tree as the package physanimator
import torch
from physanimator.rendering.networks.memory import bytes_of
from physanimator.rendering.svd import FrameLayout, NetworkConfiguration
from physanimator.rendering.svd.autoencoder import build_autoencoder
from physanimator.rendering.svd.controlnet import SketchControlNet
from physanimator.rendering.svd.models import load_models
from physanimator.rendering.svd.svd_weights import ModelSizes
from physanimator.rendering.svd.unet import SpatioTemporalUNet
from svd_clips import AREAS, GIB, MODES, SMALL, OwnMemory, clips
from torch._subclasses.fake_tensor import FakeTensorMode

random_svd = source_tree.helper("random_svd")
LiveTensors = source_tree.helper("live_tensors").LiveTensors

FORMATS = {
    "single file, training checkpoint": ("svd.safetensors", "lvcd.ckpt"),
    "diffusers folder, pruned safetensors": ("svd", "lvcd-fp16.safetensors"),
}


def written(folder: Path, sizes: ModelSizes) -> None:
    """Every format, in half precision."""
    weights = random_svd.weights(sizes, dtype=torch.float16)
    random_svd.write_single_file(folder / "svd.safetensors", weights)
    random_svd.write_folder(folder / "svd", weights, sizes=sizes)
    for name in ("lvcd.ckpt", "lvcd-fp16.safetensors"):
        random_svd.write_lvcd(folder / name, weights, dtype=torch.float16)


def loading(folder: Path, files: tuple[str, str], dtype: str, sizes: ModelSizes) -> dict[str, float]:
    """Seconds and memory of loading, and the size of what was loaded."""
    began = time.perf_counter()
    with OwnMemory() as memory:
        models = load_models(folder / files[0], folder / files[1], dtype=getattr(torch, dtype), sizes=sizes)
    seconds = time.perf_counter() - began
    networks = (models.image_encoder, models.autoencoder, models.control, models.unet)
    return {
        "seconds": seconds,
        "weights_gib": sum(map(bytes_of, networks)) / GIB,
        "most_own_memory_gib": memory.peak / GIB,
    }


def counted_memory(size: tuple[int, int]) -> dict[str, float]:
    """What full-size networks need in half precision beside their weights, counted without a device [GiB]."""
    (width, height), config = size, NetworkConfiguration()
    layout, half = FrameLayout.later_segment(), torch.float16

    def empty(*shape: int) -> torch.Tensor:
        return torch.empty(shape, dtype=half)

    with FakeTensorMode(), torch.no_grad():
        unet, control = SpatioTemporalUNet(config), SketchControlNet(config)
        for network in (unet, control):
            tensors = {name: empty(*each.shape) for name, each in network.state_dict().items()}
            network.load_state_dict(tensors, assign=True)
        x, hint = empty(1, layout.count, 8, height // 8, width // 8), empty(1, layout.count, 3, height, width)
        conditions = (torch.empty(1), empty(1, 1, config.context_dim), torch.empty(1, 3), layout)
        with LiveTensors(unet, control) as sampling:
            unet(x, *conditions, control(x, hint, *conditions))
        found = {"unet_and_control": sum(map(bytes_of, (unet, control))), "sampling": sampling.peak}
        autoencoder = build_autoencoder(ModelSizes().autoencoder)
        found["autoencoder"] = bytes_of(autoencoder)
        for frames in (10, 5):
            with LiveTensors(autoencoder) as decoding:
                autoencoder.decode(torch.empty(frames, 4, height // 8, width // 8), num_frames=frames)
            found[f"decoding_{frames}_frames"] = decoding.peak // 2  # half of what single precision needs
    return {name: size / GIB for name, size in found.items()}


def in_own_process(work: Callable[..., Any], *arguments: Any) -> Any:
    """The result of a function in a fresh process, whose memory is its alone."""
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        return pool.apply(work, arguments)


def main() -> None:
    """Read the command line, measure, print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--size", choices=["auto", "full", "tiny"], default="auto", help="of the networks of clips")
    parser.add_argument("--modes", choices=MODES, nargs="+", default=list(MODES), help="who draws clips, after what")
    parser.add_argument("--frames", type=int, nargs="+", default=[14, 35])
    parser.add_argument("--areas", choices=list(AREAS), nargs="+", default=["576x320", "1024x576"])
    parser.add_argument("--steps", type=int, default=25, help="sampling steps of a segment (default 25)")
    parser.add_argument("--dtype", choices=["float16", "bfloat16", "float32"], help="default: float16 on a GPU")
    parser.add_argument(
        "--no-loading", action="store_true", help="leave out what needs no clips: loading, counted memory"
    )
    parser.add_argument("--no-compile", action="store_true", help="leave out compiled networks")
    parser.add_argument("--json", action="store_true", help="print one JSON document")
    options = parser.parse_args()
    device = torch.device("cuda" if torch.cuda.is_available() else "cpu")
    dtype = getattr(torch, options.dtype or ("float16" if device.type == "cuda" else "float32"))
    full = options.size == "full" or (options.size == "auto" and device.type == "cuda")
    result: dict[str, Any] = {
        "device": torch.cuda.get_device_name(device)
        if device.type == "cuda"
        else f"cpu, {torch.get_num_threads()} threads",
        "torch": torch.__version__,
        "networks_of_clips": "full" if full else "tiny",
        "dtype": str(dtype).removeprefix("torch."),
        "steps": options.steps,
    }
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if full or not options.no_loading:
            in_own_process(written, folder, ModelSizes())
        if not options.no_loading:
            result["loading"] = {
                f"{name}, as {kind}": in_own_process(loading, folder, files, kind, ModelSizes())
                for name, files in FORMATS.items()
                for kind in ("float16", "float32")
            }
            result["counted_memory_gib"] = {name: counted_memory(size) for name, size in AREAS.items()}
        result["clips"] = drawn(folder, full, dtype, device, options)
    print(json.dumps(result, indent=2) if options.json else result)


def drawn(
    folder: Path, full: bool, dtype: torch.dtype, device: torch.device, options: argparse.Namespace
) -> dict[str, Any]:
    """Figures of every mode, eager and compiled. One that fails tells why, and the others go on."""
    files = folder if full else folder / "tiny"
    if not full:
        files.mkdir()
        written(files, SMALL)
    found: dict[str, Any] = {}
    for mode in options.modes:
        for compiled in (False, True)[: 1 if options.no_compile else 2]:
            name = f"{mode}, {'compiled' if compiled else 'eager'}"
            try:
                found[name] = in_own_process(clips, files, mode, compiled, full, dtype, device, options)
            except (ImportError, RuntimeError, ValueError) as error:
                found[name] = {"failed": f"{type(error).__name__}: {error}"[:500]}
            print(json.dumps({name: found[name]}), file=sys.stderr, flush=True)  # a long run may be cut short
    return found


if __name__ == "__main__":
    main()
