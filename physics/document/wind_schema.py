"""The JSON Schema of wind."""

from __future__ import annotations

from ..limits import LARGEST
from .schema_blocks import ANY_SIZE, Schema, defined, number, whole_number

__all__ = ["wind_properties"]


def wind_properties() -> dict[str, Schema]:
    """The properties of a wind, by name."""
    return {
        "strength": number(
            "Strength [side/s^2]",
            "Acceleration when it blows hardest, without eddies. 0.5 is a breeze, 3 a storm.",
            **ANY_SIZE,
        ),
        "angle": number("Angle [degrees]", "Where it blows to: 0 to the right, 90 up, 180 to the left.", **ANY_SIZE),
        "gust": number(
            "Gusts",
            "Share of the strength that comes and goes: 0 blows steadily, at 1 it is calm between two gusts.",
            minimum=0,
            maximum=1,
        ),
        "gust_period": number("Gust period [s]", "Time from gust to gust.", minimum=0.05, maximum=LARGEST),
        "turbulence": number("Turbulence", "How strong the eddies are, as a share of the wind.", minimum=0, maximum=1),
        "turbulence_size": number("Turbulence size [px]", "How large an eddy is.", minimum=1, maximum=LARGEST),
        "seed": whole_number("Seed", "Chooses among winds that are alike in all else.", 0, 2**31 - 1),
        "origin": {
            **defined("point"),
            "title": "Origin [px]",
            "description": "From where the pattern of eddies is laid; without it, the picture's upper left corner.",
        },
    }
