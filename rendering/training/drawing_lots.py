"""Chance that follows from a sample's number alone: a run goes on where it stopped, on any number of devices."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
import torch

__all__ = ["Chance", "chance_of", "numbers_of_process"]


@dataclass(frozen=True, eq=False)
class Chance:
    """Two generators of one sample: for choices, and for tensors of noise."""

    choices: np.random.Generator
    noise: torch.Generator


def chance_of(seed: int, number: int) -> Chance:
    """The chance of a sample.

    Args:
        seed: of the run.
        number: of the sample, from 0 over the whole run.
    """
    choices, noise = np.random.SeedSequence([seed, number]).spawn(2)
    mixed = int(noise.generate_state(1, np.uint64)[0] >> np.uint64(1))
    return Chance(np.random.default_rng(choices), torch.Generator().manual_seed(mixed))


def numbers_of_process(
    start: int, end: int, *, batch: int, process: int = 0, processes: int = 1
) -> Iterator[list[int]]:
    """The samples of one process' batches: all processes together take them in turn, none twice.

    Args:
        start: first batch of the run to be taken.
        end: first one not to be.
        batch: samples of a batch.
        process: number of this process.
        processes: number of all.
    """
    for number in range(start, end):
        first = (number * processes + process) * batch
        yield list(range(first, first + batch))
