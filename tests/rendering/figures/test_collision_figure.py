"""The figure of colliding bodies: with contact they touch and stay apart, without they pass through each other."""

from __future__ import annotations

from functools import lru_cache
from itertools import permutations

import cv2
import numpy as np
from physanimator.physics.motion import Motion
from physanimator.rendering.figures.collisions import collision_motions, touching


@lru_cache
def motions() -> tuple[Motion, Motion]:
    return collision_motions()


def deepest(motion: Motion) -> float:
    """How deep a vertex ever lies inside another body [px]; 0 or less when none does."""
    found = -np.inf
    for frame in range(len(motion)):
        for first, second in permutations(range(len(motion.bodies)), 2):
            outline = motion.of_body(second)[frame][_loop(motion, second)]
            for x, y in motion.of_body(first)[frame].tolist():
                found = max(found, cv2.pointPolygonTest(outline, (x, y), True))
    return found


def _loop(motion: Motion, number: int) -> np.ndarray:
    """Vertices around a body without holes."""
    following = dict(motion.bodies[number].mesh.boundary_edges.tolist())
    loop = [next(iter(following))]
    while (after := following[loop[-1]]) != loop[0]:
        loop.append(after)
    return np.array(loop)


def test_contact_keeps_the_balls_apart() -> None:
    through, kept = motions()
    assert deepest(through) > 20
    assert deepest(kept) < 0.5


def test_touching_places_lie_between_the_balls() -> None:
    _, kept = motions()
    places = [touching(kept, frame) for frame in range(len(kept))]
    assert places[0] == []
    met = [frame for frame, found in enumerate(places) if found]
    assert len(met) >= 2
    for x, y in places[met[0]]:
        nearest = sorted(
            float(np.hypot(*(kept.of_body(number)[met[0]] - (x, y)).T).min()) for number in range(len(kept.bodies))
        )
        assert nearest[1] < 20
