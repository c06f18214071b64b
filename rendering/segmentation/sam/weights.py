"""Loading Segment Anything networks from a folder or a single file; nothing is ever fetched.

A folder holds config.json and one or more .safetensors files, as the transformers library saves them. A single file
holds the weights of SAM itself, under the names of its authors (sam_vit_b_01ec64.pth and its sisters) or those of
transformers; its sizes are read off its tensors.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import torch
from torch import nn

from ....physics.errors import InvalidInputError
from ...files import check_regular
from ...networks.checkpoints import CheckpointError, assign, build_without_storage, read_checkpoint
from ...networks.library_bars import without_bars
from .families import FAMILIES, Family, where_to_get
from .original_names import sam_config, sam_names

__all__ = ["load_network", "model_type_of"]

_FOLDER_WANTED = "a folder with config.json and model.safetensors of SAM, SAM-HQ, SAM 2, EdgeTAM or SAM 3"
_FILE_WANTED = "sam_vit_b_01ec64.pth, sam_vit_l_0b3195.pth or sam_vit_h_4b8939.pth; for other models " + _FOLDER_WANTED


def load_network(path: Path, *, dtype: torch.dtype = torch.float32) -> tuple[nn.Module, Family]:
    """The network of a folder or file, ready to be asked, on the CPU.

    Args:
        path: a folder with config.json and .safetensors, or one file of SAM's weights.
        dtype: of the weights.

    Raises:
        CheckpointError: nothing is there, or it is no such model, or a package is missing; says what to get.
    """
    if not path.exists():
        raise CheckpointError(f"{path} does not exist. {where_to_get(str(path.parent))}")
    name = model_type_of(path) if path.is_dir() else "sam"
    network = _from_folder(path, name) if path.is_dir() else _from_file(path)
    network.requires_grad_(False)
    return network.to(dtype).eval(), FAMILIES[name]


def model_type_of(folder: Path) -> str:
    """The architecture that a folder's config.json names.

    Raises:
        CheckpointError: there is no config.json, or it names another kind of model.
    """
    file = folder / "config.json"
    try:
        check_regular(file, "config.json")
        config = json.loads(file.read_text(encoding="utf-8"))
    except (InvalidInputError, OSError, ValueError, RecursionError) as error:
        raise CheckpointError(f"{folder} has no readable config.json. Wanted: {_FOLDER_WANTED}") from error
    name = config.get("model_type") if isinstance(config, dict) else None
    if name not in FAMILIES:
        raise CheckpointError(f"{folder / 'config.json'} names the model type {name!r}. Wanted: {_FOLDER_WANTED}")
    return str(name)


def _transformers() -> Any:
    try:
        import transformers
    except ImportError as error:
        raise CheckpointError(
            "The package transformers is missing: pip install 'transformers>=4.57', or choose the backend grabcut."
        ) from error
    return transformers


def _from_folder(folder: Path, name: str) -> nn.Module:
    if not any(folder.glob("*.safetensors")):
        raise CheckpointError(f"{folder} holds no .safetensors file. Wanted: {_FOLDER_WANTED}")
    library = _transformers()
    try:
        with without_bars(library):
            network, report = library.AutoModelForMaskGeneration.from_pretrained(
                folder, local_files_only=True, use_safetensors=True, trust_remote_code=False, output_loading_info=True
            )
    except Exception as error:  # damaged files and wrong configurations make the library raise nearly anything
        raise CheckpointError(
            f"{folder} cannot be loaded as {FAMILIES[name].title}: a file in it is missing, damaged, not downloaded to"
            f" its end, or made for another version of transformers. Wanted: {_FOLDER_WANTED}"
        ) from error
    faults = [*report["missing_keys"], *(fault[0] for fault in report["mismatched_keys"])]
    if faults:
        raise CheckpointError(
            f"{folder} does not fit: {len(faults)} tensors are missing or of another shape, such as"
            f" {min(faults)}. Wanted: {_FOLDER_WANTED}"
        )
    return network


def _from_file(path: Path) -> nn.Module:
    tensors = sam_names(read_checkpoint(path, wanted=_FILE_WANTED))
    config = sam_config(tensors, file=path.name, wanted=_FILE_WANTED)
    library = _transformers()
    network = build_without_storage(lambda: library.SamModel(library.SamConfig(**config)))
    # One tensor under two names: the places of points and of the picture are told in the same way.
    tied = "shared_image_embedding.positional_embedding", "prompt_encoder.shared_embedding.positional_embedding"
    for one, other in (tied, tied[::-1]):
        if one in tensors:
            tensors.setdefault(other, tensors[one])
    assign(network, tensors, file=path.name, wanted=_FILE_WANTED)
    return network
