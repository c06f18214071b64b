"""The paper's interpolation as a choice of the node Interpolate: the backend that its inputs make."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from ...physics.errors import InvalidInputError, require
from ...rendering.tooncrafter import ToonCrafterOptions
from ..host import dtype_of, watched_sampling
from .clip_inputs import colour_match_of
from .networks import Networks, kept_networks
from .tooncrafter_files import TOONCRAFTER_FILES, model_file, sketch_model_file
from .tooncrafter_inputs import AREAS

if TYPE_CHECKING:
    import torch

    from ...rendering.tooncrafter.conditioning import Tokens
    from ...rendering.tooncrafter.interpolator import ToonCrafterInterpolator
    from ...rendering.tooncrafter.models import ToonCrafterModels

__all__ = ["missing_tooncrafter_files", "tooncrafter_backend"]


def missing_tooncrafter_files(choice: dict[str, Any]) -> list[str]:
    """One sentence for each chosen model file that is not there, with where to get it."""
    name = choice.get("tooncrafter_model")
    return [_missing("tooncrafter_model", name)] if name and model_file(name) is None else []


def tooncrafter_backend(choice: dict[str, Any]) -> ToonCrafterInterpolator:
    """The backend with the chosen options and files, and the host's progress, preview, memory and encoders."""
    from comfy import model_management

    from ...rendering.tooncrafter.interpolator import ToonCrafterInterpolator

    device = model_management.get_torch_device()
    networks = _networks(choice, device)
    models = _with_kept_prompt(networks.held, choice)
    _check_encoders(choice, models)
    return ToonCrafterInterpolator(
        models,
        options=_options(choice),
        placement=networks.placement(device),
        look=_look(choice.get("clip_vision")),
        prompts=_prompts(choice, models),
        colour_match=colour_match_of(choice),
        **watched_sampling(device, lambda clean: clean[:1, :, clean.shape[2] // 2]),
    )


def _check_encoders(choice: dict[str, Any], models: ToonCrafterModels) -> None:
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
    return f"{file} is missing: {TOONCRAFTER_FILES[name]}"


def _options(choice: dict[str, Any]) -> ToonCrafterOptions:
    same = ("steps", "solver", "guidance", "control_scale", "pairs_together", "decoded_together")
    chosen = {name: choice[name] for name in same}
    area, seed = AREAS[choice["working_size"]], choice["noise_from"]
    return ToonCrafterOptions(area=area, seed=seed, frame_rate=choice["fs"], **chosen)


def _networks(choice: dict[str, Any], device: torch.device) -> Networks[ToonCrafterModels]:
    from ...rendering.tooncrafter.model_sizes import sizes_beside
    from ...rendering.tooncrafter.models import load_models

    model, sketch = model_file(choice["tooncrafter_model"]), None
    if model is None:
        raise InvalidInputError(_missing("tooncrafter_model", choice["tooncrafter_model"]))
    if choice.get("sketches") is not None and choice["control_scale"] > 0:
        sketch = sketch_model_file(choice["sketch_model"])
        if sketch is None:
            raise InvalidInputError(_missing("sketch_model", choice["sketch_model"]))
    dtype = dtype_of(choice["precision"], device)
    sizes = sizes_beside(model, sketch)
    key = model, sketch, tuple(file.stat().st_mtime for file in (model, sketch) if file), dtype, sizes
    return kept_networks("tooncrafter", key, lambda: load_models(model, sketch=sketch, dtype=dtype, sizes=sizes))


def _with_kept_prompt(models: ToonCrafterModels, choice: dict[str, Any]) -> ToonCrafterModels:
    """With the empty prompt that an earlier run has kept beside the model's file, where that file has none."""
    from ...rendering.tooncrafter.kept_prompt import kept_prompt

    model = model_file(choice["tooncrafter_model"])
    if models.empty_prompt is not None or model is None:
        return models
    config = models.unet.config
    kept = kept_prompt(model, (1, config.text_tokens, config.context_dim))
    return replace(models, empty_prompt=None if kept is None else kept.to(models.dtype))


def _prompts(choice: dict[str, Any], models: ToonCrafterModels) -> tuple[torch.Tensor, torch.Tensor] | None:
    """The prompt and the empty one by the host's text encoder, if one is connected."""
    clip, words = choice.get("clip"), choice["prompt"].strip()
    if clip is None:
        require("prompt", words, not words, "empty as long as no clip is connected")
        return None
    prompt, empty = (clip.encode_from_tokens(clip.tokenize(each)) for each in (words, ""))
    config = models.unet.config
    shape, expected = tuple(empty.shape), (1, config.text_tokens, config.context_dim)
    require("clip", f"embeddings of shape {shape}", shape == expected, f"Stable Diffusion 2.1's, of shape {expected}")
    model = model_file(choice["tooncrafter_model"])
    if models.empty_prompt is None and model is not None:
        from ...rendering.tooncrafter.kept_prompt import keep_prompt

        keep_prompt(model, empty)
    return prompt[:, : config.text_tokens], empty


def _look(clip_vision: Any) -> Callable[[Any], Tokens] | None:
    """The host's picture encoder, if one is connected."""
    if clip_vision is None:
        return None
    import torch

    from ...rendering.networks.image_encoder import square_picture
    from ...rendering.tooncrafter.conditioning import Tokens

    def look(pictures: Any) -> Tokens:
        batch = torch.stack([*pictures, torch.zeros_like(pictures[0])])
        squares = (square_picture(batch, clip_vision.image_size) + 1) / 2
        seen = clip_vision.encode_image(squares.clamp(0, 1).movedim(1, -1), crop=False)
        tokens = seen["last_hidden_state"]
        return Tokens(tokens[:-1], tokens[-1:])

    return look
