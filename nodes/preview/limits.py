"""Bounds of a live preview: it answers while somebody draws, and a request comes from whoever reaches the server."""

from __future__ import annotations

__all__ = [
    "MAX_ANSWER_BYTES",
    "MAX_EDITORS",
    "MAX_EDITOR_NAME",
    "MAX_FRAMES",
    "MAX_KEYS",
    "MAX_LISTS",
    "MAX_NESTING",
    "MAX_OBJECTS",
    "MAX_PICKED_PIXELS",
    "MAX_PICKED_POINTS",
    "MAX_PICKED_SIZE",
    "MAX_PREVIEW_CROSSINGS",
    "MAX_PREVIEW_CROWDING",
    "MAX_PREVIEW_MASK_PIXELS",
    "MAX_PREVIEW_OUTLINE_POINTS",
    "MAX_PREVIEW_PAINT_WORK",
    "MAX_PREVIEW_POINTS",
    "MAX_PREVIEW_REGION_WORK",
    "MAX_PREVIEW_RIG_POINTS",
    "MAX_PREVIEW_STROKES",
    "MAX_PREVIEW_TRIANGLES",
    "MAX_PREVIEW_WORK",
    "MAX_REQUEST_BYTES",
    "MAX_SHOWN_PARTICLES",
    "MAX_STORED_BYTES",
    "MAX_VALUES",
]

MAX_REQUEST_BYTES = 4 * 2**20
"""Size of a request's body."""

MAX_NESTING = 16
"""Lists and objects within each other in a request; a scene needs 8."""

MAX_VALUES = 400_000
"""Numbers, texts, lists and objects of a request together."""

MAX_OBJECTS = 10_000
"""Objects of a request: each is checked against the schema."""

MAX_KEYS = 100_000
"""Keys of all objects of a request together."""

MAX_LISTS = 100_000
"""Lists of a request: each point is one."""

MAX_EDITOR_NAME = 64
"""Characters of an editor's name."""

MAX_EDITORS = 4
"""Editors whose simulations may run at once."""

MAX_PREVIEW_STROKES = 400
MAX_PREVIEW_RIG_POINTS = 1_000
MAX_PREVIEW_POINTS = 40_000
"""Points of all strokes, polygons and keyed paths together."""

MAX_PREVIEW_MASK_PIXELS = 2**25
"""Pixels of all painted masks together."""

MAX_PREVIEW_OUTLINE_POINTS = 20_000
"""Points of the outlines of all colliders together, where bodies can come."""

MAX_PREVIEW_CROWDING = 400_000
"""Pairs of points of outlines that lie in the same small square; of an ordinary outline some ten a point."""

MAX_PREVIEW_CROSSINGS = 2**19
"""Pixel edges that the outlines of all colliders' masks follow."""

MAX_PREVIEW_REGION_WORK = 4e7
"""Corners of all polygons times vertices: each vertex is compared with each."""

MAX_PREVIEW_TRIANGLES = 60_000
MAX_FRAMES = 1_200

MAX_PREVIEW_WORK = 3e9
"""Triangle updates of a preview: half a minute on one core."""

MAX_PREVIEW_PAINT_WORK = 1_500_000
"""Entries of paint times triangles."""

MAX_ANSWER_BYTES = 64 * 2**20
"""Size of all frames of one cycle."""

MAX_SHOWN_PARTICLES = 2_048
"""Flow particles that are shown in a frame; of more, every n-th."""

MAX_STORED_BYTES = 512 * 2**20
"""Memory for the bodies that previews can be made of; beyond, those that were not used for longest are forgotten."""

MAX_PICKED_PIXELS = 2**24
"""Pixels of a picture that is cut while somebody clicks."""

MAX_PICKED_POINTS = 400
"""Points of all parts of such a picture together."""

MAX_PICKED_SIZE = 2**27
"""Pixels of the masks of all parts of such a picture together."""
