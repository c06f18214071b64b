"""Pictures taken apart are kept while their motion changes, with the same pixels and within bounds."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.mesh import TriangleMesh, mesh_from_mask
from physanimator.physics.motion import Motion
from physanimator.physics.scene import Body
from physanimator.rendering.composite import LayeredRenderer, kept_layers, layered_renderer
from physanimator.rendering.composite.cutting import take_apart
from physanimator.rendering.composite.kept_layers import KeptLayers, apart

Made = tuple[np.ndarray, np.ndarray, TriangleMesh]


def picture(shift: int = 0) -> Made:
    rng = np.random.default_rng(3)
    image = rng.integers(90, 160, (48, 64, 3)).astype(np.uint8)
    mask = np.zeros((48, 64), dtype=np.float32)
    mask[10:34, 20 + shift : 40 + shift] = 1
    image[mask > 0] = (30, 60, 200)
    return image, mask, mesh_from_mask(mask, spacing=6)


def motion_of(mesh: TriangleMesh, moved: float) -> Motion:
    rest = mesh.vertices.astype(np.float32)
    return Motion((Body(mesh),), np.stack([rest, rest + np.float32(moved)]), 24.0)


@pytest.fixture
def counted(monkeypatch: pytest.MonkeyPatch) -> list[int]:
    """One entry for each picture that was taken apart, in a store of this test's own."""
    calls: list[int] = []
    store = KeptLayers()

    def counting(*given: object, **options: object) -> object:
        calls.append(1)
        return take_apart(*given, **options)  # type: ignore[arg-type]

    monkeypatch.setattr(layered_renderer, "take_apart", counting)
    monkeypatch.setattr(layered_renderer, "apart", lambda *given, **options: apart(*given, **options, kept=store))
    return calls


def test_another_motion_takes_nothing_apart_anew_and_draws_the_same(counted: list[int]) -> None:
    image, mask, mesh = picture()
    LayeredRenderer(image, [mask], motion_of(mesh, 2.0))
    again = LayeredRenderer(image.copy(), [mask.copy()], motion_of(mesh, 5.0))
    assert len(counted) == 1
    kept_layers._LAYERS.clear()
    background, layers = take_apart(image.astype(np.float32) / np.float32(255), [mask], [mesh], plate=None)
    assert np.array_equal(again._layers[0].texture, layers[0].texture)
    assert np.array_equal(again.plate, np.rint(np.clip(background, 0, 1) * 255).astype(np.uint8))
    assert np.array_equal(again.frame(0), image)
    assert (again.frame(1) != image).any()


def test_whatever_decides_about_the_layers_decides(counted: list[int]) -> None:
    image, mask, mesh = picture()
    other, moved, finer = image.copy(), picture(3)[1], mesh_from_mask(mask, spacing=4)
    other[0, 0, 0] += 1
    plate = np.full_like(image, 120)
    LayeredRenderer(image, [mask], motion_of(mesh, 2.0))
    LayeredRenderer(other, [mask], motion_of(mesh, 2.0))
    LayeredRenderer(image, [moved], motion_of(mesh, 2.0))
    LayeredRenderer(image, [mask], motion_of(finer, 2.0))
    LayeredRenderer(image, [mask], motion_of(mesh, 2.0), plate=plate)
    assert len(counted) == 5


def test_what_is_kept_is_bounded_and_cannot_be_changed() -> None:
    image, mask, mesh = picture()
    made = take_apart(image.astype(np.float32) / np.float32(255), [mask], [mesh], plate=None)
    size = made[0].nbytes + made[1][0].texture.nbytes + made[1][0].mesh.rest.nbytes
    store = KeptLayers(most_bytes=2 * size)
    for key in (b"one", b"two", b"three"):
        assert store.get(key, lambda: made) is made
    assert store.size == 2 * size
    missed: list[int] = []
    for key in (b"three", b"two", b"one"):
        store.get(key, lambda: (missed.append(1), made)[1])
    assert len(missed) == 1  # the oldest had to go
    assert KeptLayers(most_bytes=size - 1).get(b"large", lambda: made) is made
    with pytest.raises(ValueError, match="read-only"):
        made[0][0, 0, 0] = 1


def test_the_shown_plate_is_the_caller_s_own(counted: list[int]) -> None:
    image, mask, mesh = picture()
    floats = image.astype(np.float32) / np.float32(255)
    first = LayeredRenderer(floats, [mask], motion_of(mesh, 2.0))
    first.plate[:] = 0
    second = LayeredRenderer(floats, [mask], motion_of(mesh, 2.0))
    assert second.plate.max() > 0
    assert len(counted) == 1
