"""Arguments of the kernels: each named tuple of arrays is one Taichi argument pack with the same names."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from ..runtime import LANES
from .arrays import Drive, Solid, State

__all__ = ["PackedArguments", "argument_packs", "array_types", "drive_group", "solid_group", "state_group"]


def array_types(ti: Any) -> SimpleNamespace:
    """Arrays as the kernels see them.

    Elements are vectors of 2, 4 or 16 only: the compiler pads those of 3 or 6 numbers, which arrays of NumPy are not.
    """
    array, vector = ti.types.ndarray, ti.types.vector
    return SimpleNamespace(
        scalars=array(dtype=ti.f32, ndim=1),
        scalars2=array(dtype=ti.f32, ndim=2),
        scalars3=array(dtype=ti.f32, ndim=3),
        integers=array(dtype=ti.i32, ndim=1),
        integers2=array(dtype=ti.i32, ndim=2),
        vectors=array(dtype=vector(2, ti.f32), ndim=1),
        vectors2=array(dtype=vector(2, ti.f32), ndim=2),
        vectors4=array(dtype=vector(4, ti.f32), ndim=1),
        pairs=array(dtype=vector(2, ti.i32), ndim=1),
        quads=array(dtype=vector(4, ti.i32), ndim=1),
        blocks=array(dtype=vector(LANES, ti.f32), ndim=2),
        pair_blocks=array(dtype=vector(2 * LANES, ti.f32), ndim=2),
    )


def argument_packs(ti: Any) -> SimpleNamespace:
    """The types of the packs of ``Solid``, ``State`` and ``Drive``.

    Taichi tells members of different packs apart by their names alone, and mistakes those of packs in packs (1.7.4): no
    two packs of a kernel may share a name, and the wind table is laid out in the drive's.
    """
    types, pack = array_types(ti), ti.types.argpack
    return SimpleNamespace(
        solid=pack(
            starts=types.pairs,
            substeps=types.integers,
            vertices=types.vectors4,
            step_limits=types.scalars,
            handles=types.integers,
            grips=types.scalars,
            corners=types.integers,
            elements=types.blocks,
            first_slots=types.integers,
            slots=types.integers,
            anchors=types.integers,
            tethers=types.scalars,
            wind_response=types.scalars,
        ),
        state=pack(
            displacement=types.vectors,
            velocity=types.vectors,
            push=types.vectors,
            decay=types.scalars,
            corner_forces=types.pair_blocks,
            records=types.vectors2,
            force_pairs=types.vectors,
        ),
        drive=pack(
            rig_leads=types.scalars3,
            rig_rates=types.scalars3,
            first_particles=types.integers,
            particles=types.scalars2,
            kinds=types.integers,
            constants=types.scalars,
            uniform=types.vectors,
            waves=types.vectors4,
            phases=types.scalars2,
        ),
    )


def solid_group(solid: Solid) -> dict[str, Any]:
    """A solid's arrays by their names in its pack, the corners one after the other."""
    return {**solid._asdict(), "corners": solid.corners.ravel()}


def state_group(state: State) -> dict[str, Any]:
    """A state's arrays by their names in its pack, the corner forces also as a list of pairs."""
    return {**state._asdict(), "force_pairs": state.corner_forces.reshape(-1, 2)}


def drive_group(drive: Drive) -> dict[str, Any]:
    """A drive's arrays by their names in its pack: those of the wind among them, and its single numbers in one.

    The kernels of contact have as many arguments as may be.
    """
    single = ("gravity", "tick_length", "wind")
    group = {name: value for name, value in drive._asdict().items() if name not in single}
    constants = np.array([*drive.gravity, drive.tick_length], dtype=np.float32)
    return {**group, **drive.wind._asdict(), "constants": constants}


class PackedArguments:
    """The packs of a kernel's launches, made once and refilled: Taichi takes a millisecond to make one."""

    def __init__(self, *types: Any) -> None:
        self._types = types
        self._packs: list[Any] = []

    def __call__(self, *groups: dict[str, Any]) -> list[Any]:
        """Fill the packs with the groups, each by its names."""
        if not self._packs:
            self._packs = [made(**group) for made, group in zip(self._types, groups, strict=True)]
        for pack, group in zip(self._packs, groups, strict=True):
            for name, value in group.items():
                if pack[name] is not value:
                    pack[name] = value
        return self._packs
