"""The parity fixtures: small random networks under public names, and what they must give.

The folder is ``fixtures/reference_nets`` here, or the one that ``PHYSANIMATOR_FIXTURES`` names: another set of the same
kind, with other widths, seeds, shapes and cases, all of them read from its ``MANIFEST.json``.
"""

from __future__ import annotations

import importlib.util
import json
import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import torch
from torch import Tensor, nn

OWN_FOLDER = Path(__file__).parent / "fixtures" / "reference_nets"
FOLDER = Path(os.environ.get("PHYSANIMATOR_FIXTURES") or OWN_FOLDER)


def _file(name: str) -> Path:
    """A file of the set, or of the project's own set where that one lacks it."""
    return FOLDER / name if (FOLDER / name).exists() else OWN_FOLDER / name


@cache
def fixtures() -> Any:
    """The set's ``Fixtures``: nets, cases, inputs, state dicts, and ``report`` of errors over allowed errors."""
    spec = importlib.util.spec_from_file_location("reference_weights", _file("weights.py"))
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.Fixtures(str(FOLDER))


def cases(group: str, **settings: Any) -> list[str]:
    """Names of the cases ``group/...`` whose configuration has these values (a set: any of them)."""
    found = []
    for name, case in fixtures().cases.items():
        fits = all(case["config"].get(key) == value for key, value in settings.items())
        if name.split("/")[0] == group and fits:
            found.append(name)
    return found


def state_dict(case: str, net: str) -> dict[str, Tensor]:
    """Weights of a net under their public names, scaled as the case says."""
    scale = fixtures().cases[case]["config"].get("weight_scale", 1.0)
    return as_tensors(fixtures().state_dict(net, scale=scale))


def inputs(case: str) -> dict[str, Tensor]:
    """The inputs of a case by name."""
    return as_tensors(fixtures().inputs(case))


def outputs(case: str) -> dict[str, Tensor]:
    """What a case must give, and summaries of what is between, by name."""
    return as_tensors(fixtures().expected(case))


def as_tensors(arrays: Mapping[str, np.ndarray]) -> dict[str, Tensor]:
    return {name: torch.from_numpy(np.ascontiguousarray(array)) for name, array in arrays.items()}


def full_shapes(name: str) -> dict[str, tuple[int, ...]]:
    """Shape of every tensor of a public full-size checkpoint, from ``keys_full/NAME.json``."""
    text = _file(f"keys_full/{name}.json").read_text(encoding="utf-8")
    return {key: tuple(shape) for key, shape in json.loads(text).items()}


def text_of(name: str) -> Any:
    """Content of a JSON file of the set."""
    return json.loads(_file(name).read_text(encoding="utf-8"))


def assert_within_tolerance(case: str, got: Mapping[str, Tensor], between: Mapping[str, Tensor] | None = None) -> None:
    """Every array of the case that was got, and every tensor between, agrees within what the set allows."""
    errors = fixtures().report(case, _arrays(got), _arrays(between or {}))
    assert errors
    wrong = {name: error for name, error in errors.items() if not error <= 1}
    assert wrong == {}, f"{case}: errors in units of the allowed error"


def _arrays(tensors: Mapping[str, Tensor]) -> dict[str, np.ndarray]:
    return {name: tensor.detach().float().numpy() for name, tensor in tensors.items()}


@contextmanager
def recorded(case: str, prefix: str, network: nn.Module) -> Iterator[dict[str, Tensor]]:
    """While active, collects the case's summaries ``prefix.PATH`` (outputs of modules) and ``prefix.PATH:input``.

    An empty prefix stands for plain ``PATH``.
    """
    found: dict[str, Tensor] = {}
    modules, hooks, start = dict(network.named_modules()), [], f"{prefix}." if prefix else ""
    for name in fixtures().cases[case].get("summaries", {}):
        path, _, is_input = name.removeprefix(start).partition(":")
        if not name.startswith(start) or path not in modules:
            continue

        def keep(_: nn.Module, given: Any, out: Any, name: str = name, is_input: str = is_input) -> None:
            found[name] = (given[0] if is_input else out).clone()  # which may be changed in place

        hooks.append(modules[path].register_forward_hook(keep))
    try:
        yield found
    finally:
        for hook in hooks:
            hook.remove()
