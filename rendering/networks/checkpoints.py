"""Reading model files: tensors by name, and their strict assignment to a network.

Files are mapped into memory, not copied, and a network is first built without storage (on the "meta" device), so that
loading holds the weights once. Pickles are read as data only (``weights_only``): a file that asks for code is refused.
"""

from __future__ import annotations

import pickle
import warnings
import zipfile
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, TypeVar

import torch
from safetensors.torch import load_file
from torch import Tensor, nn

from ...physics.errors import InvalidInputError

__all__ = [
    "CheckpointError",
    "assign",
    "below",
    "build_without_storage",
    "check_names",
    "network_of",
    "read_checkpoint",
]

Network = TypeVar("Network", bound=nn.Module)

_WRAPPERS = ("state_dict", "module")
"""Where training frameworks (Lightning, DeepSpeed) put the weights inside a file."""

_DEEPSPEED = "_forward_module."

_NAMED = 4
"""So many names does a message list before it only counts."""


class _DishonestSize(Exception):
    """An archive that would unpack to more than it is."""


class CheckpointError(InvalidInputError):
    """A model file cannot be used; the message names the file, what is wrong with it and what is wanted."""


def read_checkpoint(path: Path, *, wanted: str) -> dict[str, Tensor]:
    """All tensors of a .safetensors, .ckpt, .pt, .pth or .bin file by their names, on the CPU, mapped from the file.

    Args:
        path: the file.
        wanted: which file this should be, for messages.

    Raises:
        CheckpointError: the file is missing, damaged, not a model file, or holds more than data.
    """
    if not path.is_file():
        raise CheckpointError(f"{path} {'is no file' if path.exists() else 'does not exist'}. Wanted: {wanted}")
    try:
        content = load_file(path) if path.suffix.lower() == ".safetensors" else _unpickled(path)
        tensors = _unwrapped(content)
    except Exception as error:  # a damaged file makes the readers of zip files and pickles raise nearly anything
        # Not in the words of torch, which advises to switch off what keeps a file from running code.
        if isinstance(error, pickle.UnpicklingError) and "GLOBAL" in str(error):
            raise CheckpointError(
                f"{path} is not a plain file of weights, and nothing else is opened, because it could run code."
                f" Wanted: {wanted}, best as .safetensors"
            ) from error
        raise CheckpointError(f"{path} cannot be read; {_fault(path, error)}. Wanted: {wanted}") from error
    if not tensors:
        raise CheckpointError(f"{path} holds no named tensors. Wanted: {wanted}")
    return tensors


def below(tensors: Mapping[str, Tensor], prefix: str) -> dict[str, Tensor]:
    """The tensors whose names start with the prefix, by the rest of their names."""
    return {name[len(prefix) :]: tensor for name, tensor in tensors.items() if name.startswith(prefix)}


def build_without_storage(build: Callable[[], Network]) -> Network:
    """A network whose parameters have shapes but no memory yet; ``assign`` gives them their tensors."""
    with torch.device("meta"):
        return build()


def assign(network: nn.Module, tensors: Mapping[str, Tensor], *, file: str, wanted: str) -> None:
    """Make the tensors the network's parameters, without a copy.

    Args:
        network: its parameters and buffers name what is expected; made by ``build_without_storage`` for instance.
        tensors: one for each of them, none over.
        file: where they come from, for messages.
        wanted: which file this should be, for messages.

    Raises:
        CheckpointError: a name is missing, too many, or its tensor has another shape.
    """
    expected = {name: tuple(tensor.shape) for name, tensor in network.state_dict().items()}
    check_names(expected, {name: tuple(tensor.shape) for name, tensor in tensors.items()}, file=file, wanted=wanted)
    network.load_state_dict(dict(tensors), strict=True, assign=True)
    network.requires_grad_(False)
    network.eval()


def network_of(
    build: Callable[[], Network],
    state_dict: Mapping[str, Any],
    *,
    wanted: str,
    file: str = "the state dict",
    prefix: str = "",
    dtype: torch.dtype | None = None,
) -> Network:
    """A network with the weights of a state dict; tensors already of the wanted type are not copied.

    Args:
        build: makes the network, whose parameters and buffers name what is expected.
        state_dict: tensors or arrays by name.
        wanted: which file this should be, for messages.
        file: where they come from, for messages.
        prefix: only tensors whose names start with it count, by the rest of their names.
        dtype: of the weights; as they come by default.

    Raises:
        CheckpointError: a name is missing, too many, or its tensor has another shape.
    """
    network = build_without_storage(build)
    tensors = below({name: torch.as_tensor(value) for name, value in state_dict.items()}, prefix)
    assign(network, tensors, file=file, wanted=wanted)
    # Not the network's own way: that of diffusers warns of what is right here.
    return network if dtype is None else nn.Module.to(network, dtype)


def check_names(
    expected: Mapping[str, tuple[int, ...]], got: Mapping[str, tuple[int, ...]], *, file: str, wanted: str
) -> None:
    """Raise a CheckpointError unless both have the same names with the same shapes."""
    shaped = [name for name in expected if name in got and expected[name] != got[name]]
    faults = [
        _listed("missing", [name for name in expected if name not in got]),
        _listed("not wanted", [name for name in got if name not in expected]),
        _listed("of another shape", [f"{name} {list(got[name])} for {list(expected[name])}" for name in shaped]),
    ]
    found = "; ".join(fault for fault in faults if fault)
    if found:
        raise CheckpointError(f"{file} does not fit: {found}. Wanted: {wanted}")


def _unpickled(path: Path) -> Any:
    zipped = zipfile.is_zipfile(path)
    if zipped:
        _require_honest_sizes(path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # torch warns of files that look like others before it refuses them
        return torch.load(path, map_location="cpu", weights_only=True, mmap=zipped)


def _require_honest_sizes(path: Path) -> None:
    """Refuse an archive that would unpack to more than it is: torch stores what it saves as it is."""
    with zipfile.ZipFile(path) as archive:
        if sum(entry.file_size for entry in archive.infolist()) > path.stat().st_size:
            raise _DishonestSize


def _unwrapped(content: Any) -> dict[str, Tensor]:
    """The named tensors of a file's content; none if it holds anything else."""
    for wrapper in _WRAPPERS:
        if isinstance(content, Mapping) and isinstance(content.get(wrapper), Mapping):
            content = content[wrapper]
    if isinstance(content, Mapping):
        tensors = {str(name): tensor for name, tensor in content.items() if isinstance(tensor, Tensor)}
        return {name.removeprefix(_DEEPSPEED): tensor for name, tensor in tensors.items()}
    return {}


def _listed(fault: str, names: Iterable[str]) -> str:
    names = list(names)
    if not names:
        return ""
    rest = f" and {len(names) - _NAMED} more" if len(names) > _NAMED else ""
    return f"{len(names)} {fault}: {', '.join(names[:_NAMED])}{rest}"


def _fault(path: Path, error: Exception) -> str:
    """What is wrong with a file that cannot be read."""
    if isinstance(error, _DishonestSize):
        return "it unpacks to more than its size"
    if isinstance(error, MemoryError):
        return "there is not enough memory for it"
    try:
        with path.open("rb") as file:
            begin = file.read(64).lstrip().lower()
    except OSError as refused:
        return f"the system says: {refused.strerror}"
    if begin.startswith(b"version https://git-lfs"):
        return "it is a pointer of Git LFS and not the file itself"
    if begin.startswith((b"<!doctype", b"<html", b"<?xml")):
        return "it is a web page and not the file itself"
    return "it is damaged or was not downloaded to its end" if begin else "it is empty"
