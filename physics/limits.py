"""Bounds of what a scene may hold, in one place: what lies beyond them is a slip of the pen or a hostile file."""

from __future__ import annotations

__all__ = [
    "DEFAULT_MINUTES",
    "LARGEST",
    "LEAST_FACTOR",
    "MAX_BODIES",
    "MAX_COLLIDERS",
    "MAX_DIGITS",
    "MAX_DOCUMENT_BYTES",
    "MAX_DOCUMENT_KEYS",
    "MAX_DOCUMENT_LISTS",
    "MAX_DOCUMENT_OBJECTS",
    "MAX_DOCUMENT_VALUES",
    "MAX_LAYERS",
    "MAX_LOOP",
    "MAX_MASK_PIXELS",
    "MAX_OUTLINE_POINTS",
    "MAX_PAINT",
    "MAX_PARTICLES",
    "MAX_PARTICLES_OF_STROKE",
    "MAX_PARTS",
    "MAX_PICTURE_PIXELS",
    "MAX_PICTURE_SIDE",
    "MAX_POINTS",
    "MAX_QUERY_POINTS",
    "MAX_RIG_POINTS",
    "MAX_SIDE",
    "MAX_STROKES",
    "MAX_TRIANGLES",
    "MAX_VERTICES",
    "MOST_FACTOR",
    "MOST_MINUTES",
    "STIFFEST",
    "TICK",
]

LARGEST = 1_000_000
"""Largest coordinate [px], radius [px], speed [px/s], acceleration [side/s^2] or time [s], without its sign."""

LEAST_FACTOR, MOST_FACTOR = 0.001, 1_000
"""Smallest and largest factor that is painted on a material, or keyed along a stroke."""

STIFFEST = 1e12
"""Largest Young's modulus [density side^2 / s^2]."""

TICK = 1 / 240
"""Time after which external forces are evaluated again where the step follows from the mesh, and largest step that can
be asked for [s].

It is the same at every frame rate, and common frame rates divide it: so the motion does not depend on them.
"""

DEFAULT_MINUTES = 5.0
"""Minutes of computing, by an estimate for one core of an ordinary machine, that a simulation may take unless told.

A clip of less than a second may not take more than its share of them: a single tick must not take seconds.
"""

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
MAX_LAYERS = 1_000
"""Layers of one artwork, groups not counted."""

MAX_PARTS = 100

MAX_POINTS = 10_000
"""Points of one stroke, polygon or keyed path."""

MAX_DOCUMENT_BYTES = 64 * 2**20
"""Size of a scene document as text."""

MAX_DOCUMENT_VALUES = 4_200_000
"""Entries of all lists and objects of a scene document together: those of one body of the most vertices and triangles.

What a document becomes in memory follows from its entries, not from its size: 64 MB of empty lists are 1.6 GB.
"""

MAX_DOCUMENT_LISTS = 1_600_000
"""Lists of a scene document: each point and each triangle is one."""

MAX_DOCUMENT_OBJECTS = 100_000
MAX_DOCUMENT_KEYS = 500_000
"""Keys of all objects of a scene document together."""

MAX_DIGITS = 1_000
"""Digits in a row in a scene document: to read a longer number takes as long as thousands of short ones."""

MAX_PICTURE_PIXELS = 2**26
"""Area of a picture that is read [px]: 8192 x 8192, or a page of 1600 x 30000."""

MAX_PICTURE_SIDE = 30_000
"""Longest side of a picture that is read [px]: OpenCV moves pictures of up to 32766, and parts at the border get room
beyond it."""

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
