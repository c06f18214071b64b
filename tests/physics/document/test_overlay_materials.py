"""Materials that a document gives to bodies at hand."""

from __future__ import annotations

import numpy as np
from physanimator.physics.document import scene_over
from physanimator.physics.material import Material
from physanimator.physics.mesh import TriangleMesh
from physanimator.physics.scene import Body

MESH = TriangleMesh(np.array([(0.0, 0.0), (10, 0), (10, 10), (0, 10)]), np.array([[0, 1, 2], [0, 2, 3]]), 20, 20)
PAINTED = Body(MESH, Material(stiffness_scale=np.array([1.0, 4.0])))
BARE = {"version": 2, "width": 20, "height": 20}


def test_paint_stays_on_a_body_that_gets_another_material() -> None:
    given = {"material": {"mu": 3, "lambda": 1}}
    (body,) = scene_over({**BARE, "bodies": [given]}, [PAINTED]).bodies
    assert body.material.lame == (3.0, 1.0)
    assert body.material.stiffness_scale is not None
    assert body.material.stiffness_scale.tolist() == [1, 4]
    own = {"material": {"mu": 3, "lambda": 1, "stiffness_scale": [2, 3]}}
    (body,) = scene_over({**BARE, "bodies": [own]}, [PAINTED]).bodies
    assert body.material.stiffness_scale is not None
    assert body.material.stiffness_scale.tolist() == [2, 3]


def test_body_of_which_a_document_says_nothing_keeps_its_material() -> None:
    for bodies in ([], [{}], [{"layer": 2}]):
        assert scene_over({**BARE, "bodies": bodies}, [PAINTED]).bodies[0].material is PAINTED.material
