"""Wind: a field that acts everywhere, steady, in gusts and with eddies; the readable reference of what a kernel adds.

The eddies are the curl of a smooth random stream function, a sum of a few travelling waves, so that they neither
gather nor spread anything: the field is free of divergence.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..fields import Field, Input, check_fields, described
from ..points import Point, Scale, point_field, scaled_points
from .rhythm import fitted_period

__all__ = ["Eddies", "Wind", "eddies", "uniform", "wind_acceleration"]

FloatArray = NDArray[np.float64]

_WAVES = 8
_SPREAD = 0.6  # wavelengths differ from the usual one by up to this many octaves
_GUSTS = ((1.0, 0.6), (0.618, 0.4))  # part of the gust period, share: two rhythms that do not seem to repeat


@described
@dataclass(frozen=True)
class Wind:
    """Wind that blows everywhere.

    The eddies are the stated share of the wind as a root mean square.

    Examples:
        >>> from physanimator.physics.forces import Wind
        >>> Wind(strength=2.0, angle=180.0).gust
        0.6
    """

    strength: Annotated[
        float,
        Field(
            "Strength", "Acceleration when it blows hardest, without eddies. 0.5 is a breeze, 3 a storm.", "side/s^2"
        ),
        Input(
            "Acceleration when it blows hardest, without eddies [sides/s^2], a side being the picture's longest; 0.5 is"
            " a breeze, 3 a storm.",
            0.0,
            1000.0,
            step=0.1,
        ),
    ] = 1.0
    angle: Annotated[
        float,
        Field("Angle", "Where it blows to: 0 to the right, 90 up, 180 to the left.", "degrees"),
        Input("Where it blows to [degrees]: 0 to the right, 90 up, 180 to the left.", -360.0, 360.0, step=5.0),
    ] = 0.0
    gust: Annotated[
        float,
        Field(
            "Gusts",
            "Share of the strength that comes and goes: 0 blows steadily, at 1 it is calm between two gusts.",
            minimum=0,
            maximum=1,
        ),
        Input(
            "Share of the strength that comes and goes [1]: 0 blows steadily, at 1 it is calm between gusts.", step=0.05
        ),
    ] = 0.6
    gust_period: Annotated[
        float,
        Field("Gust period", "Time from gust to gust.", "s", minimum=0.05),
        Input("Time from gust to gust [s].", high=3600.0, step=0.1),
    ] = 2.0
    turbulence: Annotated[
        float,
        Field("Turbulence", "How strong the eddies are, as a share of the wind.", minimum=0, maximum=1),
        Input("How strong the eddies are, as a share of the wind [1].", step=0.05),
    ] = 0.3
    turbulence_size: Annotated[
        float,
        Field("Turbulence size", "How large an eddy is.", "px", minimum=1),
        Input("How large an eddy is [px].", high=16384.0, step=10.0),
    ] = 200.0
    seed: Annotated[
        int,
        Field("Seed", "Chooses among winds that are alike in all else.", minimum=0, maximum=2**31 - 1),
        Input("Chooses among winds that are alike in all else."),
    ] = 0
    origin: Annotated[
        Point | None,
        point_field("Origin", "From where the pattern of eddies is laid; without it, the picture's upper left corner."),
    ] = None

    def __post_init__(self) -> None:
        check_fields(self)

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
