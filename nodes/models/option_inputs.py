"""Inputs that several models bring to nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from comfy_api.latest import io

from ..host import PRECISIONS

__all__ = ["area_input", "count_input", "precision_input", "seed_input"]


def count_input(name: str, options: Any, low: int, high: int, tooltip: str, *, field: str = "") -> io.Int.Input:
    """A whole number, by default that of a model's options.

    Args:
        name: of the input.
        options: the model's usual ones.
        low: smallest number.
        high: largest number.
        tooltip: what it means.
        field: of the options; the input's name where left out.
    """
    return io.Int.Input(name, default=getattr(options, field or name), min=low, max=high, tooltip=tooltip)


def seed_input(options: Any, what: str) -> io.Int.Input:
    """The seed of the noise.

    Args:
        options: the model's usual ones.
        what: what another number gives, and what the same one gives.
    """
    tooltip = f"Seed of the noise: another number gives {what}."
    return count_input("noise_from", options, 0, 2**32 - 1, tooltip, field="seed")


def area_input(areas: Sequence[str], usual: str, picture: str, trained: str) -> io.Combo.Input:
    """The area that a model works on.

    Args:
        areas: to choose from.
        usual: the default.
        picture: whose proportions count.
        trained: area that the model knows best.
    """
    tooltip = f"Area that the model works on [px], in {picture} proportions; trained at {trained}."
    return io.Combo.Input("working_size", options=list(areas), default=usual, tooltip=tooltip)


def precision_input() -> io.Combo.Input:
    """Of a network's numbers."""
    tooltip = "auto: 16 bits where the device computes faster with them."
    return io.Combo.Input("precision", options=list(PRECISIONS), default=PRECISIONS[0], tooltip=tooltip)
