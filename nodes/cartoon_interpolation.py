"""The paper's interpolation as a choice of the node Interpolate: its options, and the backend that they make."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comfy_api.latest import io

from ..physics.errors import InvalidInputError, require
from ..rendering.tooncrafter.options import SOLVERS, InterpolationOptions
from .computing import PRECISIONS, dtype_of, host_placement
from .progress import host_preview, host_progress
from .tooncrafter_files import TOONCRAFTER, model_choices, model_file, sketch_model_choices, sketch_model_file

if TYPE_CHECKING:
    import torch

    from ..rendering.tooncrafter.conditioning import Tokens
    from ..rendering.tooncrafter.interpolator import ToonCrafterInterpolator
    from ..rendering.tooncrafter.models import InterpolationModels
    from ..rendering.tooncrafter.sampler import SampledStep

__all__ = ["missing_tooncrafter_files", "tooncrafter_backend", "tooncrafter_inputs"]

_AREAS = {"512 x 320": 512 * 320, "768 x 512": 768 * 512}
_USUAL = InterpolationOptions()


def tooncrafter_inputs() -> list[Any]:
    """The inputs that this choice brings."""
    return [
        io.Image.Input(
            "sketches",
            optional=True,
            tooltip="From Warp Sketch: dark lines on white, one for each frame. Without them nothing leads the model.",
        ),
        io.Combo.Input(
            "tooncrafter_model",
            options=model_choices(),
            tooltip="ToonCrafter: model.ckpt or its pruned fp16 safetensors, in models/checkpoints.",
        ),
        io.Combo.Input(
            "sketch_model",
            options=sketch_model_choices(),
            tooltip="ToonCrafter's sketch_encoder.ckpt, in models/controlnet. Needed only with sketches.",
        ),
        io.Float.Input(
            "control_scale",
            default=_USUAL.control_scale,
            min=0.0,
            max=2.0,
            step=0.05,
            tooltip="How closely in-betweens follow the sketches [0 to 2]. The paper takes 0.1; 0 ignores them.",
        ),
        io.Int.Input(
            "noise_from",
            default=_USUAL.seed,
            min=0,
            max=2**32 - 1,
            tooltip="Seed of the noise: another number gives other in-betweens, the same one the same ones.",
        ),
        io.Int.Input(
            "steps",
            default=_USUAL.steps,
            min=1,
            max=200,
            tooltip="Sampling steps for each pair of keyframes; time grows with them. 50 is usual.",
        ),
        io.Combo.Input(
            "solver",
            options=list(SOLVERS),
            default=_USUAL.solver,
            tooltip="ddim: as published, 50 steps. dpm++ 2m: close to it in 15 to 20 steps.",
        ),
        io.Float.Input(
            "guidance",
            default=_USUAL.guidance,
            min=1.0,
            max=30.0,
            step=0.1,
            tooltip="How closely in-betweens follow prompt and keyframes [1 to 30]; 1 takes half the time.",
        ),
        io.Int.Input(
            "fs",
            default=_USUAL.frame_rate,
            min=1,
            max=60,
            tooltip="What the model is told of the frame rate [1/s]: lower for larger motion. The video's own stays.",
        ),
        io.Combo.Input(
            "working_size",
            options=list(_AREAS),
            default=next(iter(_AREAS)),
            tooltip="Area that the model works on [px], in the keyframes' proportions; trained at 512 x 320.",
        ),
        io.Int.Input(
            "pairs_together",
            default=_USUAL.pairs_together,
            min=1,
            max=16,
            tooltip="Pairs of keyframes that are drawn at once; fewer need less memory.",
        ),
        io.Combo.Input(
            "precision",
            options=list(PRECISIONS),
            default=PRECISIONS[0],
            tooltip="auto: 16 bits where the device computes faster with them.",
        ),
        io.String.Input(
            "prompt",
            default="",
            tooltip="What happens between the keyframes, in words; usually empty. Words need a clip.",
        ),
        io.Clip.Input(
            "clip",
            optional=True,
            tooltip="Stable Diffusion 2.1's text encoder, from Load CLIP. Left out: the one in model.ckpt.",
        ),
        io.ClipVision.Input(
            "clip_vision",
            optional=True,
            tooltip="CLIP-ViT-H-14, from Load CLIP Vision. Left out: the one in model.ckpt.",
        ),
    ]


def missing_tooncrafter_files(choice: dict[str, Any]) -> list[str]:
    """One sentence for each chosen model file that is not there, with where to get it."""
    name = choice.get("tooncrafter_model")
    return [_missing("tooncrafter_model", name)] if name and model_file(name) is None else []


def tooncrafter_backend(choice: dict[str, Any]) -> ToonCrafterInterpolator:
    """The backend with the chosen options and files, and the host's progress, preview, memory and encoders."""
    from comfy import model_management

    from ..rendering.tooncrafter.interpolator import ToonCrafterInterpolator

    device = model_management.get_torch_device()
    models = _models(choice, device)
    _check_encoders(choice, models)
    return ToonCrafterInterpolator(
        models,
        options=_options(choice),
        placement=host_placement(device),
        look=_look(choice.get("clip_vision")),
        prompts=_prompts(choice, models),
        **_watched(device),
    )


def _check_encoders(choice: dict[str, Any], models: InterpolationModels) -> None:
    """Raise where the model's file holds no encoder and none is connected."""
    held = {"clip": models.empty_prompt, "clip_vision": models.image_encoder}
    loaders = {
        "clip": "Load CLIP with the text encoder of Stable Diffusion 2.1",
        "clip_vision": "Load CLIP Vision with CLIP-ViT-H-14-laion2B-s32B-b79K",
    }
    for name, own in held.items():
        if own is None and choice.get(name) is None:
            raise InvalidInputError(
                f"{choice['tooncrafter_model']} is pruned: connect {name}, from {loaders[name]}, or choose model.ckpt."
            )


def _missing(name: str, file: str) -> str:
    return f"{file} is missing: {TOONCRAFTER[name]}"


def _options(choice: dict[str, Any]) -> InterpolationOptions:
    same = ("steps", "solver", "guidance", "control_scale", "pairs_together")
    chosen = {name: choice[name] for name in same}
    area, seed = _AREAS[choice["working_size"]], choice["noise_from"]
    return InterpolationOptions(area=area, seed=seed, frame_rate=choice["fs"], **chosen)


def _models(choice: dict[str, Any], device: torch.device) -> InterpolationModels:
    model, sketch = model_file(choice["tooncrafter_model"]), None
    if model is None:
        raise InvalidInputError(_missing("tooncrafter_model", choice["tooncrafter_model"]))
    if choice.get("sketches") is not None and choice["control_scale"] > 0:
        sketch = sketch_model_file(choice["sketch_model"])
        if sketch is None:
            raise InvalidInputError(_missing("sketch_model", choice["sketch_model"]))
    times = tuple(file.stat().st_mtime for file in (model, sketch) if file)
    return _loaded(model, sketch, times, dtype_of(choice["precision"], device))


@lru_cache(maxsize=1)
def _loaded(model: Path, sketch: Path | None, _: tuple[float, ...], dtype: torch.dtype) -> InterpolationModels:
    """The networks that were used last, as long as their files stay as they are."""
    from ..rendering.tooncrafter.models import load_models

    return load_models(model, sketch=sketch, dtype=dtype)


def _prompts(choice: dict[str, Any], models: InterpolationModels) -> tuple[torch.Tensor, torch.Tensor] | None:
    """The prompt and the empty one by the host's text encoder, if one is connected."""
    clip, words = choice.get("clip"), choice["prompt"].strip()
    if clip is None:
        require("prompt", words, not words, "empty as long as no clip is connected")
        return None
    prompt, empty = (clip.encode_from_tokens(clip.tokenize(each)) for each in (words, ""))
    config = models.unet.config
    shape, expected = tuple(empty.shape), (1, config.text_tokens, config.context_dim)
    require("clip", f"embeddings of shape {shape}", shape == expected, f"Stable Diffusion 2.1's, of shape {expected}")
    return prompt[:, : config.text_tokens], empty


def _look(clip_vision: Any) -> Callable[[Any], Tokens] | None:
    """The host's picture encoder, if one is connected."""
    if clip_vision is None:
        return None
    import torch

    from ..rendering.svd.image_encoder import square_picture
    from ..rendering.tooncrafter.conditioning import Tokens

    def look(pictures: Any) -> Tokens:
        batch = torch.stack([*pictures, torch.zeros_like(pictures[0])])
        squares = (square_picture(batch, clip_vision.image_size) + 1) / 2
        seen = clip_vision.encode_image(squares.clamp(0, 1).movedim(1, -1), crop=False)
        tokens = seen["last_hidden_state"]
        return Tokens(tokens[:-1], tokens[-1:])

    return look


def _watched(device: torch.device) -> dict[str, Any]:
    """Progress, and a look at a clip's middle after each step."""
    report, preview = host_progress(), host_preview(device)
    latest: list[Any] = []

    def watch(now: SampledStep) -> None:
        latest[:] = [preview(now.clean[:1, :, now.clean.shape[2] // 2])]

    return {"watch": watch, "progress": lambda done, total: report(done, total, latest.pop() if latest else None)}
