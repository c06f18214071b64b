"""Decoding in half precision, and again in single where half overflows."""

from __future__ import annotations

from contextlib import nullcontext

import pytest
import torch
from physanimator.rendering.networks.half_precision import decoded_in, is_halved

GPU, CPU = torch.device("cuda"), torch.device("cpu")


@pytest.mark.parametrize(
    ("dtype", "device", "halved"),
    [(torch.float16, GPU, True), (torch.bfloat16, GPU, True), (torch.float32, GPU, False), (torch.float16, CPU, False)],
)
def test_only_a_gpu_computes_in_half(dtype: torch.dtype, device: torch.device, halved: bool) -> None:
    assert is_halved(dtype, device) == halved


@pytest.mark.parametrize(("first", "calls"), [(torch.inf, 2), (torch.nan, 2), (0.25, 1)])
def test_what_overflows_is_decoded_again(monkeypatch: pytest.MonkeyPatch, first: float, calls: int) -> None:
    modes: list[tuple[object, ...]] = []
    monkeypatch.setattr(torch, "autocast", lambda *mode: modes.append(mode) or nullcontext())
    given = iter([first, 0.5])
    decoded: list[float] = []

    def decode() -> torch.Tensor:
        decoded.append(next(given))
        return torch.full((2, 3), decoded[-1])

    found = decoded_in(torch.float16, GPU, decode)
    assert modes == [("cuda", torch.float16)]
    assert len(decoded) == calls
    assert found.unique().item() == decoded[-1]


def test_single_precision_decodes_once() -> None:
    assert decoded_in(torch.float32, GPU, lambda: torch.full((2,), torch.inf)).isinf().all()
