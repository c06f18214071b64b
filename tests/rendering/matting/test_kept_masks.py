"""Regular masks are made once for the same picture and mask, and few are kept."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.rendering.matting.kept_masks import KeptMasks

IMAGE = np.linspace(0, 1, 300, dtype=np.float32).reshape(10, 10, 3)
MASK = np.eye(10, dtype=np.float32)


@pytest.fixture
def calls() -> list[int]:
    return []


def kept(calls: list[int], most_bytes: int = 10_000) -> KeptMasks:
    def make(image: np.ndarray, mask: np.ndarray) -> np.ndarray:
        calls.append(1)
        return image[..., 0] + mask

    return KeptMasks(make, most_bytes)


def test_the_same_contents_are_computed_once(calls: list[int]) -> None:
    masks = kept(calls)
    first = masks(IMAGE, MASK)
    assert masks(IMAGE.copy(), MASK.copy()) is first
    assert len(calls) == 1
    np.testing.assert_array_equal(first, IMAGE[..., 0] + MASK)


def test_what_has_changed_is_computed_anew(calls: list[int]) -> None:
    masks, image = kept(calls), IMAGE.copy()
    before = masks(image, MASK)
    image[0, 0, 0] = 0.5  # in place
    assert masks(image, MASK)[0, 0] == before[0, 0] + 0.5
    masks(image, MASK * np.float32(0.5))
    masks(image[:5], MASK[:5])
    assert len(calls) == 4


def test_nobody_can_change_what_is_kept(calls: list[int]) -> None:
    with pytest.raises(ValueError, match="read-only"):
        kept(calls)(IMAGE, MASK)[0, 0] = 1


def test_the_oldest_go_where_there_is_no_room(calls: list[int]) -> None:
    masks = kept(calls, most_bytes=2 * MASK.nbytes)
    for level in (0.1, 0.2, 0.3, 0.3, 0.2, 0.1):
        masks(IMAGE, MASK * np.float32(level))
    assert len(calls) == 4
