"""Bounds of what a scene may hold, in one place: what lies beyond them is a slip of the pen or a hostile file."""

from __future__ import annotations

__all__ = [
    "LARGEST",
    "MAX_BODIES",
    "MAX_COLLIDERS",
    "MAX_DOCUMENT_BYTES",
    "MAX_LOOP",
    "MAX_MASK_PIXELS",
    "MAX_OUTLINE_POINTS",
    "MAX_PAINT",
    "MAX_PARTICLES",
    "MAX_PARTICLES_OF_STROKE",
    "MAX_PARTS",
    "MAX_POINTS",
    "MAX_QUERY_POINTS",
    "MAX_RIG_POINTS",
    "MAX_SIDE",
    "MAX_STROKES",
    "MAX_TRIANGLES",
    "MAX_VERTICES",
    "MOST_MINUTES",
    "STIFFEST",
]

LARGEST = 1_000_000
"""Largest coordinate [px], radius [px], speed [px/s], acceleration [side/s^2] or time [s], without its sign."""

STIFFEST = 1e12
"""Largest Young's modulus [density side^2 / s^2]."""

MOST_MINUTES = 10_000.0
"""Most minutes of computing that a simulation may be allowed: a week."""

MAX_OUTLINE_POINTS = 200_000
"""Points of the outlines of all colliders together, where bodies can come."""

MAX_BODIES = 100
MAX_COLLIDERS = 100
MAX_STROKES = 1_000
MAX_RIG_POINTS = 1_000
MAX_PAINT = 200
MAX_QUERY_POINTS = 1_000
MAX_PARTS = 100

MAX_POINTS = 10_000
"""Points of one stroke, polygon or keyed path."""

MAX_DOCUMENT_BYTES = 64 * 2**20
"""Size of a scene document as text."""

MAX_SIDE = 65_536
"""Width and height of the illustration in a scene document [px]."""

MAX_VERTICES = 500_000
"""Vertices of one body in a scene document."""

MAX_TRIANGLES = 1_000_000
"""Triangles of one body in a scene document."""

MAX_LOOP = 600
"""Length of a loop [s]."""

MAX_MASK_PIXELS = 2**28
"""Pixels of all the mask regions in a scene document together."""

MAX_PARTICLES_OF_STROKE = 4_096
"""Flow particles of one stroke that are alive at once."""

MAX_PARTICLES = 16_384
"""Flow particles of all strokes that are alive at once."""
