"""Paint: regions that make bodies stiffer, heavier or more damped."""

from __future__ import annotations

import numpy as np
import pytest
from physanimator.physics.assembly import with_paint
from physanimator.physics.errors import InvalidInputError
from physanimator.physics.material import Material
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.rig import Circle, MaskRegion, Polygon, RigPoint
from physanimator.physics.scene import Body, Paint, Scene
from physanimator.physics.simulation import simulate

LEFT = Polygon(((0.0, 0.0), (49.2, 0.0), (49.2, 100.0), (0.0, 100.0)))  # its edge lies in the last pixel before 50
EVERYWHERE = Polygon(((-10.0, -10.0), (300.0, -10.0), (300.0, 300.0), (-10.0, 300.0)))


def bar(*, width: int = 200, height: int = 100) -> TriangleMesh:
    """A bar of 2 x 10 squares from x = 0 to 100 px."""
    x, y = np.meshgrid(np.arange(11.0) * 10, np.arange(3.0) * 10 + 20)
    cell = np.array([[0, 1, 11], [1, 12, 11]])
    cells = [cell + 11 * row + column for row in range(2) for column in range(10)]
    return TriangleMesh(np.column_stack([x.ravel(), y.ravel()]), np.concatenate(cells), width, height)


def scales(*paint: Paint, material: Material | None = None) -> Material:
    return with_paint([Body(bar(), material or Material())], paint)[0].material


def test_what_lies_in_the_region_takes_the_factor() -> None:
    centres = bar().vertices[bar().triangles].mean(axis=1)
    painted = scales(Paint(LEFT, stiffness=8.0, density=0.5))
    np.testing.assert_allclose(painted.stiffness_scale, np.where(centres[:, 0] < 50, 8.0, 1.0))
    np.testing.assert_allclose(painted.density_scale, np.where(centres[:, 0] < 50, 0.5, 1.0))
    assert painted.damping_scale is None


def test_paint_over_paint_multiplies_with_it_and_with_the_material() -> None:
    before = Material(stiffness_scale=np.full(40, 2.0))
    painted = scales(Paint(LEFT, stiffness=3.0), Paint(EVERYWHERE, stiffness=5.0), material=before)
    np.testing.assert_allclose(np.unique(painted.stiffness_scale), [10.0, 30.0])


def test_a_mask_paints_what_a_polygon_paints() -> None:
    mask = np.zeros((50, 100), dtype=bool)  # at half the picture's size
    mask[:, :25] = True
    by_mask, by_polygon = scales(Paint(MaskRegion(mask), damping=4.0)), scales(Paint(LEFT, damping=4.0))
    np.testing.assert_array_equal(by_mask.damping_scale, by_polygon.damping_scale)


def test_paint_of_one_body_leaves_the_others() -> None:
    bodies = (Body(bar()), Body(bar()))
    first, second = with_paint(bodies, [Paint(LEFT, stiffness=8.0, body=1)])
    assert first is bodies[0]
    assert second.material.stiffness_scale is not None
    assert bodies[1].material.stiffness_scale is None


def test_a_painted_bar_bends_less() -> None:
    body = Body(bar(), Material(youngs_modulus=300.0, damping=20.0))
    held = RigPoint((0.0, 30.0), Circle(12.0))

    def sag(*paint: Paint) -> float:
        scene = Scene((body,), (), (held,), gravity=(0.0, 0.4), sag=True, paint=paint)
        return float(simulate(scene, frames=73).positions[-1, 10, 1] - bar().vertices[10, 1])

    assert sag() > 1
    assert sag(Paint(EVERYWHERE, stiffness=4.0)) == pytest.approx(sag() / 4, rel=0.15)
    assert sag(Paint(EVERYWHERE, density=2.0)) > 1.5 * sag()


def test_the_picture_at_another_size_is_painted_alike() -> None:
    scene = Scene((Body(bar()),), paint=(Paint(LEFT, stiffness=8.0),))
    larger = scene.rescaled(400, 200)
    for of in (scene, larger):
        scale = with_paint(of.bodies, of.paint)[0].material.stiffness_scale
        assert scale is not None
        assert np.isclose(scale, 8.0).sum() == 20
        assert np.isclose(scale, 1.0).sum() >= 18
    assert larger.paint[0].region == Polygon(((0.0, 0.0), (98.4, 0.0), (98.4, 200.0), (0.0, 200.0)))


def test_a_large_picture_with_a_polygon_far_outside_takes_little_memory() -> None:
    far = Polygon(((-1e6, -1e6), (1e6, -1e6), (1e6, 1e6), (-1e6, 1e6)))
    huge = Body(bar(width=65_536, height=65_536))
    painted = with_paint([huge], [Paint(far, stiffness=2.0)])[0].material
    np.testing.assert_array_equal(painted.stiffness_scale, 2.0)


@pytest.mark.parametrize("change", [{"stiffness": 0.0}, {"damping": 1e4}, {"density": float("nan")}, {"body": -1}])
def test_unusable_paint(change: dict[str, float]) -> None:
    with pytest.raises(InvalidInputError, match=f"^{next(iter(change))} must be"):
        Paint(LEFT, **change)  # type: ignore[arg-type]
    with pytest.raises(InvalidInputError, match="region must be a polygon or a mask"):
        Paint(Circle(3.0))  # type: ignore[arg-type]
    with pytest.raises(InvalidInputError, match=r"paint\[0\].body must be below"):
        Scene((Body(bar()),), paint=(Paint(LEFT, body=1),))
