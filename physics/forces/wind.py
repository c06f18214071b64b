"""Wind: a field that acts everywhere, steady, in gusts and with eddies; the readable reference of what a kernel adds.

The eddies are the curl of a smooth random stream function, a sum of a few travelling waves, so that they neither
gather nor spread anything: the field is free of divergence.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..checks import is_whole, within
from ..errors import require
from ..limits import LARGEST
from ..points import Point, Scale, checked_points, scaled_points
from .rhythm import fitted_period

__all__ = ["Eddies", "Wind", "eddies", "uniform", "wind_acceleration"]

FloatArray = NDArray[np.float64]

_WAVES = 8
_SPREAD = 0.6  # wavelengths differ from the usual one by up to this many octaves
_GUSTS = ((1.0, 0.6), (0.618, 0.4))  # part of the gust period, share: two rhythms that do not seem to repeat
_LARGEST_SEED = 2**31 - 1


@dataclass(frozen=True)
class Wind:
    """Wind that blows everywhere.

    Attributes:
        strength: acceleration at its hardest, without eddies [side/s^2]; negative blows the other way.
        angle: where it blows to [degrees]: 0 to the right, 90 up.
        gust: share of the strength that comes and goes, 0 to 1; at 1 it is calm between two gusts.
        gust_period: time from one gust to the next [s].
        turbulence: strength of the eddies as a share of the wind's, root mean square, 0 to 1.
        turbulence_size: how large an eddy is [px].
        seed: chooses among winds that are alike in all of this.
        origin: point of the picture [px] from which the pattern of eddies is laid; None for the upper left corner.

    Examples:
        >>> from physanimator.physics.forces import Wind
        >>> Wind(strength=2.0, angle=180.0).gust
        0.6
    """

    strength: float = 1.0
    angle: float = 0.0
    gust: float = 0.6
    gust_period: float = 2.0
    turbulence: float = 0.3
    turbulence_size: float = 200.0
    seed: int = 0
    origin: Point | None = None

    def __post_init__(self) -> None:
        bounded = within(self.strength, -LARGEST, LARGEST)
        require("strength", self.strength, bounded, f"-{LARGEST} to {LARGEST} side/s^2")
        require("angle", self.angle, within(self.angle, -LARGEST, LARGEST), f"-{LARGEST} to {LARGEST} degrees")
        require("gust", self.gust, within(self.gust, 0, 1), "0 to 1")
        require("gust_period", self.gust_period, within(self.gust_period, 0.05, LARGEST), f"0.05 to {LARGEST} s")
        require("turbulence", self.turbulence, within(self.turbulence, 0, 1), "0 to 1")
        size = self.turbulence_size
        require("turbulence_size", size, within(size, 1, LARGEST), f"1 to {LARGEST} px")
        require("seed", self.seed, is_whole(self.seed, 0, _LARGEST_SEED), f"a whole number from 0 to {_LARGEST_SEED}")
        object.__setattr__(self, "seed", int(self.seed))
        if self.origin is not None:
            object.__setattr__(self, "origin", checked_points("origin", [self.origin], least=1)[0])

    def rescaled(self, scale: Scale) -> Wind:
        """The same wind over the picture at another size."""
        origin = None if self.origin is None else scaled_points((self.origin,), scale)[0]
        return replace(self, turbulence_size=max(1.0, self.turbulence_size * scale[2]), origin=origin)

    @property
    def direction(self) -> FloatArray:
        """Unit vector, y down, shape [2]."""
        radians = math.radians(self.angle)
        return np.array([math.cos(radians), -math.sin(radians)])


class Eddies(NamedTuple):
    """Waves whose sum is the turbulent part of a wind: sum of amplitude sin(wave . x + phase + rate t).

    Attributes:
        wave: wave vectors [rad/px], shape [m, 2].
        amplitude: across each wave's own direction [side/s^2], shape [m, 2].
        phase: [rad], shape [m].
        rate: [rad/s], shape [m].
    """

    wave: FloatArray
    amplitude: FloatArray
    phase: FloatArray
    rate: FloatArray


def uniform(wind: Wind, t: ArrayLike, *, loop: float | None = None) -> FloatArray:
    """The part of a wind that is the same everywhere: strength (1 - gust + gust w(t)) with w from 0 to 1.

    Args:
        wind: the wind.
        t: time [s], shape [n].
        loop: after which it repeats [s].

    Returns:
        [side/s^2], shape [n, 2].

    Examples:
        >>> import numpy as np
        >>> from physanimator.physics.forces import Wind, uniform
        >>> uniform(Wind(strength=2.0, gust=0.0), np.array([0.0, 0.5])).shape
        (2, 2)
    """
    times = np.asarray(t, dtype=np.float64)
    starts = np.random.default_rng(wind.seed).uniform(0, 2 * np.pi, len(_GUSTS))
    swing = np.zeros_like(times)
    for (part, share), start in zip(_GUSTS, starts, strict=True):
        swing += share * np.sin(2 * np.pi / fitted_period(part * wind.gust_period, loop) * times + start)
    level = wind.strength * (1 - wind.gust + wind.gust * (1 + swing) / 2)
    return level[..., None] * wind.direction


def eddies(wind: Wind, *, loop: float | None = None) -> Eddies:
    """The waves of a wind's turbulence, which drift along with it; none where there is no turbulence.

    Args:
        wind: the wind.
        loop: after which it repeats [s].
    """
    count = _WAVES if wind.turbulence and wind.strength else 0
    random = np.random.default_rng([wind.seed, 1])
    angles = 2 * np.pi * (np.arange(count) + random.uniform(size=count)) / max(count, 1)
    lengths = 2 * wind.turbulence_size * 2 ** random.uniform(-_SPREAD, _SPREAD, count)
    towards = np.column_stack([np.cos(angles), np.sin(angles)])
    wave = 2 * np.pi / lengths[:, None] * towards
    # An eddy is blown past in about a gust's period, and changes on its way.
    drift = wave @ wind.direction * math.copysign(2 * wind.turbulence_size, wind.strength) / wind.gust_period
    rate = random.uniform(-np.pi, np.pi, count) / wind.gust_period - drift
    if loop is not None:
        turns = rate * loop / (2 * np.pi)
        rate = np.copysign(np.maximum(1, np.rint(np.abs(turns))), turns) * 2 * np.pi / loop
    size = abs(wind.strength) * wind.turbulence * math.sqrt(2 / max(count, 1))
    across = np.column_stack([-towards[:, 1], towards[:, 0]])
    phase = random.uniform(0, 2 * np.pi, count)
    if wind.origin is not None:
        phase = phase - wave @ np.array(wind.origin)
    return Eddies(wave, size * across, phase, rate)


def wind_acceleration(wind: Wind, points: ArrayLike, t: float, *, loop: float | None = None) -> FloatArray:
    """Acceleration of a wind at points at a time.

    Args:
        wind: the wind.
        points: [px], shape [n, 2].
        t: time [s].
        loop: after which it repeats [s].

    Returns:
        [side/s^2], shape [n, 2].
    """
    waves = eddies(wind, loop=loop)
    turned = np.asarray(points, dtype=np.float64) @ waves.wave.T + waves.phase + waves.rate * t
    return uniform(wind, t, loop=loop) + np.sin(turned) @ waves.amplitude
